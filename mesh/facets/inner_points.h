#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "mesh/contacts/contact_graph.h"

namespace lightwell {

/// A rectangle divided evenly into cells.
struct CellGrid {
  Eigen::AlignedBox2d box{};
  int nx = 1, ny = 1;

  double dx() const { return box.sizes().x() / nx; }
  double dy() const { return box.sizes().y() / ny; }
  /// Number of the cell that q lies in.
  int cell(const Eigen::Vector2d& q) const;
};

/// The points of a fine grid over the polygon's bounds that lie inside it and not too near to a
/// line of the triangulation: what the inside of a facet is triangulated from. `boundary` are the
/// pieces of the polygon's loops, `lines` those and the contact lines (pairs of indices of `xy`).
/// Points may come nearer to `creases`: what lies between two of them is where light changes most.
std::vector<Eigen::Vector2d> inner_points(const CellGrid& grid,
                                          const std::vector<Eigen::Vector2d>& xy,
                                          const std::vector<std::array<int, 2>>& boundary,
                                          const std::vector<std::array<int, 2>>& lines,
                                          const std::vector<std::array<int, 2>>& creases = {});

}  // namespace lightwell
