#include "mesh/facets/graded_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/facets/flat_box.h"
#include "mesh/facets/inner_points.h"

namespace lightwell {

using Eigen::Vector2d;

GradedCells::GradedCells(const FacetPlane& plane, const Eigen::AlignedBox2d& box,
                         const PatchSizes& sizes)
    : low_(box.min()),
      smallest_(sizes.near().patch_size),
      elements_per_edge_(sizes.near().elements_per_edge) {
  const double extent = box.sizes().maxCoeff() / smallest_;
  cells_.push_back({.level = static_cast<int>(std::ceil(std::log2(std::max(1.0, extent))))});
  const Vector2d end = (box.max() - low_) / smallest_;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell cell = cells_[i];
    const bool is_outside =
        static_cast<double>(cell.x) > end.x() || static_cast<double>(cell.y) > end.y();
    if (is_outside || !is_split(plane, sizes, cell)) continue;
    cells_[i].first_child = static_cast<int>(cells_.size());
    const std::int64_t half = std::int64_t{1} << (cell.level - 1);
    for (int c = 0; c < 4; ++c) {
      cells_.push_back(
          {.x = cell.x + (c % 2) * half, .y = cell.y + (c / 2) * half, .level = cell.level - 1});
    }
  }
}

bool GradedCells::is_split(const FacetPlane& plane, const PatchSizes& sizes,
                           const Cell& cell) const {
  if (cell.level == 0) return false;
  const double length = std::ldexp(1.0, cell.level), half = 0.5 * length;
  const Vector2d center =
      place(static_cast<double>(cell.x) + half, static_cast<double>(cell.y) + half);
  const double radius = 0.5 * std::numbers::sqrt2 * length * smallest_;
  return length * smallest_ > sizes.within(plane.lift(center), radius);
}

int GradedCells::cell(const Vector2d& q) const {
  const Vector2d at = (q - low_) / smallest_;
  int i = 0;
  while (cells_[static_cast<std::size_t>(i)].first_child >= 0) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    const double half = std::ldexp(1.0, cell.level - 1);
    const int right = at.x() >= static_cast<double>(cell.x) + half ? 1 : 0,
              upper = at.y() >= static_cast<double>(cell.y) + half ? 2 : 0;
    i = cell.first_child + right + upper;
  }
  return i;
}

double GradedCells::length(int cell) const {
  return std::ldexp(smallest_, cells_[static_cast<std::size_t>(cell)].level);
}

std::vector<GradedCells::Node> GradedCells::nodes() const {
  std::map<std::pair<std::int64_t, std::int64_t>, double> spacing;  // by row and column
  for (const Cell& cell : cells_) {
    if (cell.first_child >= 0) continue;
    const double length = std::ldexp(smallest_, cell.level) / elements_per_edge_;
    for (int j = 0; j <= elements_per_edge_; ++j) {
      for (int i = 0; i <= elements_per_edge_; ++i) {
        const auto place = [&](std::int64_t from, std::int64_t k) {
          return from * elements_per_edge_ + (k << cell.level);
        };
        const auto [entry, is_new] =
            spacing.try_emplace({place(cell.y, j), place(cell.x, i)}, length);
        if (!is_new) entry->second = std::min(entry->second, length);
      }
    }
  }
  std::vector<Node> nodes;
  for (const auto& [at, length] : spacing) {
    nodes.push_back({place(static_cast<double>(at.second) / elements_per_edge_,
                           static_cast<double>(at.first) / elements_per_edge_),
                     length});
  }
  return nodes;
}

std::vector<Vector2d> graded_inner_points(const GradedCells& cells, const FacetPlane& plane,
                                          const std::vector<Vector2d>& xy,
                                          const std::vector<std::array<int, 2>>& lines,
                                          const std::vector<std::array<int, 2>>& creases) {
  const auto boxes_of = [&](const std::vector<std::array<int, 2>>& of) {
    std::vector<BoxTree::Box> boxes;
    for (const auto& [a, b] : of) boxes.push_back(flat_box(xy[a], xy[b], 0.0));
    return boxes;
  };
  const BoxTree line_tree(boxes_of(lines)), crease_tree(boxes_of(creases));
  std::vector<int> near;
  const auto is_clear = [&](const BoxTree& tree, const std::vector<std::array<int, 2>>& of,
                            const Vector2d& at, double reach) {
    tree.find_overlaps(flat_box(at, at, reach), near);
    return std::none_of(near.begin(), near.end(), [&](int i) {
      return segment_distance(at, xy[of[i][0]], xy[of[i][1]]) < reach;
    });
  };
  std::vector<Vector2d> points;
  for (const GradedCells::Node& node : cells.nodes()) {
    if (plane.winds_round(node.at) &&
        is_clear(line_tree, lines, node.at, clear_of_line * node.spacing) &&
        is_clear(crease_tree, creases, node.at, clear_of_crease * node.spacing)) {
      points.push_back(node.at);
    }
  }
  return points;
}

}  // namespace lightwell
