#include "radiosity/solution/solution_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>
#include <stdexcept>

#include "mesh/patches/pictured_emission.h"
#include "radiosity/solution/channel_arrays.h"
#include "radiosity/solution/poly_data.h"
#include "radiosity/solution/solution_seal.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

std::vector<double> numbers_of(const Sphere& sphere) {
  const Eigen::Vector3d& c = sphere.center;
  return {c.x(), c.y(), c.z(), sphere.radius};
}

std::vector<double> numbers_of(const Frustum& frustum) {
  const Eigen::Vector3d &b = frustum.base, &a = frustum.axis;
  return {b.x(),
          b.y(),
          b.z(),
          a.x(),
          a.y(),
          a.z(),
          frustum.height,
          frustum.base_radius,
          frustum.top_radius,
          frustum.inward ? 1.0 : 0.0};
}

// Adds the grids of one kind of round shape: arrays NAME_facet_rings_sectors, NAME_<numbers> and
// NAME_element. Kinds that are not met are left out, but for spheres.
template <class Shape>
void add_grids(std::vector<DataArray>& data, const PatchMesh& mesh, const std::string& name,
               const std::string& numbers) {
  std::vector<int> sizes, element;
  std::vector<double> shapes;
  std::ptrdiff_t grids = 0;
  for (const RoundGrid& grid : mesh.round_grids) {
    const auto* shape = std::get_if<Shape>(&grid.shape);
    if (!shape) continue;
    ++grids;
    sizes.insert(sizes.end(), {grid.facet, grid.rings, grid.sectors});
    const std::vector<double> values = numbers_of(*shape);
    shapes.insert(shapes.end(), values.begin(), values.end());
    element.insert(element.end(), grid.element.begin(), grid.element.end());
  }
  if (grids == 0 && !std::is_same_v<Shape, Sphere>) return;
  add_values(data, name + "_facet_rings_sectors", sizes.data(), grids, 3);
  add_values(data, name + "_" + numbers, shapes.data(), grids,
             static_cast<int>(numbers_of(Shape{}).size()));
  add_values(data, name + "_element", element.data(), static_cast<std::ptrdiff_t>(element.size()));
}

void add_bands(std::vector<DataArray>& data, const char* name, const BandArray& values,
               const Bands& bands) {
  auto* array =
      add_values(data, name, values.data(), values.rows(), static_cast<int>(values.cols()));
  for (int k = 0; array && k < bands.count(); ++k) {
    // Programs show the label as it stands in the XML. The true name is in 'band_names'.
    std::string& label = array->labels.emplace_back(as_utf8(bands.names[k]));
    std::replace_if(
        label.begin(), label.end(), [](char c) { return std::strchr("<>&\"'", c) != nullptr; },
        '_');
  }
}

void add_geometry(PolyData& data, const PatchMesh& mesh) {
  set_element_polygons(data, mesh);
  std::vector<double> normals;
  normals.reserve(3 * mesh.vertex_normal.size());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    normals.insert(normals.end(), mesh.vertex_normal[v].data(), mesh.vertex_normal[v].data() + 3);
  }
  add_values(data.of_points, "normal", normals.data(), mesh.vertex_count(), 3);
  data.point_normals = "normal";
}

/// 8-bit sRGB of the tone curve x / (1 + x), where x = 1 is twice the mean luminance of the light
/// leaving the surfaces by reflection. No colour clips, however bright the emitters are.
std::vector<unsigned char> display_colors(const PatchMesh& mesh, const BandArray& B,
                                          const Bands& bands) {
  const BandArray element_B = element_mean(mesh, B - vertex_emission(mesh));
  double weighted = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Spectrum reflected = element_B.row(e).max(0.0f).transpose();
    weighted += mesh.element_area[e] * luminous(bands, reflected);
  }
  const double mean = weighted / (bands.lumens_per_watt * mesh.element_area.sum());
  const float scale = mean > 0.0 ? static_cast<float>(0.5 / mean) : 1.0f;
  std::vector<unsigned char> colors;
  colors.reserve(3 * static_cast<std::size_t>(B.rows()));
  for (Eigen::Index v = 0; v < B.rows(); ++v) {
    const Eigen::Array3f x = scale * linear_rgb(bands, B.row(v).transpose()).max(0.0f);
    for (const float value : x) {
      // Infinity becomes white, NaN black.
      const float linear = value > 1e6f ? 1.0f : value >= 0.0f ? value / (1.0f + value) : 0.0f;
      const float srgb =
          linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
      colors.push_back(static_cast<unsigned char>(std::lround(255.0f * srgb)));
    }
  }
  return colors;
}

