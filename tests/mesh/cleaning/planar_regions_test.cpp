#include "mesh/cleaning/planar_regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>
#include <random>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_mesh.h"
#include "tests/mesh/mesh_scenes.h"
#include "tests/sanitizers.h"

namespace lightwell::planar_regions_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;
using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

const PolygonMesh& mesh_of(const Scene& scene, int surface = 0) {
  return std::get<PolygonMesh>(scene.surfaces[surface].shape);
}

double total_area(const Scene& scene) {
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) area += facet_area(mesh, facet);
  }
  return area;
}

Scene scene_of(PolygonMesh mesh, int material = 0) {
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "soup", .material = material, .shape = std::move(mesh)});
  return scene;
}

// Gives each triangle corners of its own, as in STL files.
void add_triangle(PolygonMesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.facets.push_back({.boundary = {first, first + 1, first + 2}});
}

// Cells of a grid, some left out, connected over edges and with displaced corners.
class CellPolygon {
 public:
  CellPolygon(int n, double share, Random& random) : n_(n), in_(n * n, 0) {
    for (char& in : in_) in = uniform(random, 0, 1) < share ? 1 : 0;
    in_[n * n / 2] = 1;
    const std::vector<int> reached = reach(n * n / 2, 1);
    std::fill(in_.begin(), in_.end(), 0);
    for (int c : reached) in_[c] = 1;
    const Eigen::AngleAxisd turn(uniform(random, 0, 6), Vector3d::Random().normalized());
    constexpr double jitter = 0.2;  // of a cell; below 1/4 the cells stay convex
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const double x = i + uniform(random, -jitter, jitter);
        const double y = j + uniform(random, -jitter, jitter);
        corners_.push_back(turn * Vector3d(x, y, 3.0));
      }
    }
  }
  // Two triangles per cell, along either diagonal, in random order.
  Scene triangles(Random& random) const {
    PolygonMesh mesh;
    std::vector<int> order(in_.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    for (const int c : order) {
      if (!in_[c]) continue;
      const int v = c / n_ * (n_ + 1) + c % n_;
      std::array<int, 4> q{v, v + 1, v + n_ + 2, v + n_ + 1};
      if (uniform(random, 0, 1) < 0.5) std::rotate(q.begin(), q.begin() + 1, q.end());
      add_triangle(mesh, corners_[q[0]], corners_[q[1]], corners_[q[2]]);
      add_triangle(mesh, corners_[q[0]], corners_[q[2]], corners_[q[3]]);
    }
    return scene_of(mesh);
  }
  // Counts the parts of the outside, connected over edges, that do not reach the border of the
  // grid.
  int holes() const {
    std::vector<char> seen(in_.size(), 0);
    int count = 0;
    for (int c = 0; c < n_ * n_; ++c) {
      if (in_[c] || seen[c]) continue;
      bool is_open = false;
      for (const int r : reach(c, 0)) {
        seen[r] = 1;
        is_open = is_open || r % n_ == 0 || r % n_ == n_ - 1 || r / n_ == 0 || r / n_ == n_ - 1;
      }
      count += is_open ? 0 : 1;
    }
    return count;
  }

 private:
  std::vector<int> reach(int from, char value) const {
    std::vector<char> seen(in_.size(), 0);
    std::vector<int> reached{from};
    seen[from] = 1;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int x = reached[k] % n_, y = reached[k] / n_;
      for (const auto& [i, j] : {std::pair(x + 1, y), {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
        if (i < 0 || j < 0 || i >= n_ || j >= n_) continue;
        const int next = j * n_ + i;
        if (seen[next] || in_[next] != value) continue;
        seen[next] = 1;
        reached.push_back(next);
      }
    }
    return reached;
  }

  int n_;
  std::vector<char> in_;
  std::vector<Vector3d> corners_;
};

// Rotated coordinates round to 1e-16 of the distance from the origin; areas of some hundred
// triangles then agree to far less than 1e-9.
TEST(PlanarRegions, PolygonsCutIntoTrianglesAreMadeWholeAgain) {
  Random random(1);
  int holes = 0;
  for (int k = 0; k < 3000; ++k) {
    const CellPolygon polygon(2 + k % 9, uniform(random, 0.4, 0.95), random);
    const Scene soup = polygon.triangles(random);
    CleanUpReport report;
    const Scene whole = merge_planar_regions(soup, &report);
    ASSERT_EQ(mesh_of(whole).facets.size(), 1u) << "case " << k;
    ASSERT_EQ(static_cast<int>(mesh_of(whole).facets[0].holes.size()), polygon.holes())
        << "case " << k;
    ASSERT_NEAR(total_area(whole), total_area(soup), 1e-9 * total_area(soup)) << "case " << k;
    ASSERT_EQ(report.merged, report.facets_before);
    ASSERT_NO_THROW(validate(whole));
    holes += polygon.holes();
  }
  EXPECT_GT(holes, 1000);  // the random cases do contain holes
}

TEST(PlanarRegions, WhatIsMergedCanBeMeshed) {
  Random random(2);
  for (int k = 0; k < 30; ++k) {
    const CellPolygon polygon(6, 0.75, random);
    const Scene soup = polygon.triangles(random);
    const PatchMesh mesh = build_patches(merge_planar_regions(soup), {.max_patch_size = 2.0});
    expect_consistent(mesh);
    EXPECT_NEAR(side_area(mesh, 0, false), total_area(soup), 1e-9 * total_area(soup));
  }
}

// n x n squares of two triangles each over the unit square, row by row.
PolygonMesh grid(int n, double height = 0.0) {
  PolygonMesh mesh;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = 1.0 * i / n, y = 1.0 * j / n, x2 = 1.0 * (i + 1) / n, y2 = 1.0 * (j + 1) / n;
      add_triangle(mesh, {x, y, height}, {x2, y, height}, {x2, y2, height});
      add_triangle(mesh, {x, y, height}, {x2, y2, height}, {x, y2, height});
    }
  }
  return mesh;
}

