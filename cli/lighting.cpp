#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/lighting_page.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/mesh_bounds.h"
#include "scene/errors.h"
#include "scene/io/lighting_design.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"
#include "viewer/export/start_view.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

/// NAME@NUMBER or NAME=NUMBER.
struct Named {
  std::string name{};
  double value = 0.0;
};

struct LightingArguments {
  std::string scene, solution;
  std::vector<std::string> outputs, surfaces, observers;
  std::vector<Named> planes, watts;
  std::optional<double> margin;  // in the scene file's unit; unset: 0.5 m
  double spacing = 0.0;          // in the scene file's unit; 0: that of EN 12464-1
  double maintenance_factor = 1.0;
  int rays = 1024;
  std::optional<LuxRange> range;
};

Named named_number(const std::string& text, char mark, const char* option) {
  const std::size_t at = text.rfind(mark);
  Named named{.name = text.substr(0, at)};
  if (at != std::string::npos && at > 0) {
    const char* const last = text.data() + text.size();
    const auto [end, bad] = std::from_chars(text.data() + at + 1, last, named.value);
    if (bad == std::errc() && end == last && named.value > 0.0 && named.value < 1e9) return named;
  }
  throw CLI::ValidationError(
      option, fmt::format("'{}' is not NAME{}NUMBER with a number above 0", text, mark));
}

int find_surface(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    if (scene.surfaces[i].name == name) return static_cast<int>(i);
    names.push_back(scene.surfaces[i].name);
  }
  throw InputError(fmt::format("{}: there is no surface '{}'{}; 'lightwell info' lists them",
                               scene.file.string(), name, did_you_mean(name, names)));
}

// One row per name of emitters and lamps. Installed power is that of the scene and its photometric
// files (`design`); 0 if the power of one emitter of the name is unknown.
std::vector<LuminaireRow> luminaires(const Scene& scene, const PatchMesh& mesh,
                                     const DirectLight& direct_light,
                                     const LightingDesign& design) {
  std::vector<LuminaireRow> rows;
  const auto row_of = [&](const std::string& name) -> LuminaireRow& {
    const auto at = std::ranges::find(rows, name, &LuminaireRow::name);
    return at != rows.end() ? *at : rows.emplace_back(LuminaireRow{.name = name});
  };
  std::set<std::string> partly_known;
  std::vector<char> counted(scene.surfaces.size(), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const auto s = static_cast<std::size_t>(mesh.surface[p]);
    if (!scene.materials[static_cast<std::size_t>(scene.surfaces[s].material)].is_emitter()) {
      continue;
    }
    LuminaireRow& row = row_of(scene.surfaces[s].name);
    partly_known.insert(row.name);
    row.count += counted[s] == 0 ? 1 : 0;
    counted[s] = 1;
    row.flux += mesh.area[p] * luminous(scene.bands, mesh.emission.row(p).transpose());
  }
  for (const FreeSource& source : direct_light.free_sources()) {
    const auto* light = std::get_if<LampLight>(&source.shape);
    if (!light) continue;
    LuminaireRow& row = row_of(light->lamp.name);
    ++row.count;
    row.flux += total_weight(source) * luminous(scene.bands, source.light);
    const auto i = static_cast<std::size_t>(source.number);
    const double known = i < design.watts.size() ? design.watts[i] : 0.0;
    row.watts += known;
    if (!(known > 0.0)) partly_known.insert(row.name);
  }
  for (LuminaireRow& row : rows) {
    if (partly_known.contains(row.name)) row.watts = 0.0;
  }
  return rows;
}

// Replaces the installed power of the luminaires named by --watts.
void set_watts(std::vector<LuminaireRow>& rows, const std::vector<Named>& watts,
               const Scene& scene) {
  for (const Named& known : watts) {
    const auto at = std::ranges::find(rows, known.name, &LuminaireRow::name);
    if (at == rows.end()) {
      throw InputError(fmt::format("{}: there is no luminaire '{}', which '--watts' names",
                                   scene.file.string(), known.name));
    }
    at->watts = at->count * known.value;
  }
}

