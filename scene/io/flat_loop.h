#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scene/io/loop_tree.h"
#include "scene/io/polygon.h"

namespace lightwell {

/// A loop in the coordinates of its plane.
using FlatLoop = std::vector<Eigen::Vector2d>;

/// The mean of the corners, m.
Eigen::Vector3d mean_point(const Loop& loop);

/// True if an area (m^2) inside a loop is more than nothing. The test value, twice the area over
/// the squared size, is about width over length for a thin strip.
bool has_area(double area, const Loop& loop);

/// Coordinates in the plane of a loop, in which the boundary runs counter-clockwise and has size 1.
struct LoopPlane {
  Eigen::Vector3d origin, normal, x, y;
  double size = 0.0;

  explicit LoopPlane(const Loop& boundary);
  FlatLoop flatten(const Loop& loop) const;
};

/// Twice the signed area of (a, b, c); 0 if the area is within rounding.
double orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);
/// True if the inner parts of the edges a-b and c-d have one point in common.
bool cross_properly(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d);

/// True if two boxes are further apart than points that coincide.
bool are_apart(const LoopTree::Box& box, const LoopTree::Box& other);
LoopTree::Box box_of_edge(const FlatLoop& p, std::size_t i);
LoopTree tree_of_edges(const FlatLoop& p);
LoopTree tree_of_corners(const FlatLoop& p);

/// Distance, relative to a loop's size, at which points coincide: far below `flatness`, far above
/// rounding.
inline constexpr double coincidence = 1e-9;

/// Thrown where the tests of a loop exceed most_pair_tests.
struct TooIntricate {};

/// Counts tests of pairs of corners or edges. Throws TooIntricate.
class PairTests {
 public:
  void count() {
    if (++count_ > most_pair_tests) throw TooIntricate();
  }

 private:
  std::int64_t count_ = 0;
};

}  // namespace lightwell
