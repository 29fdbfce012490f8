#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace lightwell {

/// Distance below which corners are joined, as a share of the scene's diagonal: the precision of
/// files with single-precision coordinates.
inline constexpr double weld_share = 1e-7;

/// A set of points in space in which nearly equal points are one, so that facets that share an edge
/// share its two ends, whatever the rounding in their files. A hash grid finds a point in O(1).
class WeldedPoints {
 public:
  /// Points farther apart than `tolerance` (metres, > 0) are never joined.
  explicit WeldedPoints(double tolerance) : tolerance_(tolerance) {}

  /// Returns the number of the nearest known point whose distance from `point` is at most `radius`
  /// and at most the radius given for the known point; without such a point, the number of a new
  /// one. Radii are in metres and cut to the tolerance. Equal points always join.
  int add(const Eigen::Vector3d& point, double radius);

  /// Forgets all points but the first `count`, as if the others had never been added.
  void keep_first(int count);

  const Eigen::Vector3d& operator[](int i) const { return points_[i]; }
  int size() const { return static_cast<int>(points_.size()); }
  double tolerance() const { return tolerance_; }
  const std::vector<Eigen::Vector3d>& all() const { return points_; }

 private:
  double tolerance_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radius_;
  std::vector<int> next_in_cell_;
  std::unordered_map<std::uint64_t, int> first_in_cell_;
};

}  // namespace lightwell
