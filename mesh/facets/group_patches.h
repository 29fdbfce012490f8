#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace lightwell {

/// An element, as grouping needs it.
struct PlacedElement {
  int cell = 0;                                         ///< coarse grid cell of its centre
  Eigen::Vector2d cell_size = Eigen::Vector2d::Ones();  ///< of that cell, metres
  double area = 0.0;                                    ///< m^2
  Eigen::AlignedBox2d box{};
};

/// Two elements that share an edge along which no contact line runs.
struct ElementContact {
  int one = 0, other = 0;
  double length = 0.0;  ///< of the edge, metres
};

/// Groups the elements of a facet into patches: connected elements of one cell of a grid. A group
/// that the boundary leaves smaller than 15 % of a cell joins the neighbour with which it shares
/// the longest border, unless the two together would be longer or wider than 1.5 of the larger
/// cells. Returns the patch of each element; patches are numbered by
/// cell, then by first element.
std::vector<int> group_patches(const std::vector<PlacedElement>& elements,
                               const std::vector<ElementContact>& contacts);

}  // namespace lightwell
