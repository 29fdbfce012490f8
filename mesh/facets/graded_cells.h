#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/geometry/facet_plane.h"
#include "mesh/geometry/patch_sizes.h"

namespace lightwell {

/// Square cells of a facet's plane that become smaller towards what is near: a quadtree whose cells
/// are as long as PatchSizes has patches there.
class GradedCells {
 public:
  /// A corner of elements, and the length of the smallest of these.
  struct Node {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    double spacing = 0.0;
  };
  /// Cells that cover `box`, in the frame of `plane`.
  GradedCells(const FacetPlane& plane, const Eigen::AlignedBox2d& box, const PatchSizes& sizes);

  /// Number of the cell that q lies in, or of the one nearest to it in the box.
  int cell(const Eigen::Vector2d& q) const;
  /// Length of a cell's edge, m.
  double length(int cell) const;
  /// The corners of the cells' elements, by rows.
  std::vector<Node> nodes() const;

 private:
  struct Cell {
    std::int64_t x = 0, y = 0;  // lower corner, in smallest patches
    int level = 0;
    int first_child = -1;  // index of the first of four; -1: a leaf
  };
  bool is_split(const FacetPlane& plane, const PatchSizes& sizes, const Cell& cell) const;
  Eigen::Vector2d place(double x, double y) const {
    return low_ + smallest_ * Eigen::Vector2d(x, y);
  }

  Eigen::Vector2d low_;
  double smallest_;
  int elements_per_edge_;
  std::vector<Cell> cells_{};
};

/// The nodes inside the facet that are at least half their spacing from its lines, pairs of indices
/// into `xy`, and 0.3 of it from `creases`: see inner_points().
std::vector<Eigen::Vector2d> graded_inner_points(const GradedCells& cells, const FacetPlane& plane,
                                                 const std::vector<Eigen::Vector2d>& xy,
                                                 const std::vector<std::array<int, 2>>& lines,
                                                 const std::vector<std::array<int, 2>>& creases);

}  // namespace lightwell
