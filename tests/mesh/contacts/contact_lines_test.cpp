#include "mesh/contacts/contact_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "mesh/geometry/cross.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::contact_lines_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Distance to the nearest edge's line of a counter-clockwise convex polygon, m: > 0 inside, 0 on
// the boundary.
double depth_inside(const std::vector<Vector2d>& polygon, const Vector2d& q) {
  double depth = INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d d = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    depth = std::min(depth, cross(d, q - polygon[i]));
  }
  return depth;
}

std::vector<int> elements_of(const PatchMesh& mesh, int facet, bool back = false) {
  std::vector<int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (mesh.facet[e] == facet && (mesh.is_back[p] != 0) == back) elements.push_back(e);
  }
  return elements;
}

// Expects that no element and no patch of `facet` straddles the convex polygon, that no vertex
// belongs to both sides, and that the covered part has the polygon's area.
void expect_cut_by(const PatchMesh& mesh, int facet, const std::vector<Vector2d>& polygon,
                   double covered_area, int x, int y) {
  constexpr double rounding = 1e-9;
  const auto flat = [&](const Vector3d& p) { return Vector2d(p[x], p[y]); };
  double covered = 0.0;
  std::map<int, std::set<bool>> sides_of_vertex, sides_of_patch;
  for (int e : elements_of(mesh, facet)) {
    const bool inside = depth_inside(polygon, flat(element_center(mesh, e).position)) > 0.0;
    if (inside) covered += mesh.element_area[e];
    sides_of_patch[mesh.patch[e]].insert(inside);
    const int n = mesh.corner_count(e);
    for (int i = 0; i < n; ++i) {
      sides_of_vertex[mesh.corners[e][i]].insert(inside);
      const Vector2d a = flat(mesh.position(mesh.corners[e][i]));
      const Vector2d b = flat(mesh.position(mesh.corners[e][(i + 1) % n]));
      if (inside) {
        ASSERT_GT(depth_inside(polygon, a), -rounding);
      } else {
        for (double t : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9}) {
          ASSERT_LT(depth_inside(polygon, a + t * (b - a)), rounding);
        }
      }
    }
  }
  for (const auto& [v, sides] : sides_of_vertex) ASSERT_EQ(sides.size(), 1u) << "vertex " << v;
  for (const auto& [p, sides] : sides_of_patch) ASSERT_EQ(sides.size(), 1u) << "patch " << p;
  EXPECT_NEAR(covered, covered_area, 1e-12);
}

TEST(ContactLines, FloorIsCutWhereBlocksStand) {
  const Scene scene = cornell_box();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.06});
  // Floor seen from above, +y up: (z, x) is right-handed.
  const auto cut = [&](std::vector<Vector2d> xz) {
    std::vector<Vector2d> polygon;
    double area = 0.0;
    for (const Vector2d& p : xz) polygon.push_back(1e-3 * Vector2d(p.y(), p.x()));
    for (std::size_t i = 0; i < 4; ++i) area += 0.5 * cross(polygon[i], polygon[(i + 1) % 4]);
    expect_cut_by(mesh, 0, polygon, area, 2, 0);
  };
  cut({{130, 65}, {82, 225}, {240, 272}, {290, 114}});
  cut({{423, 247}, {265, 296}, {314, 456}, {472, 406}});
}

TEST(ContactLines, BlockOnFloorSharesItsFootPointByPoint) {
  const PatchMesh mesh = build_patches(cornell_box(), {.max_patch_size = 0.06});
  EXPECT_EQ(hanging_vertices(mesh), 0);
}

TEST(ContactLines, CoplanarOverlapCutsBothFacets) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add_polygon(scene, "carpet", {{1.1, 0.7, 0}, {3, 0.7, 0}, {3, 1.6, 0}, {1.1, 1.6, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.21});
  expect_consistent(mesh);
  const std::vector<Vector2d> overlap{{1.1, 0.7}, {2, 0.7}, {2, 1.6}, {1.1, 1.6}};
  expect_cut_by(mesh, 0, overlap, 0.81, 0, 1);
  expect_cut_by(mesh, 1, overlap, 0.81, 0, 1);
  EXPECT_EQ(hanging_vertices(mesh), 0);
}

