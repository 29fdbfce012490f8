#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>

#include "cli/arguments.h"
#include "cli/channels.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/report.h"
#include "cli/scene_hints.h"
#include "cli/steps.h"
#include "cli/weather_facts.h"
#include "mesh/cleaning/mesh_quality.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solution/solution_file.h"
#include "raytrace/pictures/image.h"
#include "raytrace/readings/ugr_table.h"
#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/read_scene.h"
#include "scene/io/text_file.h"
#include "scene/picture_cells.h"
#include "scene/projected_picture.h"

namespace lightwell {
namespace {

// Area of the emitting sides, m^2: both sides if the material emits from both.
double emitting_area(const Scene& scene, const Surface& surface) {
  const double area = surface_area(surface);
  return scene.materials[surface.material].emits_both_sides ? 2.0 * area : area;
}

// Every surface: its name, material, number of facets (1 for a round shape) and area of one side,
// m^2.
Json surfaces_json(const Scene& scene) {
  Json surfaces = Json::array();
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    surfaces.push_back(
        {{"name", surface.name},
         {"material", scene.materials[static_cast<std::size_t>(surface.material)].name},
         {"facets", mesh ? mesh->facets.size() : 1},
         {"area", surface_area(surface)}});
  }
  return surfaces;
}

Json emitters_json(const Scene& scene) {
  Json emitters = Json::array();
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[surface.material];
    if (!material.is_emitter()) continue;
    const double area = emitting_area(scene, surface);
    const Eigen::ArrayXd M = mean_exitance(scene, surface);
    const double exitance = M.sum();
    Json emitter = {{"surface", surface.name}, {"area", area}, {"exitance", exitance}};
    if (scene.relative_units) {
      emitter["power"] = area * exitance;
    } else {
      emitter["watts_radiated"] = area * exitance;
      emitter["lumens"] = area * luminous(scene.bands, M.cast<float>());
    }
    emitters.push_back(std::move(emitter));
  }
  return emitters;
}

// Irradiance or illuminance of open ground by the sky, position of the sun in degrees (azimuth from
// north over east), and irradiance or illuminance across the sun's rays.
Json sky_json(const Scene& scene) {
  const Sky& sky = *scene.sky;
  const auto amount = [&](const Spectrum& E) {
    return scene.relative_units ? E.cast<double>().mean() : luminous(scene.bands, E);
  };
  const char* const unit = scene.relative_units ? "irradiance" : "lux";
  Json json = {{"is", sky.name}};
  if (has_dome(sky)) {
    json[fmt::format("{}_on_open_ground", unit)] = amount(diffuse_horizontal_irradiance(sky));
  }
  if (sky.sun) {
    const Eigen::Vector3d to_sun = sky.sun->direction, east = sky.north.cross(sky.up);
    constexpr double degrees = 180.0 / std::numbers::pi;
    const double azimuth = std::atan2(to_sun.dot(east), to_sun.dot(sky.north)) * degrees;
    json["sun_altitude"] = std::asin(std::clamp(to_sun.dot(sky.up), -1.0, 1.0)) * degrees;
    json["sun_azimuth"] = azimuth < 0.0 ? azimuth + 360.0 : azimuth;
    json[fmt::format("sun_{}_across_its_rays", unit)] = amount(sky.sun->irradiance);
  }
  return json;
}

// Pixels and beam of a projected picture, and the share of the light that passes it where its
// brightest value counts as open.
void add_projector(const ProjectedPicture& projected, double metres_per_unit, Json& json) {
  const Texture& picture = projected.slide().picture();
  const ProjectorOptics& optics = projected.optics();
  json["pixels"] = {picture.width(), picture.height()};
  json["beam"] = optics.beam * 180.0 / std::numbers::pi;
  if (std::isfinite(optics.focus)) {
    json["focus"] = optics.focus / metres_per_unit;
    json["lens"] = optics.lens / metres_per_unit;
  }
  json["passes_picture"] = projected.flux().mean() / projected.open_flux();
}

