#pragma once

#include <initializer_list>
#include <vector>

#include "radiosity/solution/relight.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell {

/// A room with the lamps "desk" and "panel" and a mirror wall. The camera is near the floor, with
/// the desk lamp, which shines downwards, in the middle of the picture.
inline Scene channel_room() {
  Scene scene = test::two_lamps({.with_mirror = true});
  Camera camera;
  camera.name = "door";
  camera.position = {1.5, 2.8, 0.9};
  camera.direction = (Eigen::Vector3d(0.5, 0.6, 1.2) - camera.position).normalized();
  camera.up = Eigen::Vector3d::UnitZ();
  camera.up = (camera.up - camera.up.dot(camera.direction) * camera.direction).normalized();
  camera.fov_degrees = 70.0;
  camera.width = camera.height = 200;
  scene.cameras = {camera};
  return scene;
}

inline SolvedScene solve_by_channel(const Scene& scene) {
  SolveOptions options = test::exact_and_even();
  options.channels = channels_per_luminaire(scene);
  return solve_scene(scene, options);
}

/// `solved` relit by settings in the form of `lightwell relight`, one per channel.
inline SolvedScene relit(SolvedScene solved, std::initializer_list<const char*> settings) {
  std::vector<Spectrum> scales;
  for (const char* const setting : settings) {
    scales.push_back(channel_scale(solved.solution.channels[scales.size()], solved.solution.bands,
                                   channel_setting(setting)));
  }
  relight(solved, scales);
  return solved;
}

}  // namespace lightwell
