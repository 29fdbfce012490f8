#include "viewer/report/make_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/elements/element_caster.h"
#include "mesh/patches/mesh_bounds.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/free_source.h"
#include "raytrace/cameras/choose_camera.h"
#include "raytrace/pictures/encode_png.h"
#include "raytrace/scene_renderer.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "standards/activities.h"
#include "standards/lighting_energy.h"
#include "viewer/document/html_document.h"
#include "viewer/document/pdf_document.h"
#include "viewer/export/start_view.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/area_grids.h"
#include "viewer/report/figures.h"
#include "viewer/report/lighting_document.h"
#include "viewer/report/measure.h"

namespace lightwell {
namespace {

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
  std::map<std::string, Spectrum> spectra;  // flux in W
  const auto add_spectrum = [&](const std::string& name, const Spectrum& watts) {
    Spectrum& sum = spectra[name];
    sum = sum.size() > 0 ? Spectrum(sum + watts) : watts;
  };
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
    add_spectrum(row.name, static_cast<float>(mesh.area[p]) * mesh.emission.row(p).transpose());
  }
  for (const FreeSource& source : direct_light.free_sources()) {
    const auto* light = std::get_if<LampLight>(&source.shape);
    if (!light) continue;
    LuminaireRow& row = row_of(light->lamp.name);
    ++row.count;
    row.flux += total_weight(source) * luminous(scene.bands, mean_light(source));
    add_spectrum(row.name, static_cast<float>(total_weight(source)) * mean_light(source));
    const auto i = static_cast<std::size_t>(source.number);
    const double known = i < design.watts.size() ? design.watts[i] : 0.0;
    row.watts += known;
    if (!(known > 0.0)) partly_known.insert(row.name);
    const SharedLuminaireFile file = i < design.files.size() ? design.files[i] : nullptr;
    if (row.count == 1) row.file = file;
    if (row.file != file) row.file = nullptr;
  }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr RatedColour undefined{.rendering = nan, .within = nan};
  for (LuminaireRow& row : rows) {
    if (partly_known.contains(row.name)) row.watts = 0.0;
    const auto power = spectral_power(scene.bands, spectra[row.name]);
    if (power && row.flux > 0.0) row.colour = rated_colour(*power).value_or(undefined);
  }
  return rows;
}

// Replaces the installed power of the luminaires whose power is given.
void set_watts(std::vector<LuminaireRow>& rows, const std::vector<NamedNumber>& watts,
               const Scene& scene) {
  for (const NamedNumber& known : watts) {
    const auto at = std::ranges::find(rows, known.name, &LuminaireRow::name);
    if (at == rows.end()) {
      throw InputError(fmt::format("{}: there is no luminaire '{}', whose power is given",
                                   scene.file.string(), known.name));
    }
    at->watts = at->count * known.value;
  }
}

// The picture of the named camera, of the first one by default, with light from the solution alone.
// Empty for a scene without cameras.
std::optional<ReportPicture> picture_of(const ReportRequest& asked, const Scene& scene,
                                        const SolvedScene& solved, const Progress& progress) {
  if (!asked.has_picture || scene.cameras.empty()) return {};
  constexpr int width = 1000;  // pixels
  const Camera camera = resized(choose_camera(scene, asked.camera), width);
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

// The areas of the design, and one for each working plane that has none if all are asked for.
std::vector<DesignArea> areas_of(const ReportPlan& plan, const std::vector<LuxGrid>& grids) {
  std::vector<DesignArea> areas = plan.design.areas;
  if (plan.request.activity.empty()) return areas;
  for (int g = 0; g < static_cast<int>(grids.size()); ++g) {
    const LuxGrid& grid = grids[static_cast<std::size_t>(g)];
    const bool is_plane = grid.options.height > 0.0 && grid.quantity == GridQuantity::planar;
    const bool has_area = std::ranges::find(areas, g, &DesignArea::grid) != areas.end();
    if (!is_plane || has_area) continue;
    areas.push_back({.name = fmt::format("{} ({})", grid.name, plan.request.activity),
                     .activity = plan.request.activity,
                     .grid = g,
                     .observers = plan.request.observers});
  }
  if (areas.empty()) {
    throw InputError(
        "there is no working plane to hold to the activity; name one with '--plane floor@0.75', or "
        "as [[grids]] with a height");
  }
  return areas;
}

// Refuses emergency light that cannot be told from daylight.
void require_lamps_alone(const std::vector<DesignArea>& areas, LightContent content) {
  if (content == LightContent::electric || content == LightContent::apart) return;
  for (const DesignArea& area : areas) {
    if (!area.emergency) continue;
    throw InputError(fmt::format(
        "area '{}': EN 1838 counts luminaires alone, and the solution {}", area.name,
        content == LightContent::daylight
            ? "has no electric light that is switched on; relight it"
            : "does not keep electric light and daylight apart; solve without '--channels off'"));
  }
}

// Heading and provenance of a report, without measurements.
LightingReport report_of(const ReportPlan& plan, const Scene& scene, const SolvedScene& solved) {
  LightingReport made{
      .title = scene.title.empty() ? scene.file.filename().string() : scene.title,
      .heading = plan.design.heading,
      .provenance = solved.solution.provenance,
      .metres_per_unit = scene.metres_per_unit,
      .unit_name = scene.unit_name,
      .maintenance_factor = maintenance_factor(plan.request.maintenance_factor, plan.design),
      .rays = plan.request.rays,
      .error_estimate = solved.solution.error_estimate};
  if (scene.sky) {
    made.sky = scene.sky->name.empty() ? "sky" : scene.sky->name;
    made.north = scene.sky->north;
  }
  return made;
}

// The year's energy of luminaires whose power is known; empty otherwise, and without [energy].
std::optional<LightingEnergy> energy_of(const LightingDesign& design, const LightingReport& report,
                                        const LuxGrid& floor) {
  if (!design.use || report.luminaires.empty()) return {};
  const LightingUse& use = *design.use;
  double watts = 0.0;
  for (const LuminaireRow& row : report.luminaires) {
    if (!(row.watts > 0.0)) return {};
    watts += row.watts;
  }
  return LightingEnergy{
      .surface = floor.name,
      .area = floor.area,
      .indicator = energy_indicator(
          {.watts = watts,
           .area = floor.area,
           .daylight_hours = use.daylight_hours,
           .night_hours = use.night_hours,
           .daylight = use.daylight,
           .occupancy = use.occupancy,
           .constant_illuminance = use.is_constant_illuminance
                                       ? constant_illuminance_factor(report.maintenance_factor)
                                       : 1.0,
           .standby_watts = use.standby_watts,
           .charging_watts = use.charging_watts,
           .charging_hours = use.charging_hours})};
}

}  // namespace

