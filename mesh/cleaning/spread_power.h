#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Scales the emission of every material of `clean` whose power the file states (see StatedPower),
/// so that its surfaces send together what those of `given` send: dropped duplicates and facets
/// without area take no part of the power with them. With M, the exitance, and A, the area,
///
///     M' = M * sum(A M) / sum(A' M)
///
/// A material whose area stays, to the rounding of a float, keeps its emission bit for bit.
void keep_stated_power(const Scene& given, Scene& clean);

}  // namespace lightwell