Json lamps_json(const Scene& scene) {
  Json lamps = Json::array();
  for (const Lamp& lamp : scene.lamps) {
    const Spectrum flux = lamp_flux(lamp);
    const Eigen::Vector3d at = lamp.position / scene.metres_per_unit;
    const char* const kind = std::holds_alternative<SharedWeb>(lamp.shape)       ? "measured"
                             : std::holds_alternative<SpotCone>(lamp.shape)      ? "spot"
                             : std::holds_alternative<SharedPicture>(lamp.shape) ? "projector"
                                                                                 : "point";
    Json json = {{"name", lamp.name}, {"is", kind}, {"position", {at.x(), at.y(), at.z()}}};
    if (!lamp.opening.is_point()) {
      json["opening"] = {lamp.opening.along_c0, lamp.opening.along_c90};
    }
    if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
      add_projector(**picture, scene.metres_per_unit, json);
    }
    if (lamp.body.is_known()) {
      json["body"] = {lamp.body.along_c0, lamp.body.along_c90, lamp.body.height};
    }
    if (scene.relative_units) {
      json["power"] = flux.cast<double>().sum();
    } else {
      json["watts_radiated"] = flux.cast<double>().sum();
      json["lumens"] = luminous(scene.bands, flux);
    }
    lamps.push_back(std::move(json));
  }
  return lamps;
}

std::string kind_of(const Material& material, bool relative_units) {
  std::vector<std::string> words;
  if (material.dielectric) {
    words.push_back(fmt::format("glass {:.4g}", material.dielectric->index_of_refraction));
  }
  const auto mean = [](const Spectrum& values) { return values.cast<double>().mean(); };
  if ((material.reflectance > 0.0f).any()) {
    words.push_back(fmt::format("reflectance {:.3g}", mean(material.reflectance)));
  }
  if (material.is_translucent()) {
    words.push_back(fmt::format("translucent {:.3g}", mean(material.transmittance)));
  }
  if (material.passes_straight()) {
    words.push_back(fmt::format("transparent {:.3g}", mean(material.regular_transmittance)));
  }
  if (material.texture) {
    const Texture& picture = *material.texture->image.picture;
    words.push_back(fmt::format("texture {} x {}", picture.width(), picture.height()));
  }
  if (material.emission_texture) {
    const Texture& picture = *material.emission_texture->image.picture;
    words.push_back(fmt::format("picture of emission {} x {}", picture.width(), picture.height()));
  }
  if (material.mask) words.emplace_back("mask");
  if (material.relief) {
    const Texture& picture = *material.relief->slopes.picture;
    words.push_back(fmt::format("relief {} x {}", picture.width(), picture.height()));
  }
  if (material.coat) {
    words.push_back(
        fmt::format("coat {:.4g}{}", material.coat->index_of_refraction,
                    material.specular_roughness > 0.0f
                        ? fmt::format(" of roughness {:.3g}", material.specular_roughness)
                        : ""));
  } else if ((material.specular > 0.0f).any()) {
    words.push_back(fmt::format("mirror {:.3g}", mean(mean_mirrored(material))));
  }
  if (material.is_emitter()) {
    words.push_back(fmt::format("exitance {:.4g}{}{}", material.emission.cast<double>().sum(),
                                relative_units ? "" : " W/m2",
                                material.emits_both_sides ? " on both sides" : ""));
  }
  if (words.empty()) words.push_back("black");
  if (material.one_sided) words.push_back("one-sided");
  return fmt::format("{}", fmt::join(words, ", "));
}

Json corner_json(const Eigen::Vector3d& metres, const Scene& scene) {
  const Eigen::Vector3d p = metres / scene.metres_per_unit;
  return {p.x(), p.y(), p.z()};
}

Json quality_json(const Scene& scene) {
  const MeshQuality quality = mesh_quality(scene);
  return {{"triangles", quality.triangles},
          {"dropped", scene.dropped_polygons},
          {"slivers", quality.slivers},
          {"open_edges", quality.open_edges},
          {"non_manifold_edges", quality.non_manifold_edges},
          {"inconsistent_edges", quality.inconsistent_edges}};
}

