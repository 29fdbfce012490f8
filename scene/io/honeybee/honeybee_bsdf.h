#pragma once

#include <vector>

#include "scene/io/json_object.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// The seven arguments of a RADIANCE `trans` for a Honeybee BSDF: a sheet that scatters as much as
/// the BSDF does in all, evenly to all sides, on both of its faces alike.
///
/// Transmittance and reflectance are hemispherical for light from all directions, by the matrices
/// of the visible band of the file of the program WINDOW in `bsdf_data` (145 or fewer patches of
/// Klems 1994), and the diffuse shares that the modifier adds. Adds a remark on the loss. Data that
/// cannot be read become a clear sheet, with a remark.
std::vector<double> trans_of_bsdf(const JsonObject& modifier, Remarks& remarks);

}  // namespace lightwell
