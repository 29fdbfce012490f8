#include "mesh/elements/element_tree.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "mesh/elements/closure_pieces.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
// Nodes of closure_pieces(): corners, middles of edges and centre, in a plane with any two axes.
using Nodes = std::array<Vector2d, center_node + 1>;

// A piece of a leaf of the tree, prepared for point location.
struct Outline {
  int corner_count = 3;
  /// Per edge, coefficients whose product with (1, x, y) is twice the area of the triangle of the
  /// edge and the place (x, y); negative for places beyond the edge.
  std::array<Eigen::Array3d, 4> edge{};
  double twice_area = 0.0;  // used for triangles
  // Used for quadrilaterals: `to_edges` maps a place minus `corner` to (a, b) of QuadShape, and
  // `shape` is (alpha, beta).
  Vector2d corner = Vector2d::Zero(), shape = Vector2d::Ones();
  Eigen::Matrix2d to_edges = Eigen::Matrix2d::Identity();
};

Outline outline(const ElementPiece& piece, const Nodes& nodes) {
  Outline result{.corner_count = piece[3] < 0 ? 3 : 4};
  const int n = result.corner_count;
  result.edge.fill(Eigen::Array3d::Zero());
  for (int i = 0; i < n; ++i) {
    const Vector2d &a = nodes[piece[i]], &b = nodes[piece[(i + 1) % n]];
    const Vector2d way = b - a;
    result.edge[i] = {way.y() * a.x() - way.x() * a.y(), -way.y(), way.x()};
  }
  result.corner = nodes[piece[0]];
  Eigen::Matrix2d edges;
  edges << nodes[piece[1]] - result.corner, nodes[piece[n - 1]] - result.corner;
  result.twice_area = edges.determinant();
  result.to_edges = edges.inverse();
  if (n == 4) result.shape = result.to_edges * (nodes[piece[2]] - result.corner);
  return result;
}

struct Outlines {
  int count = 0;
  std::array<Outline, 4> of{};

  Outlines() = default;
  Outlines(std::span<const ElementPiece> pieces, const Nodes& nodes)
      : count(static_cast<int>(pieces.size())) {
    for (int k = 0; k < count; ++k) of[k] = outline(pieces[k], nodes);
  }
};

template <class Point>
Nodes lattice(int corner_count, const Point& point) {
  Nodes nodes;
  nodes.fill(point(0.5, 0.5));
  nodes[0] = point(0.0, 0.0);
  nodes[1] = point(1.0, 0.0);
  if (corner_count == 4) nodes[2] = point(1.0, 1.0);
  nodes[corner_count - 1] = point(0.0, 1.0);
  for (int i = 0; i < corner_count; ++i) {
    nodes[middle_node + i] = 0.5 * (nodes[i] + nodes[(i + 1) % corner_count]);
  }
  return nodes;
}

// Outlines of the pieces of a triangle or parallelogram, by the edges that are split. The axes are
// the two edges at corner 0.
template <int corner_count>
const Outlines& straight_outlines(unsigned split_edges) {
  static const auto table = [] {
    std::array<Outlines, 1U << corner_count> result;
    const Nodes nodes = lattice(corner_count, [](double s, double t) { return Vector2d(s, t); });
    for (unsigned edges = 0; edges < result.size(); ++edges) {
      result[edges] = Outlines(closure_pieces(corner_count, edges), nodes);
    }
    return result;
  }();
  return table[split_edges];
}

Eigen::Array4f weights_in(const Outline& piece, const Eigen::Array4d& areas,
                          const Vector2d& place) {
  if (piece.corner_count == 3) {
    return (Eigen::Array4d(areas[1], areas[2], areas[0], 0.0) / piece.twice_area).cast<float>();
  }
  const Vector2d at = piece.to_edges * (place - piece.corner);
  return bilinear_weights(
      bilinear_coordinates(piece.shape.x(), piece.shape.y(), at.x(), at.y(), at));
}

