#include "scene/io/convex_cut.h"

#include <Eigen/Geometry>

namespace lightwell {
namespace {

constexpr double on_the_line = 1e-9;  // relative to the hole's size; far above rounding

bool has_area(const Loop& loop, double size) {
  return loop.size() >= 3 && area_vector(loop).norm() > on_the_line * size * size_of(loop);
}

}  // namespace

Loop clip_convex(const Loop& loop, const std::vector<double>& distance, double side) {
  Loop kept;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t next = (i + 1) % loop.size();
    const double here = side * distance[i], there = side * distance[next];
    if (here >= 0.0) kept.push_back(loop[i]);
    if (here * there < 0.0) {
      kept.push_back(loop[i] + here / (here - there) * (loop[next] - loop[i]));
    }
  }
  return kept;
}

bool is_convex(const Loop& loop) {
  const Eigen::Vector3d area = area_vector(loop);
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d before = loop[(i + 1) % n] - loop[i];
    const Eigen::Vector3d after = loop[(i + 2) % n] - loop[(i + 1) % n];
    if (before.cross(after).dot(area) < -flatness * area.squaredNorm()) return false;
  }
  return true;
}

std::vector<Loop> cut_out(const std::vector<Loop>& pieces, const Loop& hole) {
  const double size = size_of(hole);
  const Eigen::Vector3d normal = area_vector(hole).normalized();
  std::vector<Loop> left;
  for (Loop piece : pieces) {
    for (std::size_t i = 0; i < hole.size() && has_area(piece, size); ++i) {
      const Eigen::Vector3d edge = hole[(i + 1) % hole.size()] - hole[i];
      const Eigen::Vector3d outwards = edge.cross(normal).normalized();
      std::vector<double> distance;
      for (const Eigen::Vector3d& p : piece) {
        const double d = (p - hole[i]).dot(outwards);
        distance.push_back(std::abs(d) > on_the_line * size ? d : 0.0);
      }
      Loop outside = clip_convex(piece, distance, 1.0);
      if (has_area(outside, size)) left.push_back(std::move(outside));
      piece = clip_convex(piece, distance, -1.0);
    }
  }
  return left;
}

}  // namespace lightwell
