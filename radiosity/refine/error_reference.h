#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Irradiance that errors at a point are relative to, W/m^2: the scene's mean irradiance or a
/// quarter of the point's own, whichever is more. (With the mean alone, the inside of a lamp shade,
/// a thousand times as bright as the room, would decide over the whole room.)
double error_reference(double mean_irradiance, double own_irradiance);

/// Per patch, 1 if errors of its irradiance count: if it reflects, since others see its light;
/// where nothing reflects, if it does not emit, since such surfaces are there to be measured.
std::vector<char> judged_patches(const PatchMesh& mesh);

/// error_reference() of every element, W/m^2, for `irradiance` at vertices (vertices x bands). The
/// scene's mean is taken over all judged_patches(), an element's own irradiance over its corners.
Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance);

}  // namespace lightwell
