#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/elements/quad_weights.h"

namespace lightwell {

/// Where in the elements of a base mesh those lie that they were split into (see RefinedElements):
/// who has met a place of the base finds the element there. Of fronts; elements on spheres are
/// not split, and are in none of it.
struct ElementTree {
  static constexpr std::int8_t is_split = -1;
  struct Node {
    int first = 0;  ///< the first of the four nodes it is split into, or its first element
    /// is_split, or which of its edges are, so that closure_pieces() are its elements.
    std::int8_t split_edges = 0;
  };
  /// An element, and weights of its corners.
  struct ElementPoint {
    int element = -1;
    Eigen::Array4f weights = Eigen::Array4f::Zero();
  };

  std::vector<int> root{};           ///< per element of the base, its node; -1: none
  std::vector<int> first_element{};  ///< the same, its first; one entry more than there are
  std::vector<Node> nodes{};

  /// In a triangle of the base, at weights 1 - w1 - w2, w1, w2 of its corners.
  ElementPoint in_triangle(int base_element, double w1, double w2) const;
  /// In a quad of the base.
  ElementPoint in_quad(int base_element, const QuadShape& shape,
                       const Eigen::Vector2d& place) const;
};

}  // namespace lightwell
