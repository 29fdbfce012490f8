#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace lightwell {

/// The precision of single-precision files: corners closer than this share of a scene's diagonal
/// are one.
inline constexpr double weld_share = 1e-7;

/// Points in space in which nearly equal ones are one: what makes two facets that share an edge
/// share its ends, whatever their files' rounding. Hashed on a grid; O(1) a point.
class WeldedPoints {
 public:
  /// No two points further apart than `tolerance` (metres, > 0) are ever joined.
  explicit WeldedPoints(double tolerance) : tolerance_(tolerance) {}

  /// The number of the nearest point within both its radius and `radius` (at most the tolerance;
  /// equal points always join), or of a new one.
  int add(const Eigen::Vector3d& point, double radius);

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
