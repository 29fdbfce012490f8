#include "raytrace/readings/grid_outline.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

bool GridOutline::holds(const Eigen::Vector2d& p, double margin) const {
  bool inside = false;
  for (const auto& [a, b] : edges) {
    const Eigen::Vector2d along = b - a;
    const double t = std::clamp(along.dot(p - a) / along.squaredNorm(), 0.0, 1.0);
    if ((p - a - t * along).norm() < margin * (1.0 - 1e-9)) return false;
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) * along.x() / along.y()) inside = !inside;
  }
  return inside;
}

double area_within(const std::vector<std::vector<Eigen::Vector2d>>& loops) {
  double area = 0.0;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<Eigen::Vector2d>& loop = loops[l];
    double doubled = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Eigen::Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
      doubled += a.x() * b.y() - a.y() * b.x();
    }
    area += (l == 0 ? 0.5 : -0.5) * std::abs(doubled);
  }
  return area;
}

}  // namespace lightwell