// The piece that contains `place`, or the nearest one if rounding leaves `place` outside all.
ElementTree::ElementPoint in_one_of(const Outlines& pieces, int first_element,
                                    const Vector2d& place) {
  double most = -std::numeric_limits<double>::infinity();
  int nearest = 0;
  Eigen::Array4d areas_of_nearest = Eigen::Array4d::Zero();
  for (int k = 0; k < pieces.count && most < 0.0; ++k) {
    Eigen::Array4d areas;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Array3d& edge = pieces.of[k].edge[i];
      areas[i] = edge[0] + edge[1] * place.x() + edge[2] * place.y();
    }
    const double least = areas.minCoeff();
    if (least <= most) continue;
    most = least;
    nearest = k;
    areas_of_nearest = areas;
  }
  return {.element = first_element + nearest,
          .weights = weights_in(pieces.of[nearest], areas_of_nearest, place)};
}

}  // namespace

ElementTree::ElementPoint ElementTree::in_triangle(int base_element, double w1, double w2) const {
  Node node = nodes[root[base_element]];
  double w0 = 1.0 - w1 - w2;
  while (node.split_edges == is_split) {
    const double before = w0, first = w1, second = w2;
    int child = 3;
    if (before > 0.5) {
      child = 0;
    } else if (first > 0.5) {
      child = 1;
    } else if (second > 0.5) {
      child = 2;
    }
    // The corners of the middle child are the middles of edges 0, 1 and 2.
    if (child == 3) {
      w0 = 1.0 - 2.0 * second;
      w1 = 1.0 - 2.0 * before;
      w2 = 1.0 - 2.0 * first;
    } else {
      w0 = 2.0 * before - (child == 0 ? 1.0 : 0.0);
      w1 = 2.0 * first - (child == 1 ? 1.0 : 0.0);
      w2 = 2.0 * second - (child == 2 ? 1.0 : 0.0);
    }
    node = nodes[node.first + child];
  }
  if (node.split_edges == 0) {
    return {.element = node.first, .weights = Eigen::Array4d(w0, w1, w2, 0.0).cast<float>()};
  }
  return in_one_of(straight_outlines<3>(static_cast<unsigned>(node.split_edges)), node.first,
                   {w1, w2});
}

ElementTree::ElementPoint ElementTree::in_quad(int base_element, const QuadShape& shape,
                                               const Eigen::Vector2d& place) const {
  Node node = nodes[root[base_element]];
  Vector2d at = place;
  double size = 1.0;  // edge of the node, in the base's s and t
  while (node.split_edges == is_split) {
    // A branch would be costly, because the end points of rays are unpredictable.
    const int is_right = at.x() > 0.5 ? 1 : 0, is_above = at.y() > 0.5 ? 1 : 0;
    at = 2.0 * at - Vector2d(is_right, is_above);
    size *= 0.5;
    node = nodes[node.first + (is_right ^ (3 * is_above))];
  }
  if (node.split_edges == 0) return {.element = node.first, .weights = bilinear_weights(at)};
  const auto edges = static_cast<unsigned>(node.split_edges);
  if (shape.is_parallelogram()) return in_one_of(straight_outlines<4>(edges), node.first, at);
  // Coordinates have their origin in corner 0 of the node, and the base's two edges at its corner
  // 0, times `size`, as axes. The bilinear map of the base is bilinear in the node too.
  const Vector2d corner = place - size * at, bend(shape.alpha - 1.0, shape.beta - 1.0);
  const Vector2d x = Vector2d(1.0, 0.0) + corner.y() * bend,
                 y = Vector2d(0.0, 1.0) + corner.x() * bend;
  const auto point = [&](double s, double t) -> Vector2d {
    return s * x + t * y + size * s * t * bend;
  };
  return in_one_of(Outlines(closure_pieces(4, edges), lattice(4, point)), node.first,
                   point(at.x(), at.y()));
}

}  // namespace lightwell
