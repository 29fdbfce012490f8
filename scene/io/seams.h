#pragma once

#include <optional>

#include "scene/io/polygon.h"

namespace lightwell {

/// Converts a loop with seams to a polygon with holes. A seam is an edge from the boundary to a
/// hole and back again, whole or divided at vertices on it. Returns nothing if the loop has no
/// seams, or if the edges other than seams are not one boundary with holes of the opposite
/// orientation.
std::optional<Polygon> without_seams(const Loop& loop);

}  // namespace lightwell
