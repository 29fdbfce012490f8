// Defects of models from real programs, and scenes that are hard to mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/patches/element_quality.h"
#include "mesh/patches/patch_mesh.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::dirty_models_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180.0;

void add_triangle(PolygonMesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.facets.push_back({.boundary = {first, first + 1, first + 2}});
}

Scene scene_of(PolygonMesh mesh, int material = 1) {
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "soup", .material = material, .shape = std::move(mesh)});
  return scene;
}

const PolygonMesh& mesh_of(const Scene& scene, int surface = 0) {
  return std::get<PolygonMesh>(scene.surfaces[surface].shape);
}

void round_to_float(PolygonMesh& mesh) {
  for (Vector3d& v : mesh.vertices) v = v.cast<float>().cast<double>();
}

// A rectangle cut in two, and so on with the parts: nearly every corner lies inside a neighbour's
// edge.
void cut_rectangle(double x0, double y0, double x1, double y1, int depth, Numbers& random,
                   const Eigen::AngleAxisd& turn, PolygonMesh& mesh) {
  if (depth > 0) {
    const double t = random.between(0.2, 0.8);
    if (x1 - x0 > y1 - y0) {
      const double x = x0 + t * (x1 - x0);
      cut_rectangle(x0, y0, x, y1, depth - 1, random, turn, mesh);
      cut_rectangle(x, y0, x1, y1, depth - 1, random, turn, mesh);
    } else {
      const double y = y0 + t * (y1 - y0);
      cut_rectangle(x0, y0, x1, y, depth - 1, random, turn, mesh);
      cut_rectangle(x0, y, x1, y1, depth - 1, random, turn, mesh);
    }
    return;
  }
  const auto at = [&](double x, double y) { return Vector3d(turn * Vector3d(x, y, 0.5)); };
  add_triangle(mesh, at(x0, y0), at(x1, y0), at(x1, y1));
  add_triangle(mesh, at(x0, y0), at(x1, y1), at(x0, y1));
}

// Rounding to single precision moves corners off the edges in which they lie. The clean-up may move
// corners by 1e-7 of the diagonal, and so change the area by that distance times the length of the
// edges.
TEST(DirtyModels, RectanglesThatMeetAtPartsOfEdgesBecomeOne) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Numbers random(seed);
    const Vector3d axis(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    const Eigen::AngleAxisd turn(random.between(0, 6), axis.normalized());
    PolygonMesh mesh;
    cut_rectangle(0, 0, 1, 1, 2 + random.below(5), random, turn, mesh);
    round_to_float(mesh);
    const Scene soup = scene_of(mesh);
    CleanUpReport report;
    const Scene scene = merge_planar_regions(soup, &report);
    ASSERT_EQ(mesh_of(scene).facets.size(), 1u) << "seed " << seed;
    ASSERT_EQ(mesh_of(scene).facets[0].boundary.size(), 4u) << "seed " << seed;
    EXPECT_GT(report.hanging, 0);
    double edges = 0.0;
    for (const Facet& f : mesh.facets) {
      for (int i = 0; i < 3; ++i) {
        edges += (mesh.vertices[f.boundary[i]] - mesh.vertices[f.boundary[(i + 1) % 3]]).norm();
      }
    }
    const double moved = 1e-7 * scene_bounds(soup).diagonal();
    EXPECT_NEAR(report.area_after, report.area_before, moved * edges);
  }
}

// One quadrilateral beside two, bent by 3 degrees: a smooth surface, so one vertex at each place.
TEST(DirtyModels, VerticesInsideANeighboursEdgeAreSharedWhereTheSurfaceIsSmooth) {
  const double z = std::tan(3.0 * degree);
  PolygonMesh mesh = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  for (const double y : {0.0, 0.4}) {
    const double next = y > 0.0 ? 1.0 : 0.4;
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& v :
         {Vector3d(1, y, 0), Vector3d(2, y, z), Vector3d(2, next, z), Vector3d(1, next, 0)}) {
      mesh.vertices.push_back(v);
    }
    mesh.facets.push_back({.boundary = {first, first + 1, first + 2, first + 3}});
  }
  const Scene soup = scene_of(mesh);
  ASSERT_EQ(mesh_of(merge_planar_regions(soup)).facets.size(), 2u);
  for (const Scene& s : {soup, merge_planar_regions(soup)}) {
    const PatchMesh patches = build_patches(s, {.max_patch_size = 0.5});
    expect_consistent(patches);
    EXPECT_EQ(hanging_vertices(patches), 0);
    std::set<double> places;
    int vertices = 0;
    for (int v = 0; v < patches.vertex_count(); ++v) {
      if (std::abs(patches.position(v).x() - 1.0) > 1e-12) continue;
      places.insert(std::round(1e9 * patches.position(v).y()));
      ++vertices;
    }
    EXPECT_EQ(static_cast<int>(places.size()), vertices);
  }
}

