#pragma once

#include "design/luminaires.h"
#include "radiosity/solve.h"

namespace lightwell::test {

/// A coarse solve with a channel for each luminaire, on patches of at most `max_patch_size`,
/// metres, whose elements are not refined.
inline SolvedScene coarse_solve(const Scene& scene, double max_patch_size) {
  SolveOptions options;
  options.mesh.max_patch_size = max_patch_size;
  options.form_factors.rays_per_patch = 128;
  options.gather.rays = 64;
  options.refine.tolerance = 0.0;
  options.error_points = 64;
  options.channels = dimming_channels(scene, {});
  return solve_scene(scene, options);
}

}  // namespace lightwell::test