TEST(ContactLines, IntersectingBoxesCutEachOther) {
  Scene scene = empty_scene();
  const Vector3d low(0.43, 0.31, 0.57), high(1.4, 0.83, 1.3);
  add_box(scene, "one", {0, 0, 0}, {1, 1, 1});
  add_box(scene, "other", low, high);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.15});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  // The depth inside a box, > 0 strictly inside.
  const auto depth = [](const Vector3d& p, const Vector3d& l, const Vector3d& h) {
    return std::min((p - l).minCoeff(), (h - p).minCoeff());
  };
  double hidden = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool of_one = mesh.facet[e] < 6;
    const Vector3d l = of_one ? low : Vector3d::Zero(), h = of_one ? high : Vector3d::Ones();
    const bool inside = depth(element_center(mesh, e).position, l, h) > 0.0;
    if (inside && mesh.is_back[mesh.patch[e]] == 0) hidden += mesh.element_area[e];
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const double d = depth(mesh.position(mesh.corners[e][i]), l, h);
      if (inside) {
        ASSERT_GT(d, -1e-9);
      } else {
        ASSERT_LT(d, 1e-9);
      }
    }
  }
  // The common box is [.43,1]x[.31,.83]x[.57,1]. The faces x = 1 and z = 1 of `one` are hidden
  // inside `other`, and the four lower and side faces of `other` inside `one`.
  const double a = 0.57, b = 0.52, c = 0.43;
  EXPECT_NEAR(hidden, (b * c + a * b) + (b * c + 2 * a * c + a * b), 1e-12);
}

// Per place on the line y = 0.5 of a facet's front, the number of mesh vertices.
std::map<double, int> vertices_on_line(const PatchMesh& mesh, int facet) {
  std::set<int> seen;
  std::map<double, int> count;
  for (int e : elements_of(mesh, facet)) {
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const int v = mesh.corners[e][i];
      const Vector3d p = mesh.position(v);
      if (std::abs(p.y() - 0.5) < 1e-9 && seen.insert(v).second) {
        ++count[std::round(p.x() * 1e9) * 1e-9];
      }
    }
  }
  return count;
}