TEST(PlanarRegions, TessellatedSquareIsItsFourCorners) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    PolygonMesh mesh = grid(20);
    for (Vector3d& v : mesh.vertices) v *= scale;
    CleanUpReport report;
    const Scene scene = merge_planar_regions(scene_of(mesh), &report);
    ASSERT_EQ(mesh_of(scene).facets.size(), 1u);
    EXPECT_EQ(mesh_of(scene).facets[0].boundary.size(), 4u);
    EXPECT_EQ(mesh_of(scene).vertices.size(), 4u);
    EXPECT_EQ(report.welded_vertices, 3 * 800 - 21 * 21);
    EXPECT_NEAR(facet_normal(mesh_of(scene), mesh_of(scene).facets[0]).z(), 1.0, 1e-12);
  }
}

TEST(PlanarRegions, NeighboursShareTheCornersThatStay) {
  // A box of tessellated sides: twelve edges, of two facets each.
  PolygonMesh mesh;
  const auto add_side = [&](const Eigen::Matrix3d& turn) {
    const PolygonMesh side = grid(8, 1.0);
    for (const Facet& f : side.facets) {
      const auto at = [&](int i) {
        return Vector3d(turn * (2.0 * side.vertices[f.boundary[i]] - Vector3d(1, 1, 1)));
      };
      add_triangle(mesh, at(0), at(1), at(2));
    }
  };
  Eigen::Matrix3d x, y;  // exact quarter turns
  x << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  y << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  for (const Eigen::Matrix3d& turn :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), x, Eigen::Matrix3d(x * x),
        Eigen::Matrix3d(x * x * x), y, Eigen::Matrix3d(y * y * y)}) {
    add_side(turn);
  }
  const Scene scene = merge_planar_regions(scene_of(mesh));
  EXPECT_EQ(mesh_of(scene).facets.size(), 6u);
  EXPECT_EQ(mesh_of(scene).vertices.size(), 8u);
  EXPECT_EQ(hanging_vertices(build_patches(scene)), 0);
}

TEST(PlanarRegions, VerticesThatOthersNeedStay) {
  // One half is finely divided; the other is a fan of triangles outside the plane.
  PolygonMesh mesh = grid(4);
  add_triangle(mesh, {1, 0, 0}, {2, 0.5, 1}, {1, 0.25, 0});
  const Scene scene = merge_planar_regions(scene_of(mesh));
  ASSERT_EQ(mesh_of(scene).facets.size(), 2u);
  EXPECT_EQ(mesh_of(scene).facets[0].boundary.size(), 5u);  // and (1, 1/4, 0)
}

TEST(PlanarRegions, SurfacesStayApart) {
  Scene scene = empty_scene();
  for (int s = 0; s < 2; ++s) {
    PolygonMesh half = grid(3);
    for (Vector3d& v : half.vertices) v.x() += s;
    scene.surfaces.push_back({.name = "half", .material = s, .shape = half});
  }
  const Scene merged = merge_planar_regions(scene);
  ASSERT_EQ(merged.surfaces.size(), 2u);
  EXPECT_EQ(mesh_of(merged, 0).facets.size(), 1u);
  EXPECT_EQ(mesh_of(merged, 1).facets.size(), 1u);
}