void add_vertex_light(std::vector<DataArray>& data, const SolvedScene& solved) {
  const RadiositySolution& s = solved.solution;
  const BandArray E = s.irradiance();
  const BandArray B = vertex_radiosity(solved.mesh, s);
  std::vector<float> lux(static_cast<std::size_t>(E.rows()));
  for (std::size_t v = 0; v < lux.size(); ++v) {
    lux[v] = static_cast<float>(luminous(s.bands, E.row(static_cast<int>(v)).transpose()));
  }
  add_bands(data, "irradiance", E, s.bands);
  add_bands(data, "direct_irradiance", s.direct_irradiance, s.bands);
  add_bands(data, "indirect_irradiance", s.indirect_irradiance, s.bands);
  add_bands(data, "caustic_irradiance", s.caustic_irradiance, s.bands);
  add_bands(data, "radiosity", B, s.bands);
  add_values(data, "illuminance_lux", lux.data(), E.rows());
  add_values(data, "rgb", display_colors(solved.mesh, B, s.bands).data(), E.rows(), 3);
}

void add_elements(std::vector<DataArray>& data, const PatchMesh& mesh, const RadiositySolution& s) {
  const int n = mesh.element_count();
  const auto of_patch = [&](const char* name, const std::vector<int>& per_patch) {
    std::vector<int> values(n);
    for (int e = 0; e < n; ++e) values[e] = per_patch[mesh.patch[e]];
    add_values(data, name, values.data(), n);
  };
  add_values(data, "patch", mesh.patch.data(), n);
  add_values(data, "twin", mesh.twin.data(), n);
  of_patch("surface", mesh.surface);
  of_patch("material", mesh.material);
  add_values(data, "facet", mesh.facet.data(), n);
  add_values(data, "area", mesh.element_area.data(), n);
  add_values(data, "interpolation_error", s.interpolation_error.data(),
             s.interpolation_error.size());
  add_values(data, "gather_noise", s.gather_noise.data(), s.gather_noise.size());
}

void add_patches(std::vector<DataArray>& data, const PatchMesh& mesh, const RadiositySolution& s) {
  const int n = mesh.patch_count();
  const std::vector<unsigned char> is_back(mesh.is_back.begin(), mesh.is_back.end());
  add_values(data, "patch_first_element", mesh.first_element.data(), n + 1);
  add_values(data, "patch_area", mesh.area.data(), n);
  add_values(data, "patch_surface", mesh.surface.data(), n);
  add_values(data, "patch_material", mesh.material.data(), n);
  add_values(data, "patch_is_back", is_back.data(), n);
  add_bands(data, "patch_reflectance", mesh.reflectance, s.bands);
  if (mesh.transmittance.size() > 0) {
    add_bands(data, "patch_transmittance", mesh.transmittance, s.bands);
  }
  add_bands(data, "patch_emission", mesh.emission, s.bands);
  add_bands(data, "patch_radiosity", s.patch_radiosity, s.bands);

  if (s.parts.count() > 0) add_values(data, "patch_part", s.parts.of_patch.data(), n);

  add_grids<Sphere>(data, mesh, "sphere", "center_radius");
  add_grids<Frustum>(data, mesh, "frustum", "base_axis_height_radii_inward");
}

