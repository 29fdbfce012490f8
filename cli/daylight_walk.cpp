#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/daylight_year.h"
#include "cli/interrupt.h"
#include "viewer/export/baked_year.h"
#include "viewer/export/export.h"

namespace lightwell {
namespace {

// Eyes of people over a floor, m, and lower ones in lower rooms.
constexpr double eye_height = 1.6;

// A view over the room from its dimmest sensor to its brightest one.
Camera view_of_room(const DaylightInputs& inputs, const WalkedYear& year) {
  Eigen::Index dim = 0, bright = 0;
  year.daylight_factor.minCoeff(&dim);
  year.daylight_factor.maxCoeff(&bright);
  // Sensors may lie on the floor itself.
  constexpr double off_the_floor = 1e-3;  // m
  const Eigen::Vector3d from =
      year.sensors[static_cast<std::size_t>(dim)].position + off_the_floor * inputs.up;
  const Eigen::Vector3d& to = year.sensors[static_cast<std::size_t>(bright)].position;
  const ElementCaster& caster = year.model.caster();
  const auto free_way = [&](const Eigen::Vector3d& direction) {
    const Ray ray{.origin = from, .direction = direction};
    ElementHit hit;
    caster.closest_elements({&ray, 1}, {&hit, 1});
    return hit.facet < 0 ? eye_height : double{hit.t};
  };
  const double above_floor = free_way(-inputs.up), below_ceiling = free_way(inputs.up);
  constexpr double most_of_room = 0.6;  // of the height that is left below a low ceiling
  const double rise = std::clamp(eye_height - above_floor, 0.0, most_of_room * below_ceiling);
  Camera camera;
  camera.name = "room";
  camera.position = from + rise * inputs.up;
  Eigen::Vector3d level = to - from;
  level -= level.dot(inputs.up) * inputs.up;
  if (!(level.norm() > 1e-6)) level = -inputs.north;
  camera.direction = level.normalized();
  camera.up = inputs.up;
  camera.fov_degrees = 70.0;
  camera.width = 1024;
  camera.height = 768;
  return camera;
}

}  // namespace

void write_walk(const DaylightArguments& arguments, const DaylightInputs& inputs,
                const WalkedYear& year, Console& console, Report& report) {
  if (!inputs.windows.groups.empty()) {
    console.say("note: '" + arguments.walk + "' shows all windows in their first states");
  }
  const YearBasis basis = find_year_basis(year.model, year.hours, arguments.ground);
  console.finish_phase();
  stop_if_interrupted();
  Scene scene = inputs.scene;
  if (scene.cameras.empty() && !year.sensors.empty()) {
    scene.cameras.push_back(view_of_room(inputs, year));
  }
  const Provenance provenance{.version = LIGHTWELL_VERSION,
                              .scene_file = inputs.scene.file.filename().string()};
  const BakedModel page = bake_year({.model = year.model,
                                     .basis = basis,
                                     .hours = year.hours,
                                     .weather = inputs.weather,
                                     .ground_reflectance = arguments.ground},
                                    scene, provenance, inputs.clean_up.names.get());
  write_walkthrough(arguments.walk, page);
  report.add_file(arguments.walk);
  report.add("walk", {{"vertices", page.vertex_count()},
                      {"terms", basis.term_count()},
                      {"relative_error", basis.error},
                      {"bytes", std::filesystem::file_size(arguments.walk)}});
}

}  // namespace lightwell
