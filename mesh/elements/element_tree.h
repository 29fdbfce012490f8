#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/elements/quad_weights.h"

namespace lightwell {

/// The elements into which those of a base mesh were split (see RefinedElements), as a tree over
/// each: finds the element at a place of the base. The tree holds fronts only, and no elements of
/// round shapes, which are never split.
struct ElementTree {
  static constexpr std::int8_t is_split = -1;
  struct Node {
    int first = 0;  ///< index of the first of its four children, or number of its first element
    /// is_split, or the bits of its split edges, so that closure_pieces() are its elements.
    std::int8_t split_edges = 0;
  };
  /// An element with the weights of its corners.
  struct ElementPoint {
    int element = -1;
    Eigen::Array4f weights = Eigen::Array4f::Zero();
  };

  std::vector<int> root{};  ///< per element of the base, index of its node; -1: none
  /// Per element of the base, its first element; and the number of all elements.
  std::vector<int> first_element{};
  std::vector<Node> nodes{};

  /// The element at weights 1 - w1 - w2, w1, w2 of the corners of a triangle of the base.
  ElementPoint in_triangle(int base_element, double w1, double w2) const;
  /// The element at the place (s, t) of a quadrilateral of the base.
  ElementPoint in_quad(int base_element, const QuadShape& shape,
                       const Eigen::Vector2d& place) const;
};

}  // namespace lightwell
