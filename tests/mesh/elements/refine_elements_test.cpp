#include "mesh/elements/refine_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::refine_elements_test {
namespace {

using namespace test;

using Eigen::Vector3d;

double angle(const Vector3d& at, const Vector3d& a, const Vector3d& b) {
  const Vector3d u = a - at, v = b - at;
  return std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi;
}

// The least angle of the triangles, and of those into which diagonals cut the quadrilaterals.
double least_triangle_angle(const PatchMesh& mesh) {
  double least = 180.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    std::vector<Vector3d> q;
    for (int i = 0; i < n; ++i) q.push_back(mesh.position(mesh.corners[e][i]));
    for (int i = 0; i < n; ++i) {
      for (int k = 1; k + 1 < n; ++k) {
        least = std::min(least, angle(q[i], q[(i + k) % n], q[(i + k + 1) % n]));
      }
    }
  }
  return least;
}

int euler_characteristic(const PatchMesh& mesh) {
  return static_cast<int>(mesh.elements->n_vertices()) -
         static_cast<int>(mesh.elements->n_edges()) + static_cast<int>(mesh.elements->n_faces());
}

std::vector<int> some(const std::vector<int>& of, Numbers& numbers, int one_in) {
  std::vector<int> chosen;
  for (const int cell : of) {
    if (numbers.below(one_in) == 0) chosen.push_back(cell);
  }
  return chosen;
}

std::vector<int> parents(const RefinedElements& refined) {
  std::set<int> found;
  for (const int cell : refined.leaves()) {
    if (refined.parent(cell) >= 0) found.insert(refined.parent(cell));
  }
  return {found.begin(), found.end()};
}

using PointKey = std::array<double, 3>;
PointKey place(const Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

// The levels of the cells that have an edge, whole or half, at one place of a facet. (Facets that
// overlap have inner edges of their own, one of which may happen to be half of another.)
void expect_balance(RefinedElements& refined) {
  std::map<std::tuple<int, PointKey, PointKey>, std::set<int>> whole, halves;
  for (const int cell : refined.leaves()) {
    const int n = refined.corner_count(cell);
    const int facet = refined.base().facet[refined.element(cell, 0)];
    const auto edge = [facet](const Vector3d& p, const Vector3d& q) {
      const PointKey a = place(p), b = place(q);
      return std::tuple(facet, std::min(a, b), std::max(a, b));
    };
    for (int i = 0; i < n; ++i) {
      const Vector3d a = refined.position(refined.corner_vertex(cell, 0, i));
      const Vector3d b = refined.position(refined.corner_vertex(cell, 0, (i + 1) % n));
      const Vector3d middle = 0.5 * (a + b);
      whole[edge(a, b)].insert(refined.level(cell));
      halves[edge(a, middle)].insert(refined.level(cell));
      halves[edge(middle, b)].insert(refined.level(cell));
    }
  }
  for (const auto& [edge, levels] : whole) {
    ASSERT_EQ(levels.size(), 1u);
    const auto coarser = halves.find(edge);
    if (coarser == halves.end()) continue;
    for (const int level : coarser->second) ASSERT_EQ(level + 1, *levels.begin());
  }
}

void expect_sound(RefinedElements& refined, double least_base_angle) {
  const RefinedMesh made = refined.mesh();
  const PatchMesh &mesh = made.mesh, &base = refined.base();
  expect_consistent(mesh);
  ASSERT_EQ(hanging_vertices(mesh), 0);
  ASSERT_EQ(mesh.element_count(), refined.element_count());
  ASSERT_EQ(mesh.patch_count(), base.patch_count());
  ASSERT_TRUE((mesh.area == base.area).all());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    ASSERT_EQ(mesh.facet_of(p), base.facet_of(p));
  }
  ASSERT_GT(smallest_angle(mesh), (1.0 - 1e-6) / 3.0 * least_base_angle);
  expect_balance(refined);
}

class Refined : public ::testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Refined, ::testing::Range(0u, 60u));