/// Points of the grids: those of the scene file, of --surface and of --plane, in this order.
std::vector<CalculationSurface> grids(const LightingArguments& arguments, const Scene& scene,
                                      const LightingDesign& design, const Eigen::Vector3d& up) {
  std::vector<CalculationSurface> surfaces;
  const double metres = scene.metres_per_unit;
  const double spacing = arguments.spacing * metres;
  constexpr double strip = 0.5;  // m; strip along walls that EN 12464-1 leaves out
  const double margin = arguments.margin ? *arguments.margin * metres : strip;
  for (const CalculationGrid& grid : design.grids) {
    const double usual = grid.height > 0.0 ? margin : 0.0;
    surfaces.push_back(
        {.grid = lux_grid(scene, grid.surface, up,
                          {.height = grid.height,
                           .margin = grid.margin.value_or(usual),
                           .spacing = grid.spacing > 0.0 ? grid.spacing : spacing})});
    surfaces.back().grid.name = grid.name;
  }
  for (const std::string& name : arguments.surfaces) {
    surfaces.push_back(
        {.grid = lux_grid(scene, find_surface(scene, name), up, {.spacing = spacing})});
  }
  for (const Named& plane : arguments.planes) {
    surfaces.push_back(
        {.grid = lux_grid(scene, find_surface(scene, plane.name), up,
                          {.height = plane.value * metres, .margin = margin, .spacing = spacing})});
    surfaces.back().grid.name =
        fmt::format("{} + {:g} {}", plane.name, plane.value, scene.unit_name);
  }
  return surfaces;
}

// Bound of the first point that has the given illuminance; null where nothing is known.
Json within_of(const LuxField& field, double lux) {
  Eigen::Index at = 0;
  (field.lux - lux).abs().minCoeff(&at);
  const double within = field.lux_within[at];
  return std::isfinite(within) ? Json(within) : Json();
}

Json figures_json(const LightingReport& report) {
  Json surfaces = Json::array(), observers = Json::array(), lamps = Json::array();
  for (const CalculationSurface& surface : report.surfaces) {
    const auto& [grid, field] = surface;
    surfaces.push_back({{"name", grid.name},
                        {"E_m", field.mean},
                        {"E_min", field.least},
                        {"E_max", field.greatest},
                        {"E_min_within", within_of(field, field.least)},
                        {"E_max_within", within_of(field, field.greatest)},
                        {"U_0", field.uniformity},
                        {"mean_within", field.mean_within * field.mean},
                        {"point_within_relative", field.point_within},
                        {"points", grid.points.size()},
                        {"spacing_m", {grid.step_u, grid.step_v}},
                        {"height_m", grid.options.height},
                        {"margin_m", grid.options.margin},
                        {"area_m2", grid.area}});
    if (const auto power = power_density(report, surface)) {
      surfaces.back()["W_per_m2"] = power->watts_per_area;
      surfaces.back()["W_per_m2_per_100_lx"] = power->per_hundred_lux;
    }
  }
  for (const auto& [name, glare] : report.observers) {
    Json sources = Json::array();
    for (const GlareSource& source : glare.sources) {
      sources.push_back({{"name", source.name},
                         {"luminance", source.luminance},
                         {"solid_angle", source.solid_angle},
                         {"position_index", source.position_index}});
    }
    Json ugr;  // null: no luminaire in sight
    if (glare.ugr) ugr = *glare.ugr;
    observers.push_back({{"name", name},
                         {"UGR", std::move(ugr)},
                         {"background_luminance", glare.background},
                         {"sources", std::move(sources)},
                         {"left_out", glare.left_out}});
  }
  for (const LuminaireRow& row : report.luminaires) {
    lamps.push_back({{"name", row.name}, {"number", row.count}, {"lumens", row.flux}});
    if (row.watts > 0.0) lamps.back()["watts"] = row.watts;
  }
  return {{"maintenance_factor", report.maintenance_factor},
          {"luminaires", std::move(lamps)},
          {"surfaces", std::move(surfaces)},
          {"observers", std::move(observers)}};
}