TEST(ContactLines, PartitionEndingInsideAFloorSplitsVerticesBetweenItsEnds) {
  for (const double from : {0.3, 0.0}) {
    Scene scene = empty_scene();
    add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_polygon(scene, "partition",
                {{from, 0.5, 0}, {0.7, 0.5, 0}, {0.7, 0.5, 0.4}, {from, 0.5, 0.4}});
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
    expect_consistent(mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
    int split = 0;
    for (const auto& [x, count] : vertices_on_line(mesh, 0)) {
      // Free ends belong to both sides; on the floor's own edge (x = 0) the line separates them.
      const bool between = x < 0.7 - 1e-9 && (from == 0.0 ? x > -1e-9 : x > from + 1e-9);
      EXPECT_EQ(count, between ? 2 : 1) << "at x = " << x;
      split += between ? 1 : 0;
    }
    EXPECT_GE(split, 7);  // 0.4 m or more in pieces of at most 0.05 m
  }
}

TEST(ContactLines, PartitionShorterThanAnElementStillSeparatesItsSides) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_polygon(scene, "card", {{0.48, 0.5, 0}, {0.54, 0.5, 0}, {0.54, 0.5, 0.1}, {0.48, 0.5, 0.1}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  expect_consistent(mesh);
  EXPECT_EQ(vertices_on_line(mesh, 0)[0.51], 2);
}

TEST(ContactLines, CrossingPartitionsSplitIntoFourCorners) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_polygon(scene, "a", {{0.2, 0.5, -0.2}, {0.8, 0.5, -0.2}, {0.8, 0.5, 0.4}, {0.2, 0.5, 0.4}});
  add_polygon(scene, "b", {{0.5, 0.2, -0.3}, {0.5, 0.8, -0.3}, {0.5, 0.8, 0.3}, {0.5, 0.2, 0.3}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  EXPECT_EQ(vertices_on_line(mesh, 0)[0.5], 4);
}

TEST(ContactLines, WallStandingOnASmoothEdgeStopsSharingThere) {
  // Two coplanar facets of one surface share vertices along x = 0.5, but not where a wall stands.
  Scene scene = empty_scene();
  PolygonMesh floor;
  floor.vertices = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}, {0, 1, 0}};
  floor.facets = {{.boundary = {0, 1, 4, 5}}, {.boundary = {1, 2, 3, 4}}};
  scene.surfaces.push_back({.name = "floor", .material = 1, .shape = floor});
  const auto vertex_count = [&] { return build_patches(scene, {.max_patch_size = 0.1}); };
  const PatchMesh open = vertex_count();
  EXPECT_EQ(open.vertex_count(), 21 * 21);
  add_polygon(scene, "wall", {{0.5, 0, 0}, {0.5, 0.4, 0}, {0.5, 0.4, 1}, {0.5, 0, 1}}, {}, 1);
  const PatchMesh cut = vertex_count();
  std::set<int> at_edge;
  for (int facet : {0, 1}) {
    for (int e : elements_of(cut, facet)) {
      for (int i = 0; i < cut.corner_count(e); ++i) {
        if (std::abs(cut.position(cut.corners[e][i]).x() - 0.5) < 1e-12) {
          at_edge.insert(cut.corners[e][i]);
        }
      }
    }
  }
  // 21 places, doubled where the wall stands: at 0, 0.05 ... 0.35, but not at the wall's free end
  // at 0.4.
  EXPECT_EQ(at_edge.size(), 21u + 8u);
}

// Elements of the floor of 2 m x 2 m below. An element's area is a sum of products of coordinates,
// each rounded by up to 2^-53 of 4 m^2.
constexpr int most_elements = 1000;
constexpr double area_rounding = most_elements * 0x1p-53 * 4.0;  // 4.4e-13 m^2

// Area of the floor's elements that lie inside of a curve; all others lie outside. Chords, on which
// vertices may lie, come nearer to the middle than the curve by cos(pi / n), n > 18 chords.
double covered_area(const Frustum& frustum,
                    const std::function<double(const Vector3d&)>& share_of_curve) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  scene.surfaces.push_back({.name = "column", .shape = frustum});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  expect_consistent(mesh);
  EXPECT_LE(elements_of(mesh, 0).size(), std::size_t{most_elements});
  // Twenty roundings of coordinates up to 2 m, as shares of the least radius, 0.3 m.
  constexpr double on_curve = 1.0 + 20 * 0x1p-53 * 2.0 / 0.3;
  double covered = 0.0;
  for (const int e : elements_of(mesh, 0)) {
    double nearest = INFINITY, farthest = 0.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const double share = share_of_curve(mesh.position(mesh.corners[e][i]));
      nearest = std::min(nearest, share);
      farthest = std::max(farthest, share);
    }
    const double dip = std::cos(std::numbers::pi / 18);
    EXPECT_TRUE(farthest < on_curve || nearest > dip) << nearest << " " << farthest;
    if (farthest < on_curve) covered += mesh.element_area[e];
  }
  return covered;
}

double polygon_in_circle(double r, double element) {
  const double n = std::ceil(2 * std::numbers::pi * r / element);
  return 0.5 * n * r * r * std::sin(2 * std::numbers::pi / n);
}

TEST(ContactLines, AColumnCutsItsCircleOutOfTheFloor) {
  const double r = 0.45;
  const auto share = [&](const Vector3d& p) { return std::hypot(p.x() - 0.9, p.y() - 1.1) / r; };
  // Standing on the floor, hanging down to it, and through it.
  for (const double low : {0.0, -1.0, -0.4}) {
    const Frustum column{.base = {0.9, 1.1, low}, .height = 1.0, .base_radius = r, .top_radius = r};
    EXPECT_NEAR(covered_area(column, share), polygon_in_circle(r, 0.1), area_rounding) << low;
  }
}

TEST(ContactLines, ACutConeLeavesTheCircleAtItsHeight) {
  const Frustum cone{
      .base = {0.9, 1.1, -0.5}, .height = 1.0, .base_radius = 0.8, .top_radius = 0.0};
  const auto share = [&](const Vector3d& p) { return std::hypot(p.x() - 0.9, p.y() - 1.1) / 0.4; };
  // The chords are those of the base: an angle of 0.1 / 0.8.
  EXPECT_NEAR(covered_area(cone, share), 0.25 * polygon_in_circle(0.8, 0.1), area_rounding);
}

