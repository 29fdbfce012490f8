#include "cli/daylight_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/compass.h"
#include "cli/outputs.h"
#include "cli/steps.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "raytrace/cameras/choose_camera.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Sets zenith and north of the scene: those of its sky, or those that its axes suggest.
void set_compass(double north_degrees, DaylightInputs& inputs) {
  const Sky compass = compass_of(inputs.scene, north_degrees);
  inputs.has_north = inputs.scene.sky.has_value();
  inputs.up = compass.up;
  inputs.north = compass.north;
}

void add_room(YearRoom room, const std::vector<Probe>& points, DaylightSensors& sensors) {
  if (points.empty()) return;
  room.first = static_cast<Eigen::Index>(sensors.probes.size());
  room.count = static_cast<Eigen::Index>(points.size());
  sensors.probes.insert(sensors.probes.end(), points.begin(), points.end());
  sensors.rooms.push_back(std::move(room));
}

// Refuses operated surfaces that the clean-up made a part of another, or the other way round.
void refuse_joined_windows(const DaylightInputs& inputs) {
  if (!inputs.clean_up.names) return;
  const Scene apart = inputs.clean_up.names->apart(inputs.scene);
  for (const WindowGroup& group : inputs.windows.groups) {
    for (const int number : group.surfaces) {
      const auto s = static_cast<std::size_t>(number);
      const double area = surface_area(apart.surfaces[s]);
      constexpr double rounding = 1e-6;
      if (std::abs(surface_area(inputs.scene.surfaces[s]) - area) <= rounding * area) continue;
      throw InputError(fmt::format(
          "windows '{}': the surface '{}' lies in the plane of a neighbour of the same material "
          "and was joined with that; give it a material that differs, if only by a thousandth",
          group.name, inputs.scene.surfaces[s].name));
    }
  }
}

// Reads the states of windows, of `--windows` or of the scene file, with the files that they name.
OperatedWindows read_operated_windows(const DaylightArguments& arguments, const Scene& scene,
                                      const Console& console) {
  const bool has_file = !arguments.windows.empty();
  const FilesRead read =
      console.options().inside_folder
          ? FilesRead::inside_folder_of(has_file ? arguments.windows : scene.file.string())
          : FilesRead();
  OperatedWindows windows = has_file ? read_windows(arguments.windows, scene) : read_windows(scene);
  for (const std::filesystem::path& file : read.files()) note_input(file);
  return windows;
}

// The ratings of --rating, of the program's table or of --ratings.
std::vector<DaylightRating> asked_ratings(const DaylightArguments& arguments) {
  std::vector<DaylightRating> asked;
  if (arguments.ratings.empty()) return asked;
  const std::vector<DaylightRating> known = arguments.rating_table.empty()
                                                ? usual_daylight_ratings()
                                                : read_daylight_ratings(arguments.rating_table);
  for (const std::string& key : arguments.ratings) {
    asked.push_back(find_daylight_rating(known, key, "--rating"));
  }
  return asked;
}

}  // namespace

DaylightInputs read_daylight_inputs(const DaylightArguments& arguments, Console& console,
                                    Report& report) {
  for (const std::string* file :
       {&arguments.weather, &arguments.points, &arguments.windows, &arguments.sun_points,
        &arguments.rooms, &arguments.rating_table}) {
    if (!file->empty()) note_input(*file);
  }
  DaylightInputs inputs{.weather = read_weather(arguments.weather)};
  if (!arguments.rooms.empty()) inputs.rooms = read_room_uses(arguments.rooms);
  inputs.ratings = asked_ratings(arguments);
  inputs.scene = read_scene_step(arguments.scene, console, report, &inputs.clean_up);
  inputs.windows = read_operated_windows(arguments, inputs.scene, console);
  refuse_joined_windows(inputs);
  inputs.grids = read_sensor_grids(inputs.scene);
  for (const std::string& name : arguments.observers) {
    inputs.eyes.push_back(choose_camera(inputs.scene, name));
  }
  // Points are read before the light, which takes long.
  if (!arguments.points.empty()) {
    inputs.points = read_probes(arguments.points, inputs.scene.metres_per_unit);
  }
  if (!arguments.sun_points.empty()) {
    for (const Probe& probe : read_probes(arguments.sun_points, inputs.scene.metres_per_unit)) {
      inputs.sun_points.push_back(probe.position);
    }
  }
  set_compass(arguments.north_degrees, inputs);
  require_surfaces(arguments.grids.in_metres(inputs.scene), inputs.scene_apart());
  return inputs;
}

