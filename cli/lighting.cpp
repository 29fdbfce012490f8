#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/grid_arguments.h"
#include "cli/interrupt.h"
#include "cli/lighting/figures.h"
#include "cli/lighting/measure.h"
#include "cli/lighting/page.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/mesh_bounds.h"
#include "raytrace/pictures/encode_png.h"
#include "raytrace/scene_renderer.h"
#include "scene/errors.h"
#include "scene/io/lighting_design.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"
#include "viewer/export/start_view.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

struct LightingArguments {
  std::string scene, solution;
  std::vector<std::string> outputs, observers;
  GridArguments grids;
  std::vector<NamedNumber> watts;
  double maintenance_factor = 1.0;
  int rays = 1024;
  std::optional<LuxRange> range;
  std::string picture;  // camera; empty: the first; no_picture: none
};

constexpr const char* no_picture = "none";

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
    row.flux += total_weight(source) * luminous(scene.bands, mean_light(source));
    const auto i = static_cast<std::size_t>(source.number);
    const double known = i < design.watts.size() ? design.watts[i] : 0.0;
    row.watts += known;
    if (!(known > 0.0)) partly_known.insert(row.name);
    const SharedLuminaireFile file = i < design.files.size() ? design.files[i] : nullptr;
    if (row.count == 1) row.file = file;
    if (row.file != file) row.file = nullptr;
  }
  for (LuminaireRow& row : rows) {
    if (partly_known.contains(row.name)) row.watts = 0.0;
  }
  return rows;
}

// Replaces the installed power of the luminaires named by --watts.
void set_watts(std::vector<LuminaireRow>& rows, const std::vector<NamedNumber>& watts,
               const Scene& scene) {
  for (const NamedNumber& known : watts) {
    const auto at = std::ranges::find(rows, known.name, &LuminaireRow::name);
    if (at == rows.end()) {
      throw InputError(fmt::format("{}: there is no luminaire '{}', which '--watts' names",
                                   scene.file.string(), known.name));
    }
    at->watts = at->count * known.value;
  }
}

// The picture of the named camera, of the first one by default, with light from the solution alone.
// Empty for a scene without cameras.
std::optional<ReportPicture> picture_of(const LightingArguments& arguments, const Scene& scene,
                                        const SolvedScene& solved, const Progress& progress) {
  if (arguments.picture == no_picture || scene.cameras.empty()) return {};
  constexpr int width = 1000;  // pixels
  const Camera camera = resized(
      arguments.picture.empty() ? scene.cameras.front() : choose_camera(scene, arguments.picture),
      width);
  SceneRenderer renderer(scene, solved.mesh, solved.solution);
  const Image image = renderer.render(
      camera, {.pass = Pass::interpolate, .photons = 0, .run = {.progress = progress}});
  ToneMapping tone;
  if (const auto light = renderer.incident_light(camera)) tone.metered_scale = light->exposure;
  return ReportPicture{
      .camera = camera.name,
      .width = camera.width,
      .height = camera.height,
      .png = encode_png(camera.width, camera.height, tone_map(image, scene.bands, tone))};
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

bool needs_picture(const LightingArguments& arguments) {
  return std::ranges::any_of(
      arguments.outputs, [](const std::string& file) { return lower_extension(file) == ".html"; });
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
  if (design.grids.empty() && arguments.grids.is_empty() && arguments.observers.empty()) {
    throw InputError(
        "there is nothing to report; name surfaces with '--surface floor', planes above surfaces "
        "with '--plane floor@0.75' or as [[grids]] in the scene file, or observers with "
        "'--observer CAMERA'");
  }
  // Names are looked up before anything is computed.
  std::vector<Camera> eyes;
  for (const std::string& name : arguments.observers) eyes.push_back(choose_camera(scene, name));
  if (!arguments.picture.empty() && arguments.picture != no_picture) {
    choose_camera(scene, arguments.picture);
  }
  SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  LightingReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                      .heading = design.heading,
                      .provenance = solved.solution.provenance,
                      .metres_per_unit = scene.metres_per_unit,
                      .unit_name = scene.unit_name,
                      .maintenance_factor = arguments.maintenance_factor,
                      .rays = arguments.rays,
                      .error_estimate = solved.solution.error_estimate};
  if (scene.sky) {
    made.sky = scene.sky->name.empty() ? "sky" : scene.sky->name;
    made.north = scene.sky->north;
  }
  const Stopwatch watch;
  made.luminaires = luminaires(scene, solved.mesh, DirectLight(scene, solved.mesh), design);
  set_watts(made.luminaires, arguments.watts, scene);
  Measurements what;
  what.eyes = std::move(eyes);
  what.maintenance_factor = arguments.maintenance_factor;
  what.gathering.rays = arguments.rays;
  what.luminous_heights = design.luminous_height;
  what.between = stop_if_interrupted;
  what.gathering.run.progress = console.progress();
  // --surface and --plane name surfaces of the file, which merge_planar_regions() may have joined
  // with others: names->apart() separates them again.
  const ElementCaster caster(solved.mesh);
  for (LuxGrid& grid :
       arguments.grids.grids(clean_up.names ? clean_up.names->apart(scene) : scene, design,
                             guess_up_axis(scene.cameras, mesh_bounds(solved.mesh)))) {
    what.grids.push_back(without_buried_points(caster, std::move(grid)));
  }
  measure(scene, solved, what, made);
  if (needs_picture(arguments)) {
    made.picture = picture_of(arguments, scene, solved, console.progress());
  }
  console.finish_phase();
  report.add_phase("measure", watch.seconds());
  const Json figures = figures_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  write_outputs(arguments, made, figures, report);
  if (!console.options().json) fmt::print("{}", figures_text(made));
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
  arguments->grids.add_to(command);
  command
      .add_option("--maintenance", arguments->maintenance_factor,
                  "maintenance factor of electric light, above 0 up to 1 (default 1)")
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
              arguments->watts.push_back(
                  named_number(text, '=', "--watts", std::numeric_limits<double>::min()));
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
  command
      .add_option("--picture", arguments->picture,
                  "camera of the picture on the page (default: the first), or none")
      ->type_name("CAMERA");
  command.footer(
      "Example: lightwell report office.toml office.vtp --plane floor@0.75 --maintenance 0.8 "
      "--observer desk -o office.html");
  return [arguments](Console& console) { return report_lighting(*arguments, console); };
}

}  // namespace lightwell
