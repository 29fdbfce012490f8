#include "mesh/facets/pair_triangles.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/facets/facet_mesh.h"

namespace lightwell {

std::array<int, 4> joined_corners(const std::array<int, 3>& t, const std::array<int, 3>& other,
                                  int opposite_corner) {
  const int a = t[opposite_corner], b = t[(opposite_corner + 1) % 3],
            d = t[(opposite_corner + 2) % 3];
  int c = other[0];
  for (int v : other) {
    if (v != b && v != d) c = v;
  }
  return {a, b, c, d};
}

std::vector<int> pair_triangles(const std::vector<Eigen::Vector2d>& xy,
                                const std::vector<std::array<int, 3>>& triangles,
                                const std::vector<std::array<int, 3>>& neighbor) {
  constexpr double least_quality = 0.55;            // sine; angles between 33 and 147 degrees
  std::vector<std::tuple<double, int, int>> pairs;  // (-quality, t, other)
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int other = neighbor[t][i];
      if (other <= t) continue;  // each pair once; -1 is out as well
      const auto q = joined_corners(triangles[t], triangles[other], i);
      const double quality = quad_quality(xy[q[0]], xy[q[1]], xy[q[2]], xy[q[3]]);
      // Qualities equal to rounding count as equal; then the numbers decide, in every unit.
      if (quality > least_quality) pairs.emplace_back(-std::round(1e6 * quality), t, other);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> partner(triangles.size(), -1);
  for (const auto& [quality, t, other] : pairs) {
    if (partner[t] >= 0 || partner[other] >= 0) continue;
    partner[t] = other;
    partner[other] = t;
  }
  return partner;
}

}  // namespace lightwell
