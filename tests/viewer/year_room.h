#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "radiosity/solution/solution.h"
#include "tests/daylight/daylight_rooms.h"
#include "tests/daylight/three_days.h"
#include "viewer/export/baked_year.h"

namespace lightwell::test {

/// room_with_window() with a pane of clear glass in its window and red walls, seen by a camera at
/// its back, in whose middle the sun of the March noon of three_days() falls on the floor.
inline Scene glazed_room() {
  Material red = diffuse(Bands(rgb_bands()), 0.5f);
  red.reflectance[1] = 0.3f;
  Scene scene = room_with_window(red);
  Material glass = veil(scene.bands, 1.0f);
  glass.dielectric->index_of_refraction = 1.5f;
  add_polygon(scene, "pane", add_material(scene, glass),
              {{1.0, 0.0, 1.0}, {1.0, 0.0, 2.0}, {3.0, 0.0, 2.0}, {3.0, 0.0, 1.0}});
  Camera camera;
  camera.name = "back";
  camera.position = {2.0, 2.8, 1.6};
  camera.direction = (Eigen::Vector3d(2.0, 1.15, 0.0) - camera.position).normalized();
  camera.up = camera.direction.cross(Eigen::Vector3d::UnitX());
  camera.fov_degrees = 80.0;
  camera.width = 800;
  camera.height = 700;
  scene.cameras = {camera};
  return scene;
}

/// A computed year of glazed_room() in the weather of three_days().
class ComputedRoom {
 public:
  explicit ComputedRoom(const Scene& read)
      : scene(read),
        model(scene, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), options()),
        basis(find_year_basis(model, hours, ground, {.error = 0.02, .rays = 1024})) {}

  static DaylightOptions options() {
    DaylightOptions coarse;
    coarse.sky_subdivision = 1;
    coarse.mesh.auto_patch_count = 120;
    coarse.gather_rays = 256;
    return coarse;
  }
  BakedModel page() const {
    return bake_year({.model = model,
                      .basis = basis,
                      .hours = hours,
                      .weather = weather,
                      .ground_reflectance = ground},
                     scene, {.version = "test", .scene_file = "room"});
  }
  /// The light of an hour by the basis, without the sun's own.
  RadiositySolution solution(int hour) const {
    RadiositySolution solution;
    solution.bands = scene.bands;
    const double lux_of_watt = luminous(scene.bands, constant_spectrum(scene.bands, 1.0f));
    solution.indirect_irradiance =
        light_of_hour(basis, hour, model.scene().bands.count()).max(0.0f) /
        static_cast<float>(lux_of_watt);
    solution.direct_irradiance = BandArray::Zero(solution.indirect_irradiance.rows(), 3);
    return solution;
  }
  /// Number of an hour among those with light; hour 12 lasts from 12 to 13 h.
  int hour_of(int month, int day, int hour) const {
    const int number = number_of({.month = month, .day = day, .hour = hour}, false);
    for (std::size_t h = 0; h < hours.size(); ++h) {
      if (hours[h].number == number) return static_cast<int>(h);
    }
    return -1;
  }

  static constexpr double ground = 0.2;
  Scene scene;
  Weather weather = three_days();
  std::vector<SkyHour> hours =
      sky_hours(weather, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  DaylightModel model;
  YearBasis basis;
};

/// The year of glazed_room(), computed once for all tests; which sensors its model has is open.
inline ComputedRoom& glazed_year() {
  static ComputedRoom room(glazed_room());
  return room;
}

}  // namespace lightwell::test
