#include "mesh/elements/closure_pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <set>

namespace lightwell::closure_pieces_test {
namespace {

using Eigen::Vector2d;

Vector2d place(int corner_count, int node) {
  static const Vector2d square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto corner = [&](int i) { return square[i % corner_count]; };
  if (node == center_node) return {0.5, 0.5};
  if (node < middle_node) return corner(node);
  return 0.5 * (corner(node - middle_node) + corner(node - middle_node + 1));
}

class Closure : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Corners, Closure, testing::Values(3, 4));

// The square of area 1, or the half of it, with every set of split edges.
TEST_P(Closure, CoversTheElementOnceAndUsesEveryVertexOfItsBoundary) {
  const int n = GetParam();
  for (unsigned edges = 0; edges < (1U << n); ++edges) {
    double area = 0.0;
    std::set<std::pair<int, int>> directed;
    for (const ElementPiece& piece : closure_pieces(n, edges)) {
      const int count = piece[3] < 0 ? 3 : 4;
      for (int i = 0; i < count; ++i) {
        const Vector2d a = place(n, piece[i]), b = place(n, piece[(i + 1) % count]);
        const Vector2d c = place(n, piece[(i + 2) % count]);
        const Vector2d u = b - a, v = c - b;
        EXPECT_GT(u.x() * v.y() - u.y() * v.x(), 0.0) << "convex and counter-clockwise";
        area += 0.5 * (a.x() * b.y() - a.y() * b.x());
        EXPECT_TRUE(directed.emplace(piece[i], piece[(i + 1) % count]).second);
      }
    }
    EXPECT_DOUBLE_EQ(area, n == 4 ? 1.0 : 0.5);
    std::set<std::pair<int, int>> boundary;
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n, middle = middle_node + i;
      if ((edges >> i) & 1U) {
        boundary.insert({{i, middle}, {middle, next}});
      } else {
        boundary.emplace(i, next);
      }
    }
    for (const auto& [a, b] : directed) {
      if (!directed.contains({b, a})) {
        EXPECT_TRUE(boundary.contains({a, b})) << a << " to " << b;
        boundary.erase({a, b});
      }
    }
    EXPECT_TRUE(boundary.empty()) << "edges " << edges << " of " << n;
  }
}

}  // namespace
}  // namespace lightwell::closure_pieces_test
