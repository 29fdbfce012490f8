#pragma once

#include "tests/raytrace/lit_scene.h"

namespace lightwell::test {

/// A closed room of one reflectance with a lamp of 4 pi W in its middle.
struct Integrator {
  static constexpr float rho = 0.7f;
  TracedScene lit{[] {
    Scene scene = SceneBuilder()
                      .box({.reflectance = rho, .one_sided = true}, {0, 0, 0}, {2, 1, 1.5}, true)
                      .build();
    scene.lamps.push_back({.name = "lamp",
                           .position = {1, 0.5, 0.7},
                           .intensity = constant_spectrum(scene.bands, 1.0f)});
    return scene;
  }()};
};

}  // namespace lightwell::test
