#include "radiosity/gather/vertex_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::vertex_points_test {
namespace {

using Eigen::Vector3d;

// Strips between neighbouring lines across z, from z = 0 to 1; `line` gives x and y. One surface.
void add_strips(Scene& scene, const std::vector<Eigen::Vector2d>& line) {
  const int cloth = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  PolygonMesh mesh;
  for (const Eigen::Vector2d& at : line) {
    mesh.vertices.emplace_back(at.x(), at.y(), 0.0);
    mesh.vertices.emplace_back(at.x(), at.y(), 1.0);
  }
  for (int k = 0; k + 1 < static_cast<int>(line.size()); ++k) {
    mesh.facets.push_back({.boundary = {2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2}});
  }
  scene.surfaces.push_back({.name = "strips", .material = cloth, .shape = mesh});
}

// A closed box with a lamp inside stands askew in an arm rest, whose strips meet smoothly. Below
// the box's raised bottom is a wedge of 20 degrees. Nothing else gives light.
struct SunkenCushion {
  SunkenCushion() : mesh(build(scene, frame)), caster(mesh), light(scene, mesh) {}

  static PatchMesh build(Scene& scene, const Eigen::Isometry3d& frame) {
    const int cloth = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 10.0f));
    constexpr double turn = std::numbers::pi / 45.0;  // 4 degrees: facets meet smoothly up to 5
    std::vector<Eigen::Vector2d> arc;
    for (int k = -4; k <= 4; ++k) arc.emplace_back(std::sin(k * turn), std::cos(k * turn));
    add_strips(scene, arc);
    const auto placed = [&](const std::vector<Vector3d>& corners) {
      std::vector<Vector3d> moved;
      for (const Vector3d& corner : corners) moved.push_back(frame * corner);
      return moved;
    };
    test::add_box(scene, {-0.2, 0.0, -0.3}, {0.2, 0.3, 0.3},
                  {cloth, cloth, cloth, cloth, cloth, cloth}, false);
    for (auto s = scene.surfaces.end() - 6; s != scene.surfaces.end(); ++s) {
      for (Vector3d& point : std::get<PolygonMesh>(s->shape).vertices) point = frame * point;
    }
    test::add_polygon(
        scene, "lamp", lamp,
        placed({{-0.1, 0.2, -0.1}, {0.1, 0.2, -0.1}, {0.1, 0.2, 0.1}, {-0.1, 0.2, 0.1}}));
    return build_patches(scene, {.max_patch_size = 0.2});
  }

  // True for the places beside and below the box.
  bool is_outside(const Vector3d& at) const {
    const Vector3d own = frame.inverse() * at;
    return std::abs(own.x()) > 0.2 || own.y() < 0.0 || std::abs(own.z()) > 0.3;
  }

  double brightest_outside(const GatherPoints& points) const {
    const BandArray E = gather_direct({scene, caster, light}, points, {});
    const VertexGatherPoints at(mesh);
    double brightest = 0.0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (is_outside(at.center(v))) brightest = std::max(brightest, double{E(v, 0)});
    }
    return brightest;
  }

  Eigen::Isometry3d frame = Eigen::Translation3d(0.0, 1.0, 0.5) *
                            Eigen::AngleAxisd(std::numbers::pi / 9.0, -Vector3d::UnitX());
  Scene scene{};
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
};

// Points 2 % of an element inside the wedge lie less high there than above the strips of an arm
// rest in the open. Points of that height are within the box, where the lamp gives some 4 W/m^2.
TEST(VertexPoints, LieBelowABodyThatStandsInASmoothSurface) {
  const SunkenCushion room;
  EXPECT_EQ(room.brightest_outside(vertex_points(room.caster)), 0.0);
  EXPECT_GT(room.brightest_outside(vertex_gather_points(room.mesh)), 1.0);
}

TEST(VertexPoints, InTheOpenAreThoseOfTheMesh) {
  Scene scene;
  add_strips(scene, {{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.05}});  // 2.9 degrees
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const std::vector<GatherPoint> expected = vertex_gather_points(mesh);
  const GatherPoints points = vertex_points(caster);
  int smooth = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto& at = expected[static_cast<std::size_t>(v)];
    EXPECT_EQ(points[v].position, at.position);
    EXPECT_EQ(points[v].normal, at.normal);
    EXPECT_EQ(points[v].facet, at.facet);
    smooth += at.facet < 0 ? 1 : 0;
  }
  EXPECT_GT(smooth, 0);
}

// Two slats of 35 mm x 0.66 m that face each other, `gap` apart, of elements 0.33 m long. Returns
// the number of the lower one's vertices whose points are not those of the mesh.
int moved_between_slats(double gap) {
  Scene scene;
  const int metal = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "lower", metal,
                    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.66}, {0.035, 0.0, 0.66}, {0.035, 0.0, 0.0}});
  test::add_polygon(scene, "upper", metal,
                    {{0.0, gap, 0.0}, {0.035, gap, 0.0}, {0.035, gap, 0.66}, {0.0, gap, 0.66}});
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 0.33, .elements_per_patch_edge = 1});
  const ElementCaster caster(mesh);
  const std::vector<GatherPoint> expected = vertex_gather_points(mesh);
  const GatherPoints points = vertex_points(caster);
  int moved = 0, lower = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto& at = expected[static_cast<std::size_t>(v)];
    if (at.position.y() > 0.5 * gap || !(at.normal.y() > 0.0)) continue;
    ++lower;
    moved += points[v].position != at.position ? 1 : 0;
  }
  EXPECT_GE(lower, 6);  // two elements in a row
  return moved;
}

// The next slat, as far away as a slat is wide, is no gap, though an element is ten times as long:
// a point moved by 33 mm would lie beyond the edge of its own slat's shadow. Surfaces 1 cm apart
// are a gap for all vertices.
TEST(VertexPoints, OfLongSlatsAreMovedInGapsThatAreNarrowBesideTheirWidth) {
  EXPECT_EQ(moved_between_slats(0.033), 0);
  EXPECT_GE(moved_between_slats(0.01), 6);
}

}  // namespace
}  // namespace lightwell::vertex_points_test
