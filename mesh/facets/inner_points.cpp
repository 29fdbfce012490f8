#include "mesh/facets/inner_points.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

using Eigen::Vector2d;

int CellGrid::cell(const Vector2d& q) const {
  const Vector2d d = q - box.min();
  const int i = std::clamp(static_cast<int>(d.x() / dx()), 0, nx - 1);
  const int j = std::clamp(static_cast<int>(d.y() / dy()), 0, ny - 1);
  return j * nx + i;
}

std::vector<Vector2d> inner_points(const CellGrid& grid, const std::vector<Vector2d>& xy,
                                   const std::vector<std::array<int, 2>>& boundary,
                                   const std::vector<std::array<int, 2>>& lines,
                                   const std::vector<std::array<int, 2>>& creases) {
  const int columns = grid.nx - 1, rows = grid.ny - 1;
  if (columns < 1 || rows < 1) return {};
  const double dx = grid.dx(), dy = grid.dy();
  const Vector2d low = grid.box.min();
  const auto at = [&](int i, int j) {
    return Vector2d(low.x() + dx * (i + 1), low.y() + dy * (j + 1));
  };

  std::vector<char> is_near(static_cast<std::size_t>(columns) * rows, 0);
  const auto keep_clear = [&](const std::array<int, 2>& line, double reach) {
    const auto& [a, b] = line;
    const Vector2d from = xy[a].cwiseMin(xy[b]) - low, to = xy[a].cwiseMax(xy[b]) - low;
    const int i0 = std::max(0, static_cast<int>(std::floor((from.x() - reach) / dx)) - 1);
    const int i1 = std::min(columns - 1, static_cast<int>(std::ceil((to.x() + reach) / dx)));
    const int j0 = std::max(0, static_cast<int>(std::floor((from.y() - reach) / dy)) - 1);
    const int j1 = std::min(rows - 1, static_cast<int>(std::ceil((to.y() + reach) / dy)));
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        if (segment_distance(at(i, j), xy[a], xy[b]) < reach) is_near[j * columns + i] = 1;
      }
    }
  };
  for (const auto& line : lines) keep_clear(line, clear_of_line * std::min(dx, dy));
  for (const auto& line : creases) keep_clear(line, clear_of_crease * std::min(dx, dy));
  std::vector<std::vector<double>> crossings(rows);
  for (const auto& [a, b] : boundary) {
    const Vector2d &p = xy[a], &q = xy[b];
    const double y0 = std::min(p.y(), q.y()), y1 = std::max(p.y(), q.y());
    const int j0 = std::max(0, static_cast<int>(std::floor((y0 - low.y()) / dy)) - 1);
    const int j1 = std::min(rows - 1, static_cast<int>(std::ceil((y1 - low.y()) / dy)));
    for (int j = j0; j <= j1; ++j) {
      const double y = at(0, j).y();
      if (!(y0 <= y && y < y1)) continue;
      crossings[j].push_back(p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x()));
    }
  }
  std::vector<Vector2d> points;
  for (int j = 0; j < rows; ++j) {
    std::sort(crossings[j].begin(), crossings[j].end());
    std::size_t passed = 0;
    for (int i = 0; i < columns; ++i) {
      const Vector2d q = at(i, j);
      while (passed < crossings[j].size() && crossings[j][passed] <= q.x()) ++passed;
      if (passed % 2 == 1 && !is_near[j * columns + i]) points.push_back(q);
    }
  }
  return points;
}

}  // namespace lightwell