TEST(PlanarRegions, MinorityIsTurnedOver) {
  Random random(3);
  PolygonMesh mesh = grid(10);
  int turned = 0;
  for (Facet& facet : mesh.facets) {
    if (uniform(random, 0, 1) < 0.7) continue;
    std::swap(facet.boundary[1], facet.boundary[2]);
    ++turned;
  }
  CleanUpReport report;
  const Scene scene = merge_planar_regions(scene_of(mesh), &report);
  EXPECT_EQ(report.flipped, turned);
  ASSERT_EQ(mesh_of(scene).facets.size(), 1u);
  EXPECT_NEAR(facet_normal(mesh_of(scene), mesh_of(scene).facets[0]).z(), 1.0, 1e-12);
}

TEST(PlanarRegions, WhatCannotBeKnownIsNotTurned) {
  // Two equal halves that face opposite ways.
  PolygonMesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {0, 1, 0}, {1, 1, 0});
  CleanUpReport report;
  EXPECT_EQ(mesh_of(merge_planar_regions(scene_of(mesh), &report)).facets.size(), 2u);
  EXPECT_EQ(report.flipped, 0);

  // A Moebius strip has no facing.
  PolygonMesh strip;
  constexpr int n = 15;
  const auto at = [&](int i, double w) {
    const double a = 2 * std::numbers::pi * i / n, t = a / 2;
    return Vector3d((1 + w * std::cos(t)) * std::cos(a), (1 + w * std::cos(t)) * std::sin(a),
                    w * std::sin(t));
  };
  for (int i = 0; i < n; ++i) {
    const Vector3d next_low = i + 1 < n ? at(i + 1, -0.3) : at(0, 0.3);
    const Vector3d next_high = i + 1 < n ? at(i + 1, 0.3) : at(0, -0.3);
    add_triangle(strip, at(i, -0.3), next_low, next_high);
    add_triangle(strip, at(i, -0.3), next_high, at(i, 0.3));
  }
  merge_planar_regions(scene_of(strip), &report);
  EXPECT_EQ(report.flipped, 0);
}

TEST(PlanarRegions, DuplicatesGoAndBacksWhereSidesAreAlike) {
  // Material 0 is alike on both sides, material 1 reflects on its front only.
  for (const int material : {0, 1}) {
    PolygonMesh mesh;
    for (int k = 0; k < 3; ++k) add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_triangle(mesh, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    CleanUpReport report;
    const Scene scene = merge_planar_regions(scene_of(mesh, material), &report);
    EXPECT_EQ(report.duplicates, material == 0 ? 3 : 2);
    EXPECT_EQ(mesh_of(scene).facets.size(), material == 0 ? 1u : 2u);
  }
}

TEST(PlanarRegions, DustAndFoldedFacetsGo) {
  PolygonMesh mesh = grid(2);
  add_triangle(mesh, {0.5, 0.5, 1}, {0.5 + 1e-12, 0.5, 1}, {0.5, 0.5 + 1e-12, 1});
  add_triangle(mesh, {0, 0, 1}, {1, 0, 1}, {0.5, 1e-15, 1});
  CleanUpReport report;
  const Scene scene = merge_planar_regions(scene_of(mesh), &report);
  EXPECT_EQ(report.degenerate, 2);
  EXPECT_EQ(mesh_of(scene).facets.size(), 1u);
}

TEST(PlanarRegions, NeedlesBetweenFacetsDoNotKeepThemApart) {
  // A needle of area 1e-9 at an angle of 35 degrees to its neighbours; its area is 2e-10 more than
  // its projection.
  PolygonMesh mesh;
  const Vector3d m(0.5, 0.5 + 2e-9, 1e-9);
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {1, 1, 0}, m);
  add_triangle(mesh, {0, 0, 0}, m, {0, 1, 0});
  add_triangle(mesh, m, {1, 1, 0}, {0, 1, 0});
  const Scene scene = merge_planar_regions(scene_of(mesh));
  ASSERT_EQ(mesh_of(scene).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene).facets[0].boundary.size(), 4u);
  EXPECT_NEAR(total_area(scene), 1.0, 1e-9);
}

