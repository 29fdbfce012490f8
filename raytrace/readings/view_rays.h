#pragma once

#include <span>
#include <vector>

#include "raytrace/readings/probe.h"
#include "scene/camera.h"
#include "scene/rays/ray_caster.h"

// Rays of SolveOptions::view_rays, for those who look at a scene.
namespace lightwell {

/// Appends rays through all of a camera's picture.
void add_view_rays(const Camera& camera, std::vector<Ray>& rays);

/// Appends rays over the hemisphere of each place, as a gather there casts them, and one to the
/// surface that the place may lie on. `diagonal` is the scene's, m.
void add_view_rays(std::span<const Probe> places, double diagonal, std::vector<Ray>& rays);

}  // namespace lightwell
