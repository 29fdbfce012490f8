#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mesh/patches/translucency.h"
#include "radiosity/solution/channel_arrays.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solution/solution_arrays.h"
#include "radiosity/solution/solution_file.h"
#include "radiosity/solution/solution_seal.h"

namespace lightwell {
namespace {

constexpr int no_limit = std::numeric_limits<int>::max();

Bands read_bands(const SolutionArrays& in) {
  Bands bands;
  bands.names = in.strings("band_names");
  in.require(1 <= bands.count() && bands.count() <= max_bands,
             fmt::format("it has {} bands; 1 to {} are possible", bands.count(), max_bands));
  bands.wavelengths_nm = in.optional<double>(in.field(), "band_wavelengths_nm", 1).values;
  in.require(bands.wavelengths_nm.empty() || bands.wavelengths_nm.size() == bands.names.size(),
             "it does not have one wavelength per band");
  const auto xyz = in.required<float>(in.field(), "band_xyz", bands.count(), 3);
  bands.xyz = Eigen::Map<const Eigen::Array<float, 3, Eigen::Dynamic>>(xyz.row(0), 3, xyz.rows);
  bands.lumens_per_watt = in.number("lumens_per_watt");
  return bands;
}

std::vector<Eigen::Vector3d> read_points(const SolutionArrays& in) {
  const std::vector<double> coordinates = in.file().points();
  in.require(coordinates.size() / 3 < no_limit, "it has too many points");
  std::vector<Eigen::Vector3d> points(coordinates.size() / 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    points[v] = Eigen::Map<const Eigen::Vector3d>(coordinates.data() + 3 * v);
    in.require(points[v].allFinite(), fmt::format("point {} is not finite", v));
  }
  return points;
}

std::vector<std::array<int, 4>> read_corners(const SolutionArrays& in, int vertex_count) {
  const std::vector<std::int64_t> points = in.file().corners(), ends = in.file().ends();
  in.require(!ends.empty() && ends.size() < no_limit, "it has no polygons");
  in.require(ends.back() == std::ssize(points),
             "its polygons have another number of corners than they say");
  std::vector<std::array<int, 4>> corners(ends.size(), {0, 0, 0, -1});
  for (std::size_t e = 0; e < corners.size(); ++e) {
    const std::int64_t begin = e == 0 ? 0 : ends[e - 1], end = ends[e];
    in.require(0 <= begin && begin < end && end <= std::ssize(points) &&
                   (end - begin == 3 || end - begin == 4),
               fmt::format("polygon {} has neither 3 nor 4 corners", e));
    for (std::int64_t c = begin; c < end; ++c) {
      const std::int64_t vertex = points[static_cast<std::size_t>(c)];
      in.require(0 <= vertex && vertex < vertex_count,
                 fmt::format("polygon {} names point {} of {}", e, vertex, vertex_count));
      corners[e][static_cast<std::size_t>(c - begin)] = static_cast<int>(vertex);
    }
    auto sorted = corners[e];
    std::sort(sorted.begin(), sorted.end());
    in.require(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end(),
               fmt::format("polygon {} names a point twice", e));
  }
  return corners;
}

void read_patches(const SolutionArrays& in, int band_count, PatchMesh& mesh) {
  const int element_count = static_cast<int>(mesh.corners.size());
  mesh.first_element = in.optional<int>(in.field(), "patch_first_element", 1).values;
  const auto& first = mesh.first_element;
  in.require(first.size() >= 2 && first.front() == 0 && first.back() == element_count &&
                 std::is_sorted(first.begin(), first.end()),
             "its array 'patch_first_element' does not divide the elements into patches");
  const int n = static_cast<int>(first.size()) - 1;
  mesh.area = in.areas(in.field(), "patch_area", n);
  mesh.surface = in.integers(in.field(), "patch_surface", n, 0, no_limit);
  mesh.material = in.integers(in.field(), "patch_material", n, 0, no_limit);
  const auto is_back = in.required<unsigned char>(in.field(), "patch_is_back", n).values;
  mesh.is_back.assign(is_back.begin(), is_back.end());
  mesh.reflectance = in.bands(in.field(), "patch_reflectance", n, band_count);
  if (in.optional<float>(in.field(), "patch_transmittance", band_count).rows > 0) {
    mesh.transmittance = in.bands(in.field(), "patch_transmittance", n, band_count);
  }
  mesh.emission = in.bands(in.field(), "patch_emission", n, band_count);

  mesh.element_area = in.areas(in.cells(), "area", element_count);
  mesh.facet = in.integers(in.cells(), "facet", element_count, 0, no_limit);
  mesh.twin = in.integers(in.cells(), "twin", element_count, -1, element_count);
  mesh.patch = in.integers(in.cells(), "patch", element_count, 0, n);
  for (int e = 0; e < element_count; ++e) {
    const int i = mesh.patch[e];
    in.require(first[i] <= e && e < first[i + 1],
               fmt::format("element {} names patch {}, which does not include the element", e, i));
  }
  mesh.behind = patches_behind(mesh);
}

RoundShape shape_of(const double* v, const Sphere& /*kind*/) {
  return Sphere{.center = {v[0], v[1], v[2]}, .radius = v[3]};
}

RoundShape shape_of(const double* v, const Frustum& /*kind*/) {
  return Frustum{.base = {v[0], v[1], v[2]},
                 .axis = {v[3], v[4], v[5]},
                 .height = v[6],
                 .base_radius = v[7],
                 .top_radius = v[8],
                 .inward = v[9] != 0.0};
}

/// Reads the grids of one kind of round shape (see add_grids), of `count` numbers each.
template <class Shape>
void read_grids(const SolutionArrays& in, const std::string& name, const std::string& numbers,
                int count, PatchMesh& mesh) {
  const auto sizes = in.optional<int>(in.field(), (name + "_facet_rings_sectors").c_str(), 3);
  if (sizes.rows == 0) return;
  const auto values =
      in.required<double>(in.field(), (name + "_" + numbers).c_str(), sizes.rows, count);
  const std::size_t first = mesh.round_grids.size();
  std::int64_t cells = 0;
  for (int g = 0; g < sizes.rows; ++g) {
    const int* row = sizes.row(g);
    const RoundShape shape = shape_of(values.row(g), Shape{});
    in.require(row[0] >= 0 && row[1] > 0 && row[2] > 0 && area(shape) > 0.0,
               fmt::format("{} grid {} has no rings, sectors or area", name, g));
    cells += std::int64_t{row[1]} * row[2];
    in.require(cells < no_limit, fmt::format("its {} grids are too large", name));
    mesh.round_grids.push_back(
        {.facet = row[0], .shape = shape, .rings = row[1], .sectors = row[2]});
  }
  const auto element = in.integers(in.field(), (name + "_element").c_str(), static_cast<int>(cells),
                                   -1, mesh.element_count());
  auto next = element.begin();
  for (std::size_t g = first; g < mesh.round_grids.size(); ++g) {
    RoundGrid& grid = mesh.round_grids[g];
    const auto end = next + std::ptrdiff_t{grid.rings} * grid.sectors;
    grid.element = {next, end};
    next = end;
  }
}

void read_round_grids(const SolutionArrays& in, PatchMesh& mesh) {
  constexpr int of_sphere = 4, of_frustum = 10;
  read_grids<Sphere>(in, "sphere", "center_radius", of_sphere, mesh);
  read_grids<Frustum>(in, "frustum", "base_axis_height_radii_inward", of_frustum, mesh);
  std::ranges::sort(mesh.round_grids, {}, &RoundGrid::facet);
}

PatchMesh read_mesh(const SolutionArrays& in, int band_count) {
  PatchMesh mesh;
  const auto positions = read_points(in);
  const int vertex_count = static_cast<int>(positions.size());
  mesh.corners = read_corners(in, vertex_count);
  read_patches(in, band_count, mesh);
  read_round_grids(in, mesh);
  build_topology(mesh, positions);
  // Stored normals replace the rebuilt ones, which may differ in the last bit.
  const auto normal = in.required<double>(in.points(), "normal", vertex_count, 3);
  mesh.vertex_normal.resize(positions.size());
  for (int v = 0; v < vertex_count; ++v) {
    mesh.vertex_normal[v] = Eigen::Map<const Eigen::Vector3d>(normal.row(v));
  }
  return mesh;
}

void read_light(const SolutionArrays& in, const PatchMesh& mesh, RadiositySolution& s) {
  const int K = s.bands.count();
  s.patch_radiosity = in.bands(in.field(), "patch_radiosity", mesh.patch_count(), K);
  s.direct_irradiance = in.bands(in.points(), "direct_irradiance", mesh.vertex_count(), K);
  s.indirect_irradiance = in.bands(in.points(), "indirect_irradiance", mesh.vertex_count(), K);
  if (in.has(in.points(), "caustic_irradiance")) {  // absent without mirrors and glass
    s.caustic_irradiance = in.bands(in.points(), "caustic_irradiance", mesh.vertex_count(), K);
  }
  const auto of_elements = [&](const char* name, Eigen::ArrayXf& values) {
    if (!in.has(in.cells(), name)) return;
    const auto read = in.required<float>(in.cells(), name, mesh.element_count());
    values = Eigen::Map<const Eigen::ArrayXf>(read.row(0), read.rows);
  };
  // Absent in solutions without an estimate.
  of_elements("interpolation_error", s.interpolation_error);
  of_elements("gather_noise", s.gather_noise);
}

// Absent in files of earlier versions.
void read_parts(const SolutionArrays& in, RadiositySolution& s) {
  const std::vector<std::string> names = in.strings("part_names");
  if (names.empty()) return;
  const auto count = static_cast<int>(names.size());
  const auto figures = in.required<double>(in.field(), "part_area_error_estimate", count, 2);
  for (int p = 0; p < count; ++p) {
    const double* row = figures.row(p);
    in.require(std::isfinite(row[0]) && std::isfinite(row[1]),
               fmt::format("part {} has an area or an error that is no number", p));
    s.parts.parts.push_back({.name = names[p], .area = row[0], .error_estimate = row[1]});
  }
  if (in.has(in.field(), "part_is_lit_by_cracks")) {
    const auto by_cracks = in.integers(in.field(), "part_is_lit_by_cracks", count, 0, 2);
    for (std::size_t p = 0; p < by_cracks.size(); ++p) {
      s.parts.parts[p].is_lit_by_cracks = by_cracks[p] != 0;
    }
  }
  const auto patches = static_cast<int>(s.patch_radiosity.rows());
  s.parts.of_patch = in.integers(in.field(), "patch_part", patches, -1, count);
}

void read_record(const SolutionArrays& in, RadiositySolution& s) {
  s.metres_per_unit = in.number("metres_per_unit");
  s.unit_name = in.text("unit_name");
  const auto light = in.strings("light");  // absent in files of earlier versions
  s.relative_units = !light.empty() && light.front() == "relative";
  const auto history = in.optional<double>(in.field(), "history_residual_seconds", 2);
  for (int i = 0; i < history.rows; ++i) {
    s.history.push_back({history.row(i)[0], history.row(i)[1]});
  }
  const auto phases = in.strings("phase_names");
  const auto seconds = in.optional<double>(in.field(), "phase_seconds", 1);
  in.require(static_cast<int>(phases.size()) == seconds.rows,
             "it does not have one time per phase");
  for (int i = 0; i < seconds.rows; ++i) s.seconds.push_back({phases[i], seconds.values[i]});

  s.outcome = static_cast<Outcome>(
      in.integers(in.field(), "outcome", 1, 0, static_cast<int>(Outcome::cut_short) + 1).front());
  s.residual = in.number("residual");
  s.error_estimate = in.number("error_estimate");
  const std::vector<double> energy =
      in.required<double>(in.field(), "energy_emitted_absorbed_escaped_unshot", 1, 4).values;
  s.energy = {energy[0], energy[1], energy[2], energy[3]};
  const auto of_lamps = in.optional<double>(in.field(), "energy_from_lamps_missed", 2);
  if (of_lamps.rows > 0) {  // absent without lamps
    s.energy.from_lamps = of_lamps.values[0];
    s.energy.missed = of_lamps.values[1];
  }

  read_parts(in, s);
  s.provenance = {in.text("version"), in.text("scene_file"), 0, in.text("options")};
  const auto refinement = in.strings("refinement");
  if (!refinement.empty()) s.provenance.refinement = refinement.front();
  s.provenance.looked_from = in.strings("looked_from");
  const std::string hash = in.text("scene_hash");
  const auto parsed =
      std::from_chars(hash.data(), hash.data() + hash.size(), s.provenance.scene_hash, 16);
  in.require(parsed.ec == std::errc{} && parsed.ptr == hash.data() + hash.size(),
             fmt::format("its scene hash '{}' is not a hexadecimal number", hash));
}

}  // namespace

SolvedScene read_solution(const std::filesystem::path& path) {
  check_seal(path);
  PolyDataFile file(path);
  const SolutionArrays in(file);
  SolvedScene solved;
  solved.solution.bands = read_bands(in);
  solved.mesh = read_mesh(in, solved.solution.bands.count());
  read_light(in, solved.mesh, solved.solution);
  read_record(in, solved.solution);
  read_channels(in, solved.mesh, solved.solution);
  if (!solved.solution.channels.empty()) scale_sources(solved);
  return solved;
}

}  // namespace lightwell