// A railing in single precision in a hall of 30 m. Its sides are planes to the rounding, 1e-6 m,
// which is far more than 5e-10 of their own area.
TEST(DirtyModels, ThinBarsFarFromTheOriginHaveSixSides) {
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 3).normalized());
  PolygonMesh bar;
  const auto add_side = [&](const Vector3d& at, const Vector3d& u, const Vector3d& v) {
    constexpr int n = 12;
    for (int i = 0; i < n; ++i) {
      const auto corner = [&](double s, double t) {
        return Vector3d(Vector3d(20, 11, -7) + turn * (at + s / n * u + t * v));
      };
      add_triangle(bar, corner(i, 0), corner(i + 1, 0), corner(i + 1, 1));
      add_triangle(bar, corner(i, 0), corner(i + 1, 1), corner(i, 1));
    }
  };
  const Vector3d x(1.2, 0, 0), y(0, 0.008, 0), z(0, 0, 0.01);
  add_side({0, 0, 0}, x, z);
  add_side({0, 0, 0}, y, x);
  add_side({0, 0, 0}, z, y);
  add_side(y, z, x);
  add_side(z, x, y);
  add_side(x, y, z);
  round_to_float(bar);
  Scene scene = scene_of(bar);
  add_polygon(scene, "floor", {{0, 0, -9}, {30, 0, -9}, {30, 20, -9}, {0, 20, -9}});
  CleanUpReport report;
  const Scene clean = merge_planar_regions(scene, &report);
  EXPECT_EQ(mesh_of(clean).facets.size(), 6u);
  EXPECT_EQ(mesh_of(clean).vertices.size(), 8u);
  // Corners may move by 1e-7 of the diagonal along the bar's twelve edges, each of two sides; the
  // floor is whole already.
  const double edges = 2.0 * 4.0 * (x.norm() + y.norm() + z.norm());
  EXPECT_NEAR(report.area_after, report.area_before, 1e-7 * scene_bounds(scene).diagonal() * edges);
}

// Welding moves corners by 1e-7 of the diagonal at most, and puts points of other facets into edges
// within that distance. A facet's area changes by less than that distance times the length of its
// boundary.
TEST(DirtyModels, AreaStaysWithinTheWeldingOfTheBoundary) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    Scene scene = boxes_under_a_lamp(seed);
    for (Surface& surface : scene.surfaces) round_to_float(std::get<PolygonMesh>(surface.shape));
    const double moved = 1e-7 * scene_bounds(scene).diagonal();
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
    const auto facets = scene_facets(scene);
    for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
      const PolygonMesh& polygons = mesh_of(scene, facets[f].surface);
      const Facet& facet = polygons.facets[facets[f].facet];
      double boundary = 0.0;
      for (std::size_t i = 0; i < facet.boundary.size(); ++i) {
        boundary += (polygons.vertices[facet.boundary[i]] -
                     polygons.vertices[facet.boundary[(i + 1) % facet.boundary.size()]])
                        .norm();
      }
      const double area = facet_area(polygons, facet);
      // Rounding of the sum over elements: a share of 1e-12 at most.
      EXPECT_NEAR(side_area(mesh, f, false), area, moved * boundary + 1e-12 * area);
    }
  }
}

Loop circle(int n, double radius, const Vector3d& center) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / n;
    loop.push_back(center + radius * Vector3d(std::cos(a), std::sin(a), 0.0));
  }
  return loop;
}

TEST(DirtyModels, RoundFootSendsNoSliversOverTheFloor) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, 1);
  add_polygon(scene, "foot", circle(64, 0.1, {0.2, 0.1, 0}), {}, 1);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.4});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  const ElementQuality quality = element_quality(mesh);
  // The 64 points of the foot, and on each side two rows of about 32 and 16 points.
  EXPECT_GT(quality.least_angle_degrees, 10.0);
  EXPECT_LT(quality.elements, 10 * 10 + 2 * 2 * (64 + 32 + 16));
}