TEST(ContactLines, ALeaningColumnCutsAnEllipse) {
  const double r = 0.3, lean = 0.5;
  const Vector3d axis(std::sin(lean), 0, std::cos(lean));
  const Frustum column{.base = Vector3d(0.9, 1.1, 0) - 0.8 * axis,
                       .axis = axis,
                       .height = 1.7,
                       .base_radius = r,
                       .top_radius = r};
  const auto share = [&](const Vector3d& p) {
    return std::hypot((p.x() - 0.9) * std::cos(lean), p.y() - 1.1) / r;
  };
  EXPECT_NEAR(covered_area(column, share), polygon_in_circle(r, 0.1) / std::cos(lean),
              area_rounding);
}

TEST(ContactLines, HalfSunkSphereCutsItsCircleOutOfTheFloor) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const double r = 0.45;
  add_sphere(scene, "ball", {.center = {0.9, 1.1, 0.0}, .radius = r});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  expect_consistent(mesh);
  double covered = 0.0;
  for (int e : elements_of(mesh, 0)) {
    double nearest = INFINITY, farthest = 0.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const Vector3d p = mesh.position(mesh.corners[e][i]);
      const double d = std::hypot(p.x() - 0.9, p.y() - 1.1);
      nearest = std::min(nearest, d);
      farthest = std::max(farthest, d);
    }
    ASSERT_TRUE(farthest < r * (1 + 1e-9) || nearest > r * (1 - 1e-9))
        << nearest << " " << farthest;
    if (farthest < r * (1 + 1e-9)) covered += mesh.element_area[e];
  }
  // A regular polygon of n = ceil(2 pi r / h) = 29 sides.
  const int n = static_cast<int>(std::ceil(2 * std::numbers::pi * r / 0.1));
  EXPECT_NEAR(covered, 0.5 * n * r * r * std::sin(2 * std::numbers::pi / n), 1e-12);
}

TEST(ContactLines, SphereInACornerCutsAllThreeWallsAndConforms) {
  Scene scene = empty_scene();
  add_box(scene, "room", {0, 0, 0}, {1, 1, 1}, false);
  add_sphere(scene, "ball", {.center = {0.1, 0.05, 0.07}, .radius = 0.3});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
}

TEST(ContactLines, SphereRestingOnAFloorCutsNothing) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const int alone = build_patches(scene, {.max_patch_size = 0.2}).element_count();
  add_sphere(scene, "ball", {.center = {0.4, 0.6, 0.3}, .radius = 0.3});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  EXPECT_EQ(static_cast<int>(elements_of(mesh, 0).size()) * 2, alone);
}

// Boxes on a common lattice touch in every possible way: faces on faces, edges in faces, corners on
// edges. Rounding the coordinates to single precision after a rotation makes all contacts inexact.
TEST(ContactLines, TouchingBoxesConformAfterRoundingToSinglePrecision) {
  for (int seed = 0; seed < 6; ++seed) {
    Scene scene = empty_scene();
    std::uint32_t state = 12345u + static_cast<std::uint32_t>(seed);
    const auto next = [&](int n) {
      state = state * 1664525u + 1013904223u;
      return static_cast<int>((state >> 8) % static_cast<std::uint32_t>(n));
    };
    for (int b = 0; b < 12; ++b) {
      const Vector3d low(next(8), next(8), next(8));
      const Vector3d extent(1 + next(4), 1 + next(4), 1 + next(4));
      add_box(scene, "box", low / 8, (low + extent) / 8, b % 2 == 0);
    }
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.1 + seed, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (Surface& surface : scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) {
        v = (turn * v + Vector3d(0.3, -0.7, 0.1)).cast<float>().cast<double>();
      }
    }
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
    expect_consistent(mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0) << "seed " << seed;
    const auto facets = scene_facets(scene);
    for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
      const auto& polygons = std::get<PolygonMesh>(scene.surfaces[facets[f].surface].shape);
      const double area = facet_area(polygons, polygons.facets[facets[f].facet]);
      // Corners move by at most the tolerance, 1e-7 of a diagonal of about 2 m, along edges of at
      // least 1/8 m.
      EXPECT_NEAR(side_area(mesh, f, false), area, 2 * 2e-7 / 0.125 * area);
    }
  }
}

}  // namespace
}  // namespace lightwell::contact_lines_test
