#pragma once

#include <optional>

#include "scene/io/polygon.h"

namespace lightwell {

/// A polygon with the holes that `loop` describes by seams: edges that lead from the boundary to a
/// hole and back again, whole or in parts that vertices lie on. The loop itself has no hole.
/// Nothing if the loop has no seams, or if what is left of it without them is not one boundary with
/// holes of the opposite direction.
std::optional<Polygon> without_seams(const Loop& loop);

}  // namespace lightwell