std::string points_csv(const LightingReport& report) {
  std::string csv = "surface,x,y,z,lux,lux_within\n";
  for (const auto& [grid, field] : report.surfaces) {
    std::string name = grid.name;
    for (std::size_t at = 0; (at = name.find('"', at)) != std::string::npos; at += 2) {
      name.insert(at, 1, '"');
    }
    // A spreadsheet would compute a name that begins like a formula.
    if (name.find_first_of("=+-@") == 0) name.insert(0, 1, '\'');
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const Eigen::Vector3d p = grid.points[i].position / report.metres_per_unit;
      const double lux = field.lux[static_cast<Eigen::Index>(i)];
      const double within = field.lux_within[static_cast<Eigen::Index>(i)];
      csv += fmt::format("\"{}\",{:.6g},{:.6g},{:.6g},{:.6g},", name, p.x(), p.y(), p.z(), lux);
      csv += std::isnan(within) ? "\n" : fmt::format("{:.3g}\n", within);
    }
  }
  return csv;
}

void print_figures(const LightingReport& report) {
  for (const CalculationSurface& surface : report.surfaces) {
    const LuxField& field = surface.field;
    fmt::print("{}: E_m {:.4g} lx (± {:.2g} %), E_min {:.4g}, E_max {:.4g}, U_0 {:.2f}\n",
               surface.grid.name, field.mean, 100.0 * field.mean_within, field.least,
               field.greatest, field.uniformity);
    if (const auto power = power_density(report, surface)) {
      fmt::print("{}: {:.2f} W/m2, {:.2f} W/m2 per 100 lx\n", surface.grid.name,
                 power->watts_per_area, power->per_hundred_lux);
    }
  }
  for (const auto& [name, glare] : report.observers) {
    if (glare.ugr) {
      fmt::print("{}: UGR {:.1f}\n", name, *glare.ugr);
    } else {
      fmt::print("{}: no luminaire in sight, so no UGR\n", name);
    }
  }
}

/// A solved scene with what rays from points need.
struct MeasurableScene {
  MeasurableScene(const Scene& of, const SolvedScene& solved)
      : scene(of), solution(solved.solution), caster(solved.mesh), direct_light(of, solved.mesh) {}

  const Scene& scene;
  const RadiositySolution& solution;
  ElementCaster caster;
  DirectLight direct_light;
};

void measure_surfaces(const MeasurableScene& lit, const GatherOptions& gathering,
                      LightingReport& made) {
  for (CalculationSurface& surface : made.surfaces) {
    surface.grid = without_buried_points(lit.caster, std::move(surface.grid));
    surface.field = measure_grid(lit.scene, lit.caster, lit.direct_light, lit.solution,
                                 surface.grid, made.maintenance_factor, gathering);
    stop_if_interrupted();
  }
}

std::vector<Observer> rate_glare(const MeasurableScene& lit,
                                 const std::vector<std::string>& cameras,
                                 const LightingDesign& design, GatherOptions gathering) {
  constexpr int rays_of_an_eye = 1 << 14;
  gathering.rays = std::max(gathering.rays, rays_of_an_eye);
  std::vector<Observer> observers;
  for (const std::string& name : cameras) {
    observers.push_back({.name = name,
                         .glare = unified_glare_rating(lit.scene, lit.caster, lit.direct_light,
                                                       lit.solution, choose_camera(lit.scene, name),
                                                       gathering, design.luminous_height)});
    stop_if_interrupted();
  }
  return observers;
}

void write_outputs(const LightingArguments& arguments, const LightingReport& made,
                   const Json& figures, Report& report) {
  for (const std::filesystem::path file : arguments.outputs) {
    const std::string kind = lower_extension(file);
    if (kind == ".html") write_whole(file, {lighting_page(made, arguments.range)});
    if (kind == ".csv") write_whole(file, {points_csv(made)});
    if (kind == ".json") write_json(file, figures);
    report.add_file(file);
  }
}

