#pragma once

#include <vector>

#include "scene/io/polygon.h"

namespace lightwell {

/// True if no corner of a loop with an area turns inwards.
bool is_convex(const Loop& loop);

/// Clips a convex loop to the part where `side` times the distance of a corner from a plane is >= 0
/// (Sutherland & Hodgman 1974).
Loop clip_convex(const Loop& loop, const std::vector<double>& distance, double side);

/// Subtracts the convex `hole` from convex `pieces` of the same plane and orientation. The result
/// is convex pieces of the same orientation; slivers narrower than 1e-9 of the hole's size are
/// dropped.
std::vector<Loop> cut_out(const std::vector<Loop>& pieces, const Loop& hole);

}  // namespace lightwell
