#pragma once

#include <vector>

#include "scene/io/polygon.h"

namespace lightwell {

/// Half the sum of the edges' cross products: the area times the normal (Newell).
Eigen::Vector3d area_vector(const Loop& loop);

/// Whether no corner turns inwards, for a loop with an area.
bool is_convex(const Loop& loop);

/// What is left of convex `pieces` of one plane where the convex `hole`, of the same plane and
/// orientation, is taken away: convex pieces again, of the same orientation. Slivers narrower than
/// 1e-9 of the hole's size are dropped.
std::vector<Loop> cut_out(const std::vector<Loop>& pieces, const Loop& hole);

}  // namespace lightwell
