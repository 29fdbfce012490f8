#pragma once

#include <string>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "scene/io/window_states.h"
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

/// A thin pane of index 1, which passes `transmittance` at all angles and reflects nothing.
inline Material veil(const Bands& bands, float transmittance) {
  Material pane = diffuse(bands, 0.0f);
  pane.name = "veil" + std::to_string(transmittance);
  pane.one_sided = false;
  pane.dielectric = Dielectric{
      .index_of_refraction = 1.0f, .tint = constant_spectrum(bands, transmittance), .thin = true};
  return pane;
}

/// room_with_window() with `count` panes side by side in its window, "pane 0" in the west, of a
/// veil that passes all light.
inline Scene room_with_panes(int count) {
  Scene scene = room_with_window(diffuse(Bands(rgb_bands()), 0.5f));
  const int pane = add_material(scene, veil(scene.bands, 1.0f));
  for (int i = 0; i < count; ++i) {
    const double x0 = 1.0 + 2.0 * i / count, x1 = 1.0 + 2.0 * (i + 1) / count;
    add_polygon(scene, "pane " + std::to_string(i), pane,
                {{x0, 0.0, 1.0}, {x0, 0.0, 2.0}, {x1, 0.0, 2.0}, {x1, 0.0, 1.0}});
  }
  return scene;
}

/// A group of each pane of room_with_panes(), with the states "open" and "closed" of `closed`.
inline OperatedWindows windows_of_panes(const Scene& scene, const Material& closed) {
  OperatedWindows windows{.materials = {closed}};
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (!scene.surfaces[s].name.starts_with("pane")) continue;
    windows.groups.push_back({.name = scene.surfaces[s].name,
                              .surfaces = {static_cast<int>(s)},
                              .states = {{.name = "open"}, {.name = "closed", .material = 0}}});
  }
  return windows;
}

/// Sensors that face up, 0.8 m above the floor: by the window, in the middle, at the back.
inline std::vector<GatherPoint> desks() {
  std::vector<GatherPoint> points;
  for (const double y : {0.5, 1.5, 2.5}) points.push_back({.position = {1.7, y, 0.8}});
  return points;
}

}  // namespace lightwell::test