TEST(PlanarRegions, WallStandingOnAFloorOfItsSurfaceStaysOnIt) {
  PolygonMesh mesh = grid(4);
  for (const double x : {0.0, 0.25, 0.5, 0.75}) {
    add_triangle(mesh, {x, 0.5, 0}, {x + 0.25, 0.5, 0}, {x + 0.25, 0.5, 1});
    add_triangle(mesh, {x, 0.5, 0}, {x + 0.25, 0.5, 1}, {x, 0.5, 1});
  }
  const Scene scene = merge_planar_regions(scene_of(mesh));
  EXPECT_EQ(mesh_of(scene).facets.size(), 2u);
  const PatchMesh patches = build_patches(scene, {.max_patch_size = 0.2});
  expect_consistent(patches);
  EXPECT_EQ(hanging_vertices(patches), 0);
}

TEST(PlanarRegions, FacetsThatMeetAtPartsOfEdgesBecomeOne) {
  PolygonMesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {0.5, -1, 0}, {0.5, 0, 0});
  add_triangle(mesh, {0.5, 0, 0}, {0.5, -1, 0}, {1, 0, 0});
  CleanUpReport report;
  const Scene scene = merge_planar_regions(scene_of(mesh), &report);
  ASSERT_EQ(mesh_of(scene).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene).facets[0].boundary.size(), 4u);
  EXPECT_EQ(report.hanging, 1);
  EXPECT_NEAR(total_area(scene), 1.0, 1e-12);
  EXPECT_EQ(hanging_vertices(build_patches(scene, {.max_patch_size = 0.3})), 0);
}

// A flat spiral of one and a half turns covers places twice, which no polygon does.
TEST(PlanarRegions, OverlappingWindingsAreCutWhereTheyOverlap) {
  PolygonMesh mesh;
  constexpr int n = 16;
  const auto at = [](int i, double r) {
    const double a = 2 * std::numbers::pi * i / 10;
    return Vector3d((r + 0.01 * i) * std::cos(a), (r + 0.01 * i) * std::sin(a), 0);
  };
  for (int i = 0; i < n; ++i) {
    add_triangle(mesh, at(i, 1), at(i, 2), at(i + 1, 2));
    add_triangle(mesh, at(i, 1), at(i + 1, 2), at(i + 1, 1));
  }
  const Scene soup = scene_of(mesh), scene = merge_planar_regions(soup);
  EXPECT_EQ(mesh_of(scene).facets.size(), 2u);  // one whole turn, and the rest
  EXPECT_NEAR(total_area(scene), total_area(soup), 1e-9);
  EXPECT_NO_THROW(build_patches(scene));
}

TEST(PlanarRegions, CleanScenesStayBitByBit) {
  for (const Scene& scene : {cornell_box(), terrain(12)}) {
    CleanUpReport report;
    const Scene same = merge_planar_regions(scene, &report);
    EXPECT_TRUE(report.is_clean()) << sentence(report);
    EXPECT_EQ(scene_hash(same), scene_hash(scene));
  }
}

TEST(PlanarRegions, CleaningTwiceChangesNothing) {
  Random random(5);
  const Scene once = merge_planar_regions(CellPolygon(9, 0.8, random).triangles(random));
  EXPECT_EQ(scene_hash(merge_planar_regions(once)), scene_hash(once));
}

// Millions of pairs overlap; none shares an edge. Quadratic work would take hours.
TEST(PlanarRegions, HeapsOfOverlapsAndFansFinish) {
  Random random(6);
  PolygonMesh heap, fan, twins;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d at(uniform(random, 0, 1), uniform(random, 0, 1), 0);
    const double a = uniform(random, 0, 6);
    const Vector3d u(std::cos(a), std::sin(a), 0), v(-std::sin(a), std::cos(a), 0);
    add_triangle(heap, at, at + u, at + v);
    add_triangle(fan, {0, 0, 0}, {0, 0, 1}, at + Vector3d(1, 0, 0));
    add_triangle(twins, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  }
  const std::clock_t start = std::clock();  // of the process: other tests run beside this one
  EXPECT_EQ(mesh_of(merge_planar_regions(scene_of(heap))).facets.size(), 20000u);
  EXPECT_EQ(mesh_of(merge_planar_regions(scene_of(fan))).facets.size(), 20000u);
  EXPECT_EQ(mesh_of(merge_planar_regions(scene_of(twins))).facets.size(), 1u);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, 10.0 * test::slowdown);  // 2 s; quadratic work takes thousands
}

}  // namespace
}  // namespace lightwell::planar_regions_test
