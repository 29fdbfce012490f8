#include "viewer/report/daylight_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/cleaning/joined_surfaces.h"
#include "raytrace/readings/probe_surface.h"
#include "scene/errors.h"
#include "viewer/export/compass.h"
#include "viewer/report/year_rooms.h"

namespace lightwell {
namespace {

void add_room(YearRoom room, const std::vector<Probe>& points, DaylightSensors& sensors) {
  if (points.empty()) return;
  room.first = static_cast<Eigen::Index>(sensors.probes.size());
  room.count = static_cast<Eigen::Index>(points.size());
  sensors.probes.insert(sensors.probes.end(), points.begin(), points.end());
  sensors.rooms.push_back(std::move(room));
}

// Refuses operated surfaces that the clean-up made a part of another, or the other way round.
void refuse_joined_windows(const DaylightStudy& study) {
  if (!study.clean_up.names) return;
  const Scene apart = study.clean_up.names->apart(study.scene);
  for (const WindowGroup& group : study.windows.groups) {
    for (const int number : group.surfaces) {
      const auto s = static_cast<std::size_t>(number);
      const double area = surface_area(apart.surfaces[s]);
      constexpr double rounding = 1e-6;
      if (std::abs(surface_area(study.scene.surfaces[s]) - area) <= rounding * area) continue;
      throw InputError(fmt::format(
          "windows '{}': the surface '{}' lies in the plane of a neighbour of the same material "
          "and was joined with that; give it a material that differs, if only by a thousandth",
          group.name, study.scene.surfaces[s].name));
    }
  }
}

// Refuses tables of rooms that do not fit the sensors.
void check_rooms(const DaylightStudy& study) {
  if (study.rooms.empty()) return;
  const PatchMesh mesh = build_patches(study.scene, study.options.mesh);
  std::vector<YearRoom> rooms = daylight_sensors(study, ElementCaster(mesh)).rooms;
  use_rooms(study.rooms, rooms);
  if (!study.ratings.empty()) require_occupied_rooms(rooms);
}

StudiedModel model_without_sensors(const DaylightStudy& study, const Progress& progress) {
  DaylightOptions options = study.options;
  options.progress = progress;
  StudiedModel made{
      .model = std::make_unique<DaylightModel>(study.scene, study.up, study.north, options)};
  made.sensors = daylight_sensors(study, made.model->caster());
  return made;
}

}  // namespace

Scene DaylightStudy::scene_apart() const {
  return clean_up.names ? clean_up.names->apart(scene) : scene;
}

void set_compass(double north_degrees, DaylightStudy& study) {
  const Sky compass = compass_of(study.scene, north_degrees);
  study.has_north = study.scene.sky.has_value();
  study.up = compass.up;
  study.north = compass.north;
}

void check_study(const DaylightStudy& study) {
  const auto is_empty = [](const SensorGrid& grid) { return grid.positions.empty(); };
  if (study.request.is_empty() && study.grids.empty() && study.points.empty() &&
      std::ranges::all_of(study.sensor_grids, is_empty)) {
    throw InputError(
        "there are no sensors; name planes ('--plane floor@0.8', in Python planes={'floor': 0.8}), "
        "put [[grids]] into the scene file, sensor grids into a Honeybee model, or give points");
  }
  refuse_joined_windows(study);
  require_surfaces(study.request, study.scene_apart());
}

std::vector<Probe> DaylightSensors::all() const {
  std::vector<Probe> both = probes;
  both.insert(both.end(), eyes.begin(), eyes.end());
  return both;
}

std::vector<SensorRange> DaylightSensors::ranges() const {
  std::vector<SensorRange> ranges;
  for (const YearRoom& room : rooms) ranges.push_back({.first = room.first, .count = room.count});
  return ranges;
}

DaylightSensors daylight_sensors(const DaylightStudy& study, const ElementCaster& caster) {
  const Scene& scene = study.scene;
  DaylightSensors sensors;
  for (LuxGrid& planned :
       requested_grids(study.request, study.grids, study.scene_apart(), caster, study.up)) {
    const LuxGrid grid = without_buried_points(caster, std::move(planned));
    add_room({.name = grid.name, .grid = grid, .lines = plan_lines(scene, caster, grid, {})},
             grid.points, sensors);
  }
  for (const SensorGrid& grid : study.sensor_grids) {
    std::vector<Probe> points;
    for (std::size_t i = 0; i < grid.positions.size(); ++i) {
      points.push_back({.position = grid.positions[i], .normal = grid.directions[i]});
    }
    add_room({.name = grid.name}, points, sensors);
  }
  add_room({.name = study.points_name}, study.points, sensors);
  for (const Camera& eye : study.eyes) {
    sensors.eyes.push_back({.position = eye.position, .normal = eye.direction});
  }
  return sensors;
}

StudiedModel model_of_year(const DaylightStudy& study, const Progress& progress) {
  check_rooms(study);
  StudiedModel made = model_without_sensors(study, progress);
  made.model->set_sensors(probe_points(made.model->caster(), made.sensors.all()));
  use_rooms(study.rooms, made.sensors.rooms);
  return made;
}

StudiedModel model_of_instants(const DaylightStudy& study, const Progress& progress) {
  StudiedModel made = model_without_sensors(study, progress);
  made.model->set_sensors(probe_points(made.model->caster(), made.sensors.probes));
  return made;
}

std::vector<std::string> daylight_conventions(const DaylightStudy& study, const SkyPatches& sky) {
  const Eigen::Vector3d& north = sky.north();
  std::vector<std::string> sentences = {
      fmt::format("The dome is Perez' all-weather sky (1993) in {} patches of even luminance "
                  "(Tregenza, Reinhart). The sun is a disc of 0.533 degrees in its own place.",
                  sky.dome_count()),
      study.weather.format.ends_with("(WEA)")
          ? "Lux follow from watts by Perez' efficacies (1990) for a dew point of 11 degrees."
          : "Lux follow from watts by Perez' efficacies (1990) for the dew point of each hour.",
      fmt::format("The ground reflects {:g} of the light of sun and dome, evenly.",
                  study.ground_reflectance),
      "Panes pass light by its angle, with all reflections inside. The sun in mirrors, and through "
      "glass that bends or scatters its light, is left out.",
      fmt::format("North is ({:.4g}, {:.4g}, {:.4g}) in the scene's axes, {}.", north.x(),
                  north.y(), north.z(), study.has_north ? "by its sky" : "assumed"),
      "Lamps and emitting surfaces of the scene are off."};
  if (study.windows.groups.empty()) sentences.emplace_back("There are no blinds.");
  for (const WindowGroup& group : study.windows.groups) {
    sentences.push_back(fmt::format("Windows '{}': {}.", group.name, operation_text(group)));
  }
  if (!study.eyes.empty()) {
    sentences.push_back(fmt::format(
        "Glare is the DGP of Wienold & Christoffersen (2006) with Guth's position index. Sources "
        "are the sun, and sky and ground above {:g} cd/m^2 through clear panes; surfaces of the "
        "room, such as lit blinds, count by their illuminance of the eye alone.",
        glare_luminance));
  }
  return sentences;
}

YearReport daylight_report(const DaylightStudy& study, const std::vector<std::string>& notes) {
  const Scene& scene = study.scene;
  YearReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                  .version = study.version,
                  .weather = study.weather,
                  .notes = notes,
                  .occupancy = study.occupancy,
                  .north = study.north,
                  .metres_per_unit = scene.metres_per_unit,
                  .unit_name = scene.unit_name,
                  .ratings = study.ratings};
  made.notes.insert(made.notes.end(), scene.notes.begin(), scene.notes.end());
  return made;
}

}  // namespace lightwell
