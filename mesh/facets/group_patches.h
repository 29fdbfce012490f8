#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace lightwell {

/// What grouping needs to know of an element.
struct PlacedElement {
  int cell = 0;  ///< coarse grid cell of its centre
  double area = 0.0;
  Eigen::AlignedBox2d box{};
};

/// Two elements that share an edge no contact line runs along.
struct ElementContact {
  int one = 0, other = 0;
  double length = 0.0;
};

/// Groups elements into patches: connected elements of one cell. What a boundary leaves smaller
/// than 15 % of a cell joins the neighbour it shares the longest border with, unless the two
/// together would outgrow a cell by half. Patches are numbered by cell, then by first element.
std::vector<int> group_patches(const std::vector<PlacedElement>& elements,
                               const std::vector<ElementContact>& contacts,
                               const Eigen::Vector2d& cell_size);

}  // namespace lightwell
