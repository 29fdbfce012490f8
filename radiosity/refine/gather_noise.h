#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// Variance of a stratified set of rays over the square of half the difference between its two
/// halves, by which gathers estimate their variance. Each half fills the other's gaps, so the whole
/// is better than two independent halves: measured at one point of a room, the ratio is 0.31 to
/// 0.56 with 20 to 4096 rays.
inline constexpr double of_whole_set = 0.5;

/// Variance of the light gathered at each vertex, (W/m^2)^2: that of a single ray over the vertex's
/// `rays`, 1 or more. `ray_variance` is an estimate from one gather per vertex, (W/m^2)^2, which is
/// little more than a guess, so its mean over each patch is used. Both have a value per vertex.
Eigen::ArrayXf vertex_variance(const PatchMesh& mesh, const Eigen::ArrayXf& ray_variance,
                               const Eigen::ArrayXf& rays);

/// Per element, the RMS error that gathers at vertices leave in interpolated irradiance, relative
/// to error_references() of `irradiance` (vertices x bands, W/m^2); see
/// RadiositySolution::gather_noise. `variance` is that of each vertex's light as gathers
/// estimate it, (W/m^2)^2 (see of_whole_set).
Eigen::ArrayXf gather_noise(const PatchMesh& mesh, const BandArray& irradiance,
                            const Eigen::ArrayXf& variance, const SceneParts& parts = {});

/// The RMS over the judged_patches() of each part of the noise of gather_noise().
std::vector<double> rms_noises(const PatchMesh& mesh, const Eigen::ArrayXf& noise,
                               const SceneParts& parts);
/// The RMS over the judged_patches() of the scene.
double rms_noise(const PatchMesh& mesh, const Eigen::ArrayXf& noise);

}  // namespace lightwell