Json scene_json(const Scene& scene) {
  std::size_t spheres = 0, frustums = 0;
  for (const Surface& surface : scene.surfaces) {
    spheres += std::holds_alternative<Sphere>(surface.shape) ? 1 : 0;
    frustums += std::holds_alternative<Frustum>(surface.shape) ? 1 : 0;
  }
  const Bounds bounds = scene_bounds(scene);
  CleanUpReport clean_up;
  const Scene clean = merge_planar_regions(scene, &clean_up);
  Json materials = Json::array(), cameras = Json::array();
  for (const Material& material : clean.materials) {
    materials.push_back({{"name", material.name}, {"is", kind_of(material, scene.relative_units)}});
  }
  for (const Camera& camera : scene.cameras) {
    cameras.push_back({{"name", camera.name},
                       {"width", camera.width},
                       {"height", camera.height},
                       {"projection", named(camera.projection).name},
                       {"fov", camera.fov_degrees}});
  }
  Json facts = {{"kind", "scene"},
                {"title", scene.title},
                {"unit", scene.unit_name},
                {"metres_per_unit", scene.metres_per_unit},
                {"light", light_name(scene.relative_units)},
                {"bounds", {corner_json(bounds.low, scene), corner_json(bounds.high, scene)}},
                {"bands", scene.bands.names},
                {"surfaces", scene.surfaces.size()},
                {"facets", scene_facets(scene).size()},
                {"spheres", spheres},
                {"frustums", frustums},
                {"quality", quality_json(scene)},
                {"cleaned", clean_up_json(clean_up)},
                {"materials", std::move(materials)},
                {"emitters", emitters_json(clean)},
                {"cameras", std::move(cameras)},
                {"notes", scene.notes},
                {"scene_hash", fmt::format("{:016x}", scene_hash(clean))}};
  if (!scene.lamps.empty()) facts["lamps"] = lamps_json(scene);
  if (scene.sky) facts["sky"] = sky_json(scene);
  return facts;
}

Json luminaire_json(const LuminaireFile& luminaire) {
  constexpr double half = 0.5, tenth = 0.1;
  const PhotometricWeb& web = *luminaire.web;
  const auto angles = [&](double share) {
    return Json{{"C0", beam_angle(web, 0.0, share)}, {"C90", beam_angle(web, 90.0, share)}};
  };
  Json facts = {{"kind", "luminaire"},
                {"format", luminaire.format},
                {"name", luminaire.name},
                {"maker", luminaire.maker},
                {"planes", web.planes().size()},
                {"gammas", web.gammas().size()},
                {"symmetry", luminaire.symmetry},
                {"beam_angle", angles(half)},
                {"field_angle", angles(tenth)}};
  const LampOpening& opening = luminaire.opening;
  if (!opening.is_point()) {
    facts["opening"] = {{"along_c0", opening.along_c0},
                        {"along_c90", opening.along_c90},
                        {"is", opening.is_round ? "round" : "rectangle"}};
  }
  if (const LampBody& body = luminaire.body; body.is_known()) {
    facts["body"] = {{"along_c0", body.along_c0},
                     {"along_c90", body.along_c90},
                     {"height", body.height},
                     {"is", body.is_round ? "cylinder" : "box"}};
  }
  if (!luminaire.spectra.empty()) {
    Json spectra = Json::array();
    for (const EmitterSpectrum& spectrum : luminaire.spectra) {
      spectra.push_back({{"name", spectrum.name},
                         {"lumens", spectrum.flux},
                         {"from_nm", spectrum.samples.wavelengths_nm.front()},
                         {"to_nm", spectrum.samples.wavelengths_nm.back()},
                         {"samples", spectrum.samples.values.size()}});
    }
    facts["spectra"] = std::move(spectra);
  }
  if (luminaire.is_radiometric) {
    facts["watts_radiated"] = luminaire.flux();
    facts["peak_watts_per_sr"] = web.peak();
  } else {
    facts["lumens"] = luminaire.flux();
    facts["peak_candela"] = web.peak();
    if (luminaire.watts > 0.0) facts["lumens_per_watt"] = luminaire.flux() / luminaire.watts;
    if (luminaire.lamp_lumens > 0.0) {
      facts["lamp_lumens"] = luminaire.lamp_lumens;
      facts["light_output_ratio"] = luminaire.flux() / luminaire.lamp_lumens;
    }
  }
  if (luminaire.watts > 0.0) facts["input_watts"] = luminaire.watts;
  std::vector<std::string> notes = luminaire.notes;
  if (luminaire.is_radiometric) {
    notes.emplace_back("The intensities are radiant, in W/sr, not in candela: no lux are known.");
  }
  facts["notes"] = notes;
  return facts;
}

