#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace lightwell {

/// Above 0 if b turns counter-clockwise from a.
inline double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Convex hull of points, counter-clockwise (Andrew 1979, "Another efficient algorithm for convex
/// hulls in two dimensions").
inline std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= start + 2 &&
             turn(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// True if a line along an edge of `a` separates `b`, up to an overlap of `tolerance`, m.
inline bool is_apart(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b,
                     double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d edge = (a[(i + 1) % a.size()] - a[i]).normalized();
    const bool all_outside = std::all_of(b.begin(), b.end(), [&](const Eigen::Vector2d& p) {
      return turn(edge, p - a[i]) <= tolerance;
    });
    if (all_outside) return true;
  }
  return false;
}

}  // namespace lightwell