int report_lighting(const LightingArguments& arguments, Console& console) {
  Report report(console.options());
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  if (scene.relative_units) {
    throw InputError(
        fmt::format("{}: the scene names no unit of light, so no illuminance can be reported",
                    arguments.scene));
  }
  for (const std::string& file : arguments.outputs) require_writable(file);
  const LightingDesign design = read_lighting_design(scene);
  if (design.grids.empty() && arguments.surfaces.empty() && arguments.planes.empty() &&
      arguments.observers.empty()) {
    throw InputError(
        "there is nothing to report; name surfaces with '--surface floor', planes above surfaces "
        "with '--plane floor@0.75' or as [[grids]] in the scene file, or observers with "
        "'--observer CAMERA'");
  }
  const SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  LightingReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                      .provenance = solved.solution.provenance,
                      .metres_per_unit = scene.metres_per_unit,
                      .unit_name = scene.unit_name,
                      .maintenance_factor = arguments.maintenance_factor,
                      .rays = arguments.rays,
                      .error_estimate = solved.solution.error_estimate};
  // --surface and --plane name surfaces of the file, which merge_planar_regions() may have joined
  // with others: names->apart() separates them again.
  made.surfaces = grids(arguments, clean_up.names ? clean_up.names->apart(scene) : scene, design,
                        guess_up_axis(scene.cameras, mesh_bounds(solved.mesh)));
  const Stopwatch watch;
  const MeasurableScene lit(scene, solved);
  made.luminaires = luminaires(scene, solved.mesh, lit.direct_light, design);
  set_watts(made.luminaires, arguments.watts, scene);
  GatherOptions gathering{.rays = arguments.rays};
  gathering.run.progress = console.progress();
  measure_surfaces(lit, gathering, made);
  made.observers = rate_glare(lit, arguments.observers, design, gathering);
  console.finish_phase();
  report.add_phase("measure", watch.seconds());
  const Json figures = figures_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  write_outputs(arguments, made, figures, report);
  if (!console.options().json) print_figures(made);
  report.print();
  return exit_done;
}

}  // namespace

Action add_report(CLI::App& command) {
  const auto arguments = std::make_shared<LightingArguments>();
  command.description(
      "Reports a lighting design: mean and least illuminance and uniformity of surfaces and "
      "working\nplanes, glare (UGR) of observers, the luminaires; as a page, JSON or CSV.");
  command.add_option("scene", arguments->scene, "the scene file")->required()->type_name("SCENE");
  command.add_option("solution", arguments->solution, "the scene's solution, .vtp")
      ->required()
      ->type_name("SOLUTION");
  command
      .add_option("-o,--output", arguments->outputs,
                  ".html (a page to print), .json (all figures) or .csv (every point); may be "
                  "repeated")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".html", ".json", ".csv"}));
  command.add_option("--surface", arguments->surfaces, "measure on this surface; may be repeated")
      ->type_name("NAME")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>(
          "--plane",
          [arguments](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              arguments->planes.push_back(named_number(text, '@', "--plane"));
            }
          },
          "measure on a plane at this height above a surface: floor@0.75; may be repeated")
      ->type_name("NAME@HEIGHT")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option("--margin", arguments->margin,
                  "strip along the outline of planes that is left out (default 0.5 m)")
      ->type_name("LENGTH")
      ->check(CLI::NonNegativeNumber.description(""));  // no ":NONNEGATIVE" in --help
  command
      .add_option("--spacing", arguments->spacing,
                  "largest distance between points (default: by EN 12464-1)")
      ->type_name("LENGTH")
      ->check(positive());
  command
      .add_option("--maintenance", arguments->maintenance_factor,
                  "maintenance factor of all illuminances, above 0 up to 1 (default 1)")
      ->type_name("FACTOR")
      ->check(CLI::Range(1e-6, 1.0).description(""));  // no ":FLOAT in ..." in --help
  command
      .add_option("--observer", arguments->observers,
                  "camera for whose eye UGR is computed; may be repeated")
      ->type_name("CAMERA")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>(
          "--watts",
          [arguments](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              arguments->watts.push_back(named_number(text, '=', "--watts"));
            }
          },
          "electric power of each luminaire of this name; may be repeated")
      ->type_name("NAME=W")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option("--rays", arguments->rays, "gather rays per point, a power of two (default 1024)")
      ->type_name("N")
      ->check(power_of_two());
  add_lux_range(command, arguments->range);
  command.footer(
      "Example: lightwell report office.toml office.vtp --plane floor@0.75 --maintenance 0.8 "
      "--observer desk -o office.html");
  return [arguments](Console& console) { return report_lighting(*arguments, console); };
}

}  // namespace lightwell
