#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// Per element, the RMS error that the rays of a gather at vertices leave in interpolated
/// irradiance, relative to error_references() of `irradiance` (vertices x bands, W/m^2); see
/// RadiositySolution::gather_noise. `ray_variance` is the estimated variance of a single ray at
/// each vertex, (W/m^2)^2. One vertex's value is little more than a guess, so the mean over each
/// patch is used. `rays` is the number of rays of each vertex.
Eigen::ArrayXf gather_noise(const PatchMesh& mesh, const BandArray& irradiance,
                            const Eigen::ArrayXf& ray_variance, const Eigen::ArrayXf& rays,
                            const SceneParts& parts = {});

/// The RMS over the judged_patches() of each part of the noise of gather_noise().
std::vector<double> rms_noises(const PatchMesh& mesh, const Eigen::ArrayXf& noise,
                               const SceneParts& parts);
/// The RMS over the judged_patches() of the scene.
double rms_noise(const PatchMesh& mesh, const Eigen::ArrayXf& noise);

}  // namespace lightwell