// A ball of 4000 triangles sunk into a floor with elements as large as the ball. The joined line
// stays within 1/200 of an element of the cut, so the area inside equals the ball's section to that
// distance times the length of the line.
TEST(DirtyModels, FinelyDividedLinesAreJoinedInsideCoarseFacets) {
  Scene scene = triangle_ball(64, 1);
  add_polygon(scene, "floor", {{-4, -4, 0.01}, {4, -4, 0.01}, {4, 4, 0.01}, {-4, 4, 0.01}}, {}, 1);
  const int floor = static_cast<int>(scene_facets(scene).size()) - 1;
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 4.0});
  expect_consistent(mesh);
  double inside = 0.0;
  int elements = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != floor) continue;
    ++elements;
    const Vector3d at = element_center(mesh, e).position;
    if (std::hypot(at.x(), at.y()) < 1.0) inside += mesh.element_area[e];
  }
  const double moved = 0.005 * 2.0, length = 2.0 * std::numbers::pi;
  // The section of the ball, a polygon of 64 sides at a height of 0.01, is smaller than the disc.
  constexpr double sides = 64.0, pi = std::numbers::pi;
  const double section = (1.0 - 0.01 * 0.01) * 0.5 * sides * std::sin(2.0 * pi / sides);
  EXPECT_NEAR(inside, section, moved * length);
  EXPECT_LT(elements, 120);  // 64 cuts on each side would make twice as many
  // Cuts inside a facet do not change its boundary; the difference is rounding of the sum.
  EXPECT_NEAR(side_area(mesh, floor, false), 64.0, 64.0 * 1e-12);
}

// The wings of the bow tie meet at (6/7, 4/7): a triangle of 2 m by 4/7 m and one of 1.5 m by 3/7
// m. A hole beside its polygon opens nothing. Programs may mesh both with or without cleaning.
TEST(DirtyModels, PolygonsThatCrossThemselvesAreMeshedInTheirParts) {
  Scene bow = empty_scene();
  add_polygon(bow, "bow", {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1.5, 1, 0}});
  Scene hole = empty_scene();
  add_polygon(hole, "wall", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
              {{{2, 2, 0}, {2, 2.5, 0}, {2.5, 2.5, 0}, {2.5, 2, 0}}});
  // Corners stay where they are and the crossing is known to 1e-16: the sum of some thousand
  // elements is off by less than 1e-12.
  constexpr double rounding = 1e-12;
  for (const double size : {0.0, 0.1, 5.0}) {
    for (const auto& [scene, area] :
         {std::pair(bow, 4.0 / 7.0 + 9.0 / 28.0), std::pair(hole, 1.0)}) {
      const PatchMesh raw = build_patches(scene, {.max_patch_size = size});
      EXPECT_NEAR(0.5 * raw.area.sum(), area, rounding);
      EXPECT_EQ(raw.notes.size(), 1u);
      const Scene clean = merge_planar_regions(scene);
      EXPECT_EQ(clean.losses.size(), 1u);
      const PatchMesh mesh = build_patches(clean, {.max_patch_size = size});
      expect_consistent(mesh);
      EXPECT_NEAR(0.5 * mesh.area.sum(), area, rounding);
      EXPECT_TRUE(mesh.notes.empty());
    }
  }
}

TEST(DirtyModels, PolygonsWithoutAreaAreLeftOutWithANote) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_polygon(scene, "line", {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1.5, 0, 1}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  expect_consistent(mesh);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("'line'"), std::string::npos) << mesh.notes[0];
}

// A mat with a fringe: a bent strip of needles, 1e-4 m wide and 0.24 m long, at the rim of a grid
// of bent squares, with corners of the fringe inside edges of the grid. `jitter` moves every vertex
// of every triangle by up to that many metres along each axis.
PolygonMesh fringed_mat(Numbers& random, double jitter) {
  PolygonMesh mat;
  const auto at = [&](double x, double y) {
    const Vector3d p(x, y, 0.02 * std::sin(9.0 * x) + 0.03 * std::cos(5.0 * y));
    return Vector3d(p + Vector3d(random.between(-jitter, jitter), random.between(-jitter, jitter),
                                 random.between(-jitter, jitter)));
  };
  constexpr int cells = 8, needles = 100;
  constexpr double side = 2.5, width = 1e-4, length = 0.24;
  const auto quad = [&](double x0, double y0, double x1, double y1) {
    add_triangle(mat, at(x0, y0), at(x1, y0), at(x1, y1));
    add_triangle(mat, at(x0, y0), at(x1, y1), at(x0, y1));
  };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) quad(side * i, side * j, side * (i + 1), side * (j + 1));
  }
  for (int i = 0; i < needles; ++i) quad(1.0 + i * width, -length, 1.0 + (i + 1) * width, 0.0);
  return mat;
}