/// UGR table for JSON. Rooms are X x Y in multiples of the height of the luminaires above the eye;
/// reflectances are those of ceiling, walls and floor in percent.
Json ugr_json(const UgrTable& table) {
  const auto rows = [](const UgrTable::Ratings& ratings) {
    Json all = Json::array();
    for (const auto& row : ratings.rowwise()) all.push_back(std::vector(row.begin(), row.end()));
    return all;
  };
  Json rooms = Json::array(), reflectances = Json::array();
  for (const auto& [across, along] : ugr_rooms) rooms.push_back({across, along});
  for (const auto& [ceiling, walls, floor] : ugr_reflectances) {
    reflectances.push_back({100.0 * ceiling, 100.0 * walls, 100.0 * floor});
  }
  return {{"rooms", std::move(rooms)},
          {"reflectances_percent", std::move(reflectances)},
          {"along_c0", rows(table.along_c0)},
          {"along_c90", rows(table.along_c90)}};
}

void print_ugr(const UgrTable& table) {
  const auto for_both = [](auto&& print) {
    for (int view = 0; view < 2; ++view) {
      for (std::size_t r = 0; r < ugr_reflectances.size(); ++r) print(view, r);
    }
  };
  const auto print_row = [&](const char* name, auto&& share) {
    fmt::print("{:<10}", name);
    for_both(
        [&](int, std::size_t r) { fmt::print("{:>6.0f}", 100.0 * share(ugr_reflectances[r])); });
    fmt::print("\n");
  };
  fmt::print("\n{:<10}{:>30}{:>30}\n", "UGR", "looking along C0", "along C90");
  print_row("ceiling %", [](const UgrReflectances& rho) { return rho.ceiling; });
  print_row("walls %", [](const UgrReflectances& rho) { return rho.walls; });
  print_row("floor %", [](const UgrReflectances& rho) { return rho.floor; });
  for (std::size_t i = 0; i < ugr_rooms.size(); ++i) {
    fmt::print("{:<10}", fmt::format("{}H x {}H", ugr_rooms[i].across, ugr_rooms[i].along));
    for_both([&](int view, std::size_t r) {
      const double ugr = (view == 0 ? table.along_c0 : table.along_c90)(
          static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r));
      constexpr double least = 10.0;  // printed UGR tables have "<10" below
      fmt::print("{:>6}", ugr < least ? "<10" : fmt::format("{:.1f}", ugr));
    });
    fmt::print("\n");
  }
}

Json solution_json(const SolvedScene& solved) {
  const RadiositySolution& solution = solved.solution;
  Json json = {{"kind", "solution"},
               {"version", solution.provenance.version},
               {"scene", solution.provenance.scene_file},
               {"scene_hash", fmt::format("{:016x}", solution.provenance.scene_hash)},
               {"options", solution.provenance.options},
               {"unit", solution.unit_name},
               {"light", light_name(solution.relative_units)},
               {"bands", solution.bands.names},
               {"patches", solved.mesh.patch_count()},
               {"elements", solved.mesh.element_count()},
               {"energy", energy_json(solution.energy)},
               {"residual", solution.residual},
               {"sweeps", solution.history.size()},
               {"error_estimate", solution.error_estimate},
               {"outcome", outcome_name(solution.outcome)}};
  if (!solution.channels.empty()) json["channels"] = channels_json(solution);
  return json;
}

