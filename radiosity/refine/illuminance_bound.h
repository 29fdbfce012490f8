#pragma once

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Bound of the error of interpolated illuminance anywhere in each element, lx, with odds of about
/// 19 to 1: error_bound() times the element's error_references(), and twice the error of caustics,
/// whose squares add up. Caustics count as if the range of their light over the element's corners
/// came from one step. Empty unless the solution has an error estimate.
Eigen::ArrayXf illuminance_bounds(const PatchMesh& mesh, const RadiositySolution& solution);

/// Estimated RMS error of interpolated illuminance over each element, lx: half of
/// illuminance_bounds(). If the solution has no error estimate, its elements were not refined, and
/// half of the range of the other light stands for the error of interpolation. Empty if the
/// solution does not know the noise of its gather either.
Eigen::ArrayXf illuminance_errors(const PatchMesh& mesh, const RadiositySolution& solution);

}  // namespace lightwell