// Turned, scaled and jittered copies at sizes from much larger to much smaller than the triangles:
// every one is meshed, and its area is that of the triangles to what welding moves.
TEST(DirtyModels, FringedMatsAreMeshedAtAnySize) {
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    Numbers random(seed);
    PolygonMesh mat = fringed_mat(random, std::array{0.0, 1e-9, 1e-6, 1e-5}[seed % 4]);
    const Eigen::AngleAxisd turn(random.between(0.0, 6.0), Vector3d(1, 2, 3).normalized());
    const double scale = std::array{1.0, 1e-3, 1e3}[seed % 3];
    for (Vector3d& v : mat.vertices) v = scale * (turn * v);
    const Scene scene = merge_planar_regions(scene_of(std::move(mat), 0));
    const double patch = scale * std::array{0.2, 0.5, 2.0, 30.0}[seed / 6];
    PatchMesh mesh;
    EXPECT_NO_THROW(mesh = build_patches(scene, {.max_patch_size = patch})) << seed;
    double edges = 0.0;
    const PolygonMesh& facets = mesh_of(scene);
    for (const Facet& facet : facets.facets) {
      for (std::size_t i = 0; i < facet.boundary.size(); ++i) {
        edges += (facets.vertices[facet.boundary[i]] -
                  facets.vertices[facet.boundary[(i + 1) % facet.boundary.size()]])
                     .norm();
      }
    }
    // 1e-5 of the diagonal is the largest tolerance of welding; elements are on both sides.
    const double moved = 1e-5 * scene_bounds(scene).diagonal() * edges;
    EXPECT_NEAR(0.5 * mesh.area.sum(), scene_area(scene), moved) << seed;
  }
}

TEST(DirtyModels, DustAndContinentsInOneSceneAreMeshed) {
  Scene scene = empty_scene();
  add_polygon(scene, "plain", {{-5e5, -5e5, 0}, {5e5, -5e5, 0}, {5e5, 5e5, 0}, {-5e5, 5e5, 0}});
  add_box(scene, "hut", {0, 0, 0}, {4, 3, 2});
  PolygonMesh dust = polygon({{0, 0, 3}, {1, 0, 3}, {0, 1, 3}});
  for (int i = 0; i < 100; ++i) {
    const Vector3d at(0.1 * i, 1, 1);
    add_triangle(dust, at, at + Vector3d(1e-12, 0, 0), at + Vector3d(0, 1e-12, 0));
  }
  scene.surfaces.push_back({.name = "dust", .material = 0, .shape = dust});
  CleanUpReport report;
  const Scene clean = merge_planar_regions(scene, &report);
  EXPECT_EQ(report.degenerate, 100);
  const PatchMesh mesh = build_patches(clean);
  EXPECT_GE(mesh.patch_count(), 2 * 7);
  for (int f = 1; f < 7; ++f) EXPECT_GT(side_area(mesh, f, false), 5.9);  // the hut stands
}

TEST(DirtyModels, HundredCopiesOfEveryFacetAreOne) {
  Scene box = empty_scene();
  add_box(box, "box", {0, 0, 0}, {1, 2, 3});
  const PolygonMesh once = mesh_of(box);
  PolygonMesh copies;
  for (int k = 0; k < 100; ++k) {
    const int first = static_cast<int>(copies.vertices.size());
    copies.vertices.insert(copies.vertices.end(), once.vertices.begin(), once.vertices.end());
    for (Facet facet : once.facets) {
      for (int& v : facet.boundary) v += first;
      copies.facets.push_back(facet);
    }
  }
  CleanUpReport report;
  EXPECT_EQ(mesh_of(merge_planar_regions(scene_of(copies), &report)).facets.size(), 6u);
  EXPECT_EQ(report.duplicates, 6 * 99);

  Scene apart = empty_scene();  // one of separate surfaces that differ in name alone
  for (int k = 0; k < 100; ++k) add_box(apart, "box", {0, 0, 0}, {1, 2, 3});
  const PatchMesh mesh = build_patches(merge_planar_regions(apart), {.max_patch_size = 1.0});
  EXPECT_NEAR(mesh.area.sum(), 2 * 22.0, 1e-6);
}

// 1000 overlapping triangles meet in more than a million places, above the limit of ContactEffort.
TEST(DirtyModels, HeapsWithTooManyContactsAreMeshedWithTheLongest) {
  constexpr int count = 1000;
  Numbers random(1);
  PolygonMesh heap;
  for (int i = 0; i < count; ++i) {
    const Vector3d at(random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0);
    const double a = random.between(0, 6);
    const Vector3d u(std::cos(a), std::sin(a), 0), v(-u.y(), u.x(), 0);
    add_triangle(heap, at - u - v, at + u - v, at + v);
  }
  const PatchMesh mesh = build_patches(merge_planar_regions(scene_of(heap)));
  // Welding moves edges by 1e-5 of the diagonal at most; each triangle has 2 + 2 sqrt(5) m of them.
  const double moved =
      1e-5 * scene_bounds(scene_of(heap)).diagonal() * (2.0 + 2.0 * std::sqrt(5.0));
  EXPECT_NEAR(mesh.area.sum(), count * 2.0, count * moved);
  ASSERT_FALSE(mesh.notes.empty());
  EXPECT_NE(mesh.notes.back().find("crossed by too many others"), std::string::npos);
}

}  // namespace
}  // namespace lightwell::dirty_models_test
