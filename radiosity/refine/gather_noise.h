#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Per element, the standard error that the rays of a gather to vertices leave in interpolated
/// irradiance, see RadiositySolution::gather_noise. `irradiance` at vertices is what it is relative
/// to; `ray_variance` is that of a single ray there, (W/m^2)^2: what one vertex says of it is
/// little more than a guess, so that a patch's vertices say it together; `rays` how many each cast.
Eigen::ArrayXf gather_noise(const PatchMesh& mesh, const BandArray& irradiance,
                            const Eigen::ArrayXf& ray_variance, const Eigen::ArrayXf& rays);

/// The RMS of such noise over all area that reflects.
double rms_noise(const PatchMesh& mesh, const Eigen::ArrayXf& noise);

}  // namespace lightwell