ReportPlan plan_report(const Scene& scene, ReportRequest request) {
  if (scene.relative_units) {
    throw InputError(
        fmt::format("{}: the scene names no unit of light, so no illuminance can be reported",
                    scene.file.string()));
  }
  ReportPlan plan{.design = request.design ? *request.design : read_lighting_design(scene)};
  if (!request.areas.empty()) read_design_tables(request.areas, scene, plan.design);
  plan.tables = std::make_shared<const LimitTables>(LimitTables{
      request.activities.empty() ? usual_activities() : read_activities(request.activities),
      request.sports.empty() ? usual_sports() : read_sports(request.sports)});
  if (!request.colours.empty()) {
    plan.colours = read_colour_samples(request.colours);
    if (scene.bands.wavelengths_nm.empty()) {
      throw InputError(fmt::format(
          "{}: R_f and R_g need a scene of wavelengths; give it '[bands]' of kind \"spectral\"",
          scene.file.string()));
    }
  }
  if (!request.activity.empty()) {
    find_activity(plan.tables->activities, request.activity, "--activity");
  }
  for (const DesignArea& area : plan.design.areas) {
    for (const std::string& name : area.observers) {
      const bool is_known = std::ranges::find(request.observers, name) != request.observers.end();
      if (!is_known) request.observers.push_back(name);
    }
  }
  for (const std::string& name : request.observers) plan.eyes.push_back(choose_camera(scene, name));
  if (!request.camera.empty()) choose_camera(scene, request.camera);
  plan.request = std::move(request);
  return plan;
}

LightingReport make_report(const ReportPlan& plan, const ReportedScene& of, SolvedScene& solved,
                           const Progress& progress) {
  const auto& [scene, names] = of;
  LightingReport made = report_of(plan, scene, solved);
  const ElementCaster caster(solved.mesh);
  const DirectLight lights(scene, caster);
  made.luminaires = luminaires(scene, solved.mesh, lights, plan.design);
  set_watts(made.luminaires, plan.request.watts, scene);
  Measurements what;
  what.eyes = plan.eyes;
  what.maintenance_factor = made.maintenance_factor;
  what.gathering.rays = plan.request.rays;
  what.luminous_heights = plan.design.luminous_height;
  what.between = [&] { report(progress, "measure", 0.0); };
  what.gathering.run.progress = progress;
  // Requests name surfaces of the file, which merge_planar_regions() may have joined with others:
  // names->apart() separates them again.
  const Scene apart = names ? names->apart(scene) : scene;
  const Eigen::Vector3d up = guess_up_axis(scene.cameras, mesh_bounds(solved.mesh));
  std::vector<LuxGrid> grids =
      requested_grids(plan.request.grids, plan.design.grids, apart, caster, up);
  const std::vector<DesignArea> areas = areas_of(plan, grids);
  require_lamps_alone(areas, light_content(scene, solved, lights));
  std::optional<LuxGrid> floor;
  if (plan.design.use) floor = lux_grid(apart, plan.design.use->surface, up);
  const std::vector<AreaGrids> of_areas =
      add_area_grids(areas, *plan.tables, apart, caster, up, grids);
  if (!plan.colours.empty()) what.colours = &plan.colours;
  what.has_glare_rating =
      std::ranges::any_of(areas, [](const DesignArea& area) { return area.sport.has_value(); });
  for (LuxGrid& grid : grids) {
    what.grids.push_back(without_buried_points(caster, std::move(grid)));
  }
  measure(scene, solved, lights, what, made);
  if (floor) made.energy = energy_of(plan.design, made, *floor);
  made.requirements = judge_areas(areas, *plan.tables, of_areas, up, made);
  made.picture = picture_of(plan.request, scene, solved, progress);
  return made;
}

std::string report_json(const LightingReport& report) {
  return json_text(figures_json(report));
}

void require_report_file(const std::filesystem::path& path) {
  const std::string kind = lower_extension(path);
  if (kind == ".pdf") return require_pdf();
  if (kind == ".html" || kind == ".csv" || kind == ".json") return;
  throw InputError(fmt::format("'{}' must end in .html, .pdf, .json or .csv", path.string()));
}

void write_report(const std::filesystem::path& path, const LightingReport& report,
                  const std::optional<LuxRange>& range, Language language) {
  require_report_file(path);
  const std::string kind = lower_extension(path);
  if (kind == ".html") {
    write_whole(path, {html_document(lighting_document(report, range, language))});
  } else if (kind == ".pdf") {
    write_whole(path, {pdf_document(lighting_document(report, range, language))});
  } else if (kind == ".csv") {
    write_whole(path, {points_csv(report)});
  } else {
    write_whole(path, {report_json(report)});
  }
}

}  // namespace lightwell
