#pragma once

#include <optional>

#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

struct TwoLamps {
  Spectrum desk = Spectrum::Constant(3, 40.0f),
           panel = (Spectrum(3) << 10.0f, 14.0f, 20.0f).finished();
  float wall = 0.0f;         ///< exitance of a whole wall: too large an emitter for DirectLight
  float reflectance = 0.7f;  ///< of the floor and the ceiling
  bool with_mirror = false, with_glass = false;
  /// A block, beside which openings lie. Rays are aimed at openings by the light on both sides, so
  /// that solves of other lamps find other noise.
  bool with_block = true;
};

/// A room with coloured walls and a block, a small lamp "desk" over it and a larger one "panel"
/// under the ceiling.
inline Scene two_lamps(const TwoLamps& is = {}) {
  Scene scene;
  const auto paint = [&](float r, float g, float b) {
    Material material = diffuse(scene.bands, 0.0f);
    material.reflectance << r, g, b;
    return add_material(scene, material);
  };
  const auto lamp = [&](const char* name, const Spectrum& exitance) {
    Material material = diffuse(scene.bands, 0.1f);
    material.name = name;
    material.emission = exitance;
    return add_material(scene, material);
  };
  const int white = paint(is.reflectance, is.reflectance, is.reflectance);
  const int red = paint(0.6f, 0.1f, 0.05f), green = paint(0.1f, 0.5f, 0.1f);
  const int grey = add_material(scene, diffuse(scene.bands, 0.4f, is.wall));
  const int desk = lamp("desk bulb", is.desk), panel = lamp("panel tubes", is.panel);
  const int mirror = add_material(scene, tinted_mirror(scene.bands));
  add_box(scene, {0, 0, 0}, {2, 3, 2.5},
          {red, green, grey, is.with_mirror ? mirror : grey, white, white}, true);
  add_polygon(scene, "desk", desk,
              {{0.4, 0.5, 1.2}, {0.4, 0.7, 1.2}, {0.6, 0.7, 1.2}, {0.6, 0.5, 1.2}});
  add_polygon(scene, "panel", panel,
              {{0.8, 1.2, 2.4}, {0.8, 2.2, 2.4}, {1.2, 2.2, 2.4}, {1.2, 1.2, 2.4}});
  if (is.with_block) {
    add_box(scene, {0.3, 0.4, 0.0}, {0.9, 1.1, 0.8}, {white, white, white, white, white, white},
            false);
  }
  if (is.with_glass) {
    scene.surfaces.push_back({.name = "ball",
                              .material = add_material(scene, clear_glass(scene.bands)),
                              .shape = Sphere{.center = {1.4, 1.6, 0.5}, .radius = 0.3}});
  }
  return scene;
}

/// Coarse and quick, but with a solver so exact that floats are what is left. Elements are even.
inline SolveOptions exact_and_even() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  options.form_factors.rays_per_patch = 64;
  options.solver.tolerance = 1e-8;
  options.gather.rays = 64;
  // Lamps share more rays by what they would give, so solves of other lamps would find other noise.
  options.gather.shadows = {.min_rays = 1, .max_rays = 1};
  options.refine.tolerance = 0.0;
  options.caustic_rays = 1 << 12;
  options.error_points = 64;
  return options;
}

}  // namespace lightwell::test
