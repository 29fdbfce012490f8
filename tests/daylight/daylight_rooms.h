#pragma once

#include <vector>

#include "radiosity/gather/final_gather.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

/// A room of 4 m x 3 m x 2.5 m with a window of 2 m x 1 m in its south wall (y = 0), z up, all of
/// one material. The walls are sheets that reflect on both sides.
inline Scene room_with_window(const Material& material) {
  Scene scene;
  Material sheet = material;
  sheet.one_sided = false;
  const int rho = add_material(scene, sheet);
  add_box(scene, {0.0, 0.0, 0.0}, {4.0, 3.0, 2.5}, {rho, rho, rho, rho, rho, rho}, true);
  // The south wall, y0, in four pieces about the window.
  std::erase_if(scene.surfaces, [](const Surface& surface) { return surface.name == "y0"; });
  const auto wall = [&](double x0, double x1, double z0, double z1) {
    add_polygon(scene, "south", rho, {{x0, 0.0, z0}, {x0, 0.0, z1}, {x1, 0.0, z1}, {x1, 0.0, z0}});
  };
  wall(0.0, 1.0, 0.0, 2.5);
  wall(3.0, 4.0, 0.0, 2.5);
  wall(1.0, 3.0, 0.0, 1.0);
  wall(1.0, 3.0, 2.0, 2.5);
  return scene;
}

/// Sensors that face up, 0.8 m above the floor: by the window, in the middle, at the back.
inline std::vector<GatherPoint> desks() {
  std::vector<GatherPoint> points;
  for (const double y : {0.5, 1.5, 2.5}) points.push_back({.position = {1.7, y, 0.8}});
  return points;
}

}  // namespace lightwell::test