TEST_P(Refined, BoxesThatTouchAndCrossStayAMeshWhateverIsSplitAndMerged) {
  const std::uint32_t seed = GetParam();
  Numbers numbers(seed + 1);
  const PatchMesh base = build_patches(boxes_under_a_lamp(seed),
                                       {.max_patch_size = seed % 4 == 0 ? 0.5 : 0.25,
                                        .elements_per_patch_edge = 1 + static_cast<int>(seed % 2),
                                        .discontinuity = seed % 3 == 0});
  const bool conforms = hanging_vertices(base) == 0;
  ASSERT_TRUE(conforms);
  const double least = least_triangle_angle(base);
  RefinedElements refined(base);
  for (int round = 0; round < 4; ++round) {
    refined.split(some(refined.leaves(), numbers, 4 + 2 * round));
    if (round >= 2) refined.merge(some(parents(refined), numbers, 3));
    expect_sound(refined, least);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST_P(Refined, WhatWasSplitIsMergedAgainInReverse) {
  const std::uint32_t seed = GetParam();
  Numbers numbers(seed + 1);
  const PatchMesh base = build_patches(boxes_under_a_lamp(seed), {.max_patch_size = 0.25});
  RefinedElements refined(base);
  for (int round = 0; round < 3; ++round) {
    const std::vector<int> before = refined.leaves();
    const std::vector<int> marks = some(before, numbers, 4);
    std::vector<int> done = refined.split(marks);
    ASSERT_GE(done.size(), marks.size());
    const std::vector<int> after = refined.leaves();
    std::ranges::reverse(done);
    ASSERT_EQ(refined.merge(done), static_cast<int>(done.size()));
    ASSERT_EQ(refined.leaves(), before);
    refined.split(marks);
    ASSERT_EQ(refined.leaves(), after);
  }
}

TEST_P(Refined, SameCellsSplitAlikeInAnyUnit) {
  const std::uint32_t seed = GetParam();
  struct Made {
    std::vector<std::array<int, 4>> base{}, corners{};
    Eigen::ArrayXd element_area{};
  };
  const auto refine = [seed](double scale) {
    Scene scene = boxes_under_a_lamp(seed);
    for (Surface& surface : scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v *= scale;
    }
    const PatchMesh base = build_patches(scene, {.max_patch_size = 0.25 * scale});
    RefinedElements refined(base);
    Numbers numbers(seed);
    for (int round = 0; round < 2; ++round) refined.split(some(refined.leaves(), numbers, 5));
    const PatchMesh made = refined.mesh().mesh;
    return Made{refined.base().corners, made.corners, made.element_area};
  };
  const Made mesh = refine(1.0);
  int compared = 0;
  for (const double scale : {1e-3, 1024.0, 1e3}) {
    const Made other = refine(scale);
    // In a rotated scene rounding may give another base mesh, which cannot be compared.
    if (other.base != mesh.base) continue;
    ++compared;
    ASSERT_EQ(other.corners, mesh.corners);
    // Positions in double precision differ by rounding, parts in 1e15.
    ASSERT_LT((other.element_area / (scale * scale) - mesh.element_area).abs().maxCoeff(), 1e-12);
  }
  EXPECT_GE(compared, seed % 5 == 0 ? 1 : 3);  // a power of two rounds nothing
}

// A floor with a panel that crosses it.
Scene floor_with_panel(double from, double to) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_polygon(scene, "panel",
              {{0.52, from, -0.2}, {0.52, to, -0.2}, {0.52, to, 0.3}, {0.52, from, 0.3}});
  return scene;
}

// Counts the vertices of facet 0's front strictly between two places, by the sides of the line on
// which they have elements.
struct OnLine {
  int left_alone = 0, right_alone = 0, both = 0;
};
OnLine vertices_between(const PatchMesh& mesh, const Vector3d& a, const Vector3d& b) {
  std::map<int, int> sides;
  const Vector3d way = b - a;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]]) continue;
    const bool is_left = way.cross(element_center(mesh, e).position - a).z() > 0.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const Vector3d at = mesh.position(mesh.corners[e][i]) - a;
      const double t = way.dot(at) / way.squaredNorm();
      if (t < 1e-9 || t > 1 - 1e-9 || (at - t * way).norm() > 1e-12) continue;
      sides[mesh.corners[e][i]] |= is_left ? 1 : 2;
    }
  }
  OnLine found;
  for (const auto& [vertex, side] : sides) {
    ++(side == 1 ? found.left_alone : side == 2 ? found.right_alone : found.both);
  }
  return found;
}

TEST(ContactLine, StaysSplitWhenItIsRefined) {
  for (const double to : {1.0, 0.75}) {  // a panel across the floor, and one that ends inside
    const PatchMesh base = build_patches(floor_with_panel(0.0, to), {.max_patch_size = 0.25});
    RefinedElements refined(base);
    for (int round = 0; round < 2; ++round) refined.split(refined.leaves());
    const OnLine found = vertices_between(refined.mesh().mesh, {0.52, 0, 0}, {0.52, to, 0});
    EXPECT_EQ(found.both, 0);
    EXPECT_GE(found.left_alone, 11);
    EXPECT_EQ(found.left_alone, found.right_alone);
  }
}

// A panel shorter than an element has two free ends.
TEST(ContactLine, ShorterThanAnElementStaysSplitToo) {
  const PatchMesh base = build_patches(floor_with_panel(0.45, 0.55),
                                       {.max_patch_size = 0.25, .elements_per_patch_edge = 1});
  RefinedElements refined(base);
  for (int round = 0; round < 2; ++round) {
    refined.split(refined.leaves());
    const RefinedMesh made = refined.mesh();
    expect_consistent(made.mesh);
    const OnLine found = vertices_between(made.mesh, {0.52, 0.45, 0}, {0.52, 0.55, 0});
    EXPECT_EQ(found.left_alone, 4 * (round + 1) - 1);
    EXPECT_EQ(found.right_alone, found.left_alone);
    EXPECT_EQ(found.both, 0);
  }
}