Json picture_json(const Image& image) {
  const auto means = image.radiance.cast<double>().colwise().mean().eval();
  return {{"kind", "picture"},
          {"width", image.width},
          {"height", image.height},
          {"mean_radiance", std::vector<double>(means.data(), means.data() + means.size())},
          {"largest", image.radiance.maxCoeff()}};
}

Json describe(const std::string& file, bool with_surfaces, const CommonOptions& options) {
  const std::string extension = lower_extension(file);
  if (extension == ".vtp") return solution_json(read_solution(file));
  if (extension == ".exr") return picture_json(read_exr(file));
  if (is_luminaire_file(file)) return luminaire_json(read_luminaire(file));
  if (is_weather_file(file)) return weather_json(read_weather(file));
  Scene scene = [&] {
    const InterruptEndsAtOnce at_once;
    return read_scene(file, allowed_references(options));
  }();
  refuse_losses(scene, options);
  std::ranges::copy(scene_hints(scene), std::back_inserter(scene.notes));
  Json facts = scene_json(scene);
  if (with_surfaces) facts["surface_list"] = surfaces_json(scene);
  return facts;
}

// Prints each value on a line; in a list of objects and in the notes each item has a line.
void print_for_people(const Json& facts) {
  const auto word = [](const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    return value.dump();
  };
  const auto words = [&word](const Json& object) {
    std::vector<std::string> parts;
    for (const auto& [key, value] : object.items()) {
      parts.push_back(key == "name" || key == "surface" || key == "is" ? word(value)
                                                                       : key + " " + word(value));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  };
  for (const auto& [key, value] : facts.items()) {
    if (value.is_array() && !value.empty() && (value[0].is_object() || key == "notes")) {
      fmt::print("{} ({})\n", key, value.size());
      for (const Json& item : value) {
        fmt::print("  {}\n", item.is_object() ? words(item) : word(item));
      }
    } else if (value.is_object()) {
      fmt::print("{:<16} {}\n", key, words(value));
    } else if (value.is_array()) {
      std::vector<std::string> parts;
      for (const Json& item : value) parts.push_back(word(item));
      fmt::print("{:<16} {}\n", key, fmt::join(parts, " "));
    } else if (!(value.is_string() && value.get<std::string>().empty())) {
      fmt::print("{:<16} {}\n", key, word(value));
    }
  }
}

}  // namespace

Action add_info(CLI::App& command) {
  struct Arguments {
    std::string file{};
    bool ugr = false, surfaces = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  command.description(
      fmt::format("Describes a scene ({}), a solution (.vtp), a picture (.exr), a luminaire "
                  "(.ies, .ldt, TM-33 .xml) or a year's weather (.epw, .wea).",
                  scene_extensions));
  command.add_option("file", arguments->file, "the file")->required()->type_name("FILE");
  command.add_flag("--ugr", arguments->ugr,
                   "UGR table of a luminaire in the 19 standard rooms (CIE 117, CIE 190)");
  command.add_flag("--surfaces", arguments->surfaces,
                   "also each surface of a scene: name, material, facets, area");
  command.footer("Example: lightwell info cornell/cornell.toml");
  return [arguments](Console& console) {
    const std::string& file = arguments->file;
    if (arguments->ugr && !is_luminaire_file(file)) {
      throw InputError(
          fmt::format("{}: '--ugr' is for luminaires (.ies, .ldt, TM-33 .xml); 'lightwell report' "
                      "has the UGR of a room",
                      file));
    }
    Json facts = describe(file, arguments->surfaces, console.options());
    if (!arguments->ugr) {
      console.options().json ? print_json(facts) : print_for_people(facts);
      return int{exit_done};
    }
    const UgrTable table = ugr_table(read_luminaire(file));
    if (console.options().json) {
      facts["ugr"] = ugr_json(table);
      print_json(facts);
    } else {
      print_for_people(facts);
      print_ugr(table);
    }
    return int{exit_done};
  };
}

}  // namespace lightwell
