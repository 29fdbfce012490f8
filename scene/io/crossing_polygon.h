#pragma once

#include <vector>

#include "scene/io/polygon.h"

namespace lightwell {

/// A corner of a piece of a polygon, on the edge between two corners of the polygon: at `share`,
/// [0,1], of the way from corner `from` to corner `to`. Corners are counted through the boundary,
/// then through the holes.
struct PieceCorner {
  int from = 0, to = 0;
  double share = 0.0;

  bool operator==(const PieceCorner& other) const = default;
  /// The value at the corner of what is given at the corners of the polygon.
  template <class Value>
  Value of(const std::vector<Value>& values) const {
    const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
    return Value(values[a] + share * (values[b] - values[a]));
  }
};

/// Cuts a polygon whose boundary may cross, touch or repeat itself into convex pieces of three or
/// four corners that do not overlap: trapezoids between parallel lines through its corners and
/// crossings (as in Chazelle & Incerpi 1984, without their search structure).
///
/// The polygon is everything that the boundary goes round, in whatever direction and however often
/// (nonzero winding), except what a hole goes round. The other common rule, even-odd, would open a
/// gap wherever two parts of one polygon overlap, as the arms of a U whose slot closes, and light
/// would pass.
///
/// All pieces are counter-clockwise about the front of the polygon, which is that of the larger
/// part of its area; where the parts cancel, the front is that of the sharpest corner. A polygon
/// that is not planar is cut in projection. Points closer than 1e-9 of the polygon's size become
/// one. Without area, or with more than 10^8 pairs of edges and lines, there are no pieces.
std::vector<std::vector<PieceCorner>> convex_pieces(const Polygon& polygon);

}  // namespace lightwell