// Inside an L-shaped floor every place but the reflex corner has one vertex.
TEST(ReflexCorner, AloneHasAVertexForEveryElement) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}});
  const PatchMesh base = build_patches(scene, {.max_patch_size = 0.4});
  RefinedElements refined(base);
  for (int round = 0; round < 2; ++round) refined.split(refined.leaves());
  const PatchMesh mesh = refined.mesh().mesh;
  std::map<PointKey, std::set<int>> vertices;
  std::map<PointKey, int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.is_back[mesh.patch[e]]) continue;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const PointKey at = place(mesh.position(mesh.corners[e][i]));
      vertices[at].insert(mesh.corners[e][i]);
      ++elements[at];
    }
  }
  const PointKey corner{1, 1, 0};
  for (const auto& [at, there] : vertices) {
    EXPECT_EQ(static_cast<int>(there.size()), at == corner ? elements[at] : 1);
  }
  EXPECT_GE(elements[corner], 3);
}

TEST(SmoothSurface, StaysOfOnePieceWhereItsFacetsMeet) {
  Numbers numbers(5);
  const PatchMesh base =
      build_patches(triangle_ball(90, 0), {.max_patch_size = 0.3, .smooth_angle_degrees = 5.0});
  RefinedElements refined(base);
  for (int round = 0; round < 2; ++round) {
    refined.split(some(refined.leaves(), numbers, 6));
    const PatchMesh mesh = refined.mesh().mesh;
    EXPECT_EQ(hanging_vertices(mesh), 0);
    // Two closed surfaces, the outside and the inside.
    EXPECT_EQ(euler_characteristic(mesh), 4);
    for (const auto edge : mesh.elements->edges()) {
      ASSERT_FALSE(mesh.elements->is_boundary(edge));
    }
  }
}

TEST(CornellBox, StaysSoundThroughManyRounds) {
  const PatchMesh base = build_patches(cornell_box(), {.elements_per_patch_edge = 1});
  const double least = least_triangle_angle(base);
  Numbers numbers(7);
  RefinedElements refined(base);
  for (int round = 0; round < 6; ++round) {
    // Splits ever deeper at one place, and at random places.
    std::vector<int> marks = some(refined.leaves(), numbers, 100);
    for (const int cell : refined.leaves()) {
      const Vector3d at = refined.position(refined.corner_vertex(cell, 0, 0));
      if (refined.level(cell) == round && (at - Vector3d(0.2, 0, 0.2)).norm() < 0.4 / (1 << round))
        marks.push_back(cell);
    }
    refined.split(marks);
  }
  EXPECT_GE(refined.level(refined.leaves().front()), 0);
  expect_sound(refined, least);
}

TEST(Merging, WhatWasSplitGivesTheBaseAgain) {
  const PatchMesh base = build_patches(boxes_under_a_lamp(4), {.max_patch_size = 0.25});
  Numbers numbers(1);
  RefinedElements refined(base);
  for (int round = 0; round < 3; ++round) refined.split(some(refined.leaves(), numbers, 3));
  EXPECT_GT(refined.element_count(), 2 * base.element_count());
  while (refined.merge(parents(refined)) > 0) {
  }
  const RefinedMesh made = refined.mesh();
  EXPECT_EQ(made.mesh.patch, base.patch);
  EXPECT_EQ(made.mesh.twin, base.twin);
  ASSERT_EQ(made.mesh.vertex_count(), base.vertex_count());
  for (int e = 0; e < base.element_count(); ++e) {
    for (int i = 0; i < base.corner_count(e); ++i) {
      EXPECT_EQ(made.vertex[made.mesh.corners[e][i]], base.corners[e][i]);
    }
  }
  EXPECT_TRUE((made.mesh.element_area == base.element_area).all());
}

TEST(Spheres, StayWhatTheyAre) {
  Scene scene = boxes_under_a_lamp(2);
  add_sphere(scene, "ball", {{0.5, 0.5, 0.9}, 0.2});
  const PatchMesh base = build_patches(scene, {.max_patch_size = 0.25});
  RefinedElements refined(base);
  refined.split(refined.leaves());
  const PatchMesh mesh = refined.mesh().mesh;
  expect_consistent(mesh);
  ASSERT_EQ(mesh.round_grids.size(), 1u);
  const RoundGrid& grid = mesh.round_grids.front();
  for (const int e : grid.element) EXPECT_EQ(mesh.facet[e], grid.facet);
  EXPECT_EQ(mesh.element_count(), refined.element_count());
}

}  // namespace
}  // namespace lightwell::refine_elements_test