Scene DaylightInputs::scene_apart() const {
  return clean_up.names ? clean_up.names->apart(scene) : scene;
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

DaylightSensors daylight_sensors(const DaylightArguments& arguments, const DaylightInputs& inputs,
                                 const ElementCaster& caster) {
  const Scene& scene = inputs.scene;
  DaylightSensors sensors;
  for (LuxGrid& planned :
       requested_grids(arguments.grids.in_metres(scene), read_lighting_design(scene).grids,
                       inputs.scene_apart(), caster, inputs.up)) {
    const LuxGrid grid = without_buried_points(caster, std::move(planned));
    add_room({.name = grid.name, .grid = grid, .lines = plan_lines(scene, caster, grid, {})},
             grid.points, sensors);
  }
  for (const SensorGrid& grid : inputs.grids) {
    std::vector<Probe> points;
    for (std::size_t i = 0; i < grid.positions.size(); ++i) {
      points.push_back({.position = grid.positions[i], .normal = grid.directions[i]});
    }
    add_room({.name = grid.name}, points, sensors);
  }
  if (!inputs.points.empty()) {
    add_room({.name = std::filesystem::path(arguments.points).filename().string()}, inputs.points,
             sensors);
  }
  if (sensors.probes.empty()) {
    throw InputError(
        "there are no sensors; name planes with '--plane floor@0.8' or as [[grids]] in the scene "
        "file, sensor grids in a Honeybee model, or a file of points with '--points'");
  }
  for (const Camera& eye : inputs.eyes) {
    sensors.eyes.push_back({.position = eye.position, .normal = eye.direction});
  }
  return sensors;
}

DaylightOptions daylight_options(const DaylightArguments& arguments, const Scene& scene,
                                 Console& console) {
  DaylightOptions options{.sky_subdivision = arguments.sky, .gather_rays = arguments.rays};
  const MeshOptions mesh = arguments.mesh.options(scene);
  options.mesh.max_patch_size = mesh.max_patch_size;
  options.progress = console.progress();
  return options;
}

std::vector<std::string> daylight_conventions(const DaylightArguments& arguments,
                                              const DaylightInputs& inputs, const SkyPatches& sky) {
  const Eigen::Vector3d& north = sky.north();
  std::vector<std::string> sentences = {
      fmt::format("The dome is Perez' all-weather sky (1993) in {} patches of even luminance "
                  "(Tregenza, Reinhart). The sun is a disc of 0.533 degrees in its own place.",
                  sky.dome_count()),
      inputs.weather.format.ends_with("(WEA)")
          ? "Lux follow from watts by Perez' efficacies (1990) for a dew point of 11 degrees."
          : "Lux follow from watts by Perez' efficacies (1990) for the dew point of each hour.",
      fmt::format("The ground reflects {:g} of the light of sun and dome, evenly.",
                  arguments.ground),
      "Panes pass light by its angle, with all reflections inside. The sun in mirrors, and through "
      "glass that bends or scatters its light, is left out.",
      fmt::format("North is ({:.4g}, {:.4g}, {:.4g}) in the scene's axes, {}.", north.x(),
                  north.y(), north.z(), inputs.has_north ? "by its sky" : "assumed"),
      "Lamps and emitting surfaces of the scene are off."};
  if (inputs.windows.groups.empty()) sentences.emplace_back("There are no blinds.");
  for (const WindowGroup& group : inputs.windows.groups) {
    sentences.push_back(fmt::format("Windows '{}': {}.", group.name, operation_text(group)));
  }
  if (!inputs.eyes.empty()) {
    sentences.push_back(fmt::format(
        "Glare is the DGP of Wienold & Christoffersen (2006) with Guth's position index. Sources "
        "are the sun, and sky and ground above {:g} cd/m^2 through clear panes; surfaces of the "
        "room, such as lit blinds, count by their illuminance of the eye alone.",
        glare_luminance));
  }
  return sentences;
}

YearReport daylight_report(const DaylightArguments& arguments, const DaylightInputs& inputs,
                           const std::vector<std::string>& notes) {
  const Scene& scene = inputs.scene;
  YearReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                  .version = LIGHTWELL_VERSION,
                  .weather = inputs.weather,
                  .notes = notes,
                  .occupancy = arguments.occupancy,
                  .north = inputs.north,
                  .metres_per_unit = scene.metres_per_unit,
                  .unit_name = scene.unit_name,
                  .ratings = inputs.ratings};
  made.notes.insert(made.notes.end(), scene.notes.begin(), scene.notes.end());
  return made;
}

}  // namespace lightwell
