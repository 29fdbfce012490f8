#include "cli/daylight_inputs.h"

#include <filesystem>

#include "cli/outputs.h"
#include "cli/steps.h"
#include "raytrace/cameras/choose_camera.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

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

}  // namespace

DaylightStudy read_daylight_study(const DaylightArguments& arguments, Console& console,
                                  Report& report) {
  for (const std::string* file :
       {&arguments.weather, &arguments.points, &arguments.windows, &arguments.sun_points,
        &arguments.rooms, &arguments.rating_table}) {
    if (!file->empty()) note_input(*file);
  }
  DaylightStudy study{.version = LIGHTWELL_VERSION, .weather = read_weather(arguments.weather)};
  if (!arguments.rooms.empty()) study.rooms = read_room_uses(arguments.rooms);
  study.ratings = find_daylight_ratings(arguments.ratings, arguments.rating_table, "--rating");
  study.scene = read_scene_step(arguments.scene, console, report, &study.clean_up);
  study.windows = read_operated_windows(arguments, study.scene, console);
  study.request = arguments.grids.in_metres(study.scene);
  study.grids = read_lighting_design(study.scene).grids;
  study.sensor_grids = read_sensor_grids(study.scene);
  for (const std::string& name : arguments.observers) {
    study.eyes.push_back(choose_camera(study.scene, name));
  }
  // Points are read before the light, which takes long.
  if (!arguments.points.empty()) {
    study.points = read_probes(arguments.points, study.scene.metres_per_unit);
    study.points_name = std::filesystem::path(arguments.points).filename().string();
  }
  if (!arguments.sun_points.empty()) {
    for (const Probe& probe : read_probes(arguments.sun_points, study.scene.metres_per_unit)) {
      study.sun_points.push_back(probe.position);
    }
  }
  study.sun_day = arguments.sun_day;
  study.ground_reflectance = arguments.ground;
  study.occupancy = arguments.occupancy;
  study.options = {.sky_subdivision = arguments.sky, .gather_rays = arguments.rays};
  study.options.mesh.max_patch_size = arguments.mesh.options(study.scene).max_patch_size;
  set_compass(arguments.north_degrees, study);
  check_study(study);
  return study;
}

}  // namespace lightwell