void add_record(std::vector<DataArray>& data, const RadiositySolution& s) {
  add_strings(data, "band_names", s.bands.names);
  add_values(data, "band_wavelengths_nm", s.bands.wavelengths_nm.data(),
             static_cast<std::ptrdiff_t>(s.bands.wavelengths_nm.size()));
  add_values(data, "band_xyz", s.bands.xyz.data(), s.bands.xyz.cols(), 3);
  add_values(data, "lumens_per_watt", &s.bands.lumens_per_watt, 1);
  add_values(data, "metres_per_unit", &s.metres_per_unit, 1);

  std::vector<double> history, seconds;
  std::vector<std::string> phases;
  for (const StepRecord& step : s.history) {
    history.insert(history.end(), {step.residual, step.seconds});
  }
  for (const PhaseSeconds& phase : s.seconds) {
    phases.push_back(phase.phase);
    seconds.push_back(phase.seconds);
  }
  const double energy[] = {s.energy.emitted, s.energy.absorbed, s.energy.escaped, s.energy.unshot};
  const double of_lamps[] = {s.energy.from_lamps, s.energy.missed};
  const int outcome = static_cast<int>(s.outcome);
  add_values(data, "history_residual_seconds", history.data(),
             static_cast<std::ptrdiff_t>(s.history.size()), 2);
  add_strings(data, "phase_names", phases);
  add_values(data, "phase_seconds", seconds.data(), static_cast<std::ptrdiff_t>(seconds.size()));
  add_values(data, "energy_emitted_absorbed_escaped_unshot", energy, 1, 4);
  if (s.energy.from_lamps > 0.0) add_values(data, "energy_from_lamps_missed", of_lamps, 1, 2);
  add_values(data, "outcome", &outcome, 1);
  add_values(data, "residual", &s.residual, 1);
  add_values(data, "error_estimate", &s.error_estimate, 1);
  add_strings(data, "unit_name", {s.unit_name});
  add_strings(data, "light", {s.relative_units ? "relative" : "watts"});
  add_strings(data, "version", {s.provenance.version});
  add_strings(data, "scene_file", {s.provenance.scene_file});
  add_strings(data, "scene_hash", {fmt::format("{:016x}", s.provenance.scene_hash)});
  add_strings(data, "options", {s.provenance.options});
  if (!s.provenance.refinement.empty()) add_strings(data, "refinement", {s.provenance.refinement});
  if (!s.provenance.looked_from.empty()) add_strings(data, "looked_from", s.provenance.looked_from);
}

void add_parts(std::vector<DataArray>& data, const SceneParts& parts) {
  if (parts.count() == 0) return;
  std::vector<std::string> names;
  std::vector<double> figures;
  std::vector<int> by_cracks;
  for (const ScenePart& part : parts.parts) {
    names.push_back(part.name);
    by_cracks.push_back(part.is_lit_by_cracks ? 1 : 0);
    figures.insert(figures.end(), {part.area, part.error_estimate});
  }
  add_strings(data, "part_names", names);
  add_values(data, "part_area_error_estimate", figures.data(), parts.count(), 2);
  add_values(data, "part_is_lit_by_cracks", by_cracks.data(), parts.count());
}

// "channels: desk 0.3, sun 0.9 0.5 0.2"
std::string channel_line(const RadiositySolution& s) {
  std::vector<std::string> parts;
  for (const LightChannel& channel : s.channels) {
    const bool is_even = (channel.scale == channel.scale[0]).all();
    const Eigen::Index shown = is_even ? 1 : channel.scale.size();
    parts.push_back(
        fmt::format("{} {:.4g}", channel.name,
                    fmt::join(channel.scale.data(), channel.scale.data() + shown, " ")));
  }
  return parts.empty() ? "" : fmt::format("channels: {}\n", fmt::join(parts, ", "));
}

const char* how_it_ended(Outcome outcome) {
  switch (outcome) {
    case Outcome::max_sweeps_reached:
      return "stopped at the most sweeps allowed";
    case Outcome::accuracy_missed:
      return "converged, short of the accuracy asked for,";
    case Outcome::cut_short:
      return "cut short";
    case Outcome::converged:
      break;
  }
  return "converged";
}

