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

/// Least distance of an inner point from the lines of its facet, in spacings. Nearer points make
/// slivers against the line; leaving out farther ones makes elements up to one and a half spacings
/// long. The bound is slightly less than half, so that a line midway between two rows leaves both.
inline constexpr double clear_of_line = 0.5 - 1e-6;
/// The same from creases. Strips between creases, 1 to 2 spacings wide, would otherwise often have
/// no row in the middle.
inline constexpr double clear_of_crease = 0.3;

/// Returns the nodes of the grid that lie inside the polygon and at least half a spacing from its
/// lines: the inner points of a facet's triangulation. `boundary` are the pieces of the polygon's
/// loops; `lines` are the boundary and the contact lines (pairs of indices into `xy`). A distance
/// of 0.3 spacings suffices to `creases`, because light changes most between two of them.
std::vector<Eigen::Vector2d> inner_points(const CellGrid& grid,
                                          const std::vector<Eigen::Vector2d>& xy,
                                          const std::vector<std::array<int, 2>>& boundary,
                                          const std::vector<std::array<int, 2>>& lines,
                                          const std::vector<std::array<int, 2>>& creases = {});

}  // namespace lightwell