/// Summary for readers, at the top of the file.
std::string summary(const SolvedScene& solved) {
  const PatchMesh& mesh = solved.mesh;
  const RadiositySolution& s = solved.solution;
  double total = 0.0;
  for (const PhaseSeconds& phase : s.seconds) total += phase.seconds;
  const auto& names = s.bands.names;
  const std::string band_list = names.size() <= 8 ? fmt::format("{}", fmt::join(names, " "))
                                                  : fmt::format("{} from {} to {}", names.size(),
                                                                names.front(), names.back());
  return fmt::format(
      "Lightwell {}: radiosity solution, VTK XML PolyData; open it with ParaView or 'lightwell "
      "view'\n"
      "scene: {} (hash {:016x}), 1 {} = {} m\n"
      "options: {}\n"
      "mesh: {} patches, {} elements, {} vertices\n{}{}"
      "bands: {}, {} lm/W\n"
      "outcome: {} after {} sweeps, residual {:.3g}\n"
      "energy: {:.6g} {} emitted, {:.6g} absorbed, {:.6g} escaped, {:.3g} unshot\n"
      "error estimate: {:.3g} % of irradiance{}\n"
      "seconds: {:.3g}\n",
      s.provenance.version, s.provenance.scene_file, s.provenance.scene_hash, s.unit_name,
      s.metres_per_unit, s.provenance.options, mesh.patch_count(), mesh.element_count(),
      mesh.vertex_count(),
      s.provenance.refinement.empty() ? "" : "refined: " + s.provenance.refinement + "\n",
      channel_line(s), band_list, s.bands.lumens_per_watt, how_it_ended(s.outcome),
      s.history.size(), s.residual, s.energy.emitted, s.relative_units ? "(no known unit)" : "W",
      s.energy.absorbed, s.energy.escaped, s.energy.unshot, 100.0 * s.error_estimate,
      s.provenance.looked_from.empty()
          ? ""
          : fmt::format(" seen from {}", fmt::join(s.provenance.looked_from, ", ")),
      total);
}

}  // namespace

namespace {

// Throws std::runtime_error if the text before the data could not be read again, before an older
// file and the checkpoint go.
void require_readable(const std::filesystem::path& path, const std::string& before_data) {
  pugi::xml_document xml;
  const std::string whole = before_data + "</AppendedData></VTKFile>";
  const pugi::xml_parse_result parsed = xml.load_buffer(whole.data(), whole.size());
  if (parsed) return;
  throw std::runtime_error(fmt::format(
      "cannot write '{}': what would be written could not be read again ({} at byte {}); "
      "please report the scene",
      path.string(), parsed.description(), parsed.offset));
}

}  // namespace

void write_solution(const std::filesystem::path& path, const SolvedScene& solved) {
  PolyData data;
  add_geometry(data, solved.mesh);
  add_vertex_light(data.of_points, solved);
  data.point_scalars = "rgb";
  add_elements(data.of_polygons, solved.mesh, solved.solution);
  add_patches(data.field, solved.mesh, solved.solution);
  add_record(data.field, solved.solution);
  add_parts(data.field, solved.solution.parts);
  add_channels(data, solved.solution);

  std::vector<std::string> text = poly_data_text(std::move(data));
  text.insert(text.begin(), solution_preamble(summary(solved)));
  require_readable(path, text[0] + text[1]);
  text.push_back(seal_of(text));
  write_pieces(path, text);
}

void check_matches(const Scene& scene, const RadiositySolution& solution) {
  const std::uint64_t hash = scene_hash(scene);
  const Provenance& made = solution.provenance;
  if (hash == made.scene_hash) return;
  throw InputError(fmt::format(
      "the solution was made from '{}' (hash {:016x}), which is not what '{}' holds now (hash "
      "{:016x}): geometry, materials or bands differ. Give the scene it was made from, or solve "
      "this one",
      made.scene_file, made.scene_hash, scene.file.string(), hash));
}

}  // namespace lightwell
