#include "radiosity/gather/body_exits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/round_grid.h"
#include "radiosity/gather/vertex_points.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::body_exits_test {
namespace {

using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

const Sphere ball{.center = {0.5, 0.48, 0.5}, .radius = 0.13};

// A closed room of 1 m.
struct Room {
  Room() {
    matt = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {matt, matt, matt, matt, matt, matt}, true);
  }
  void add_block(const Box& box) {
    test::add_box(scene, box.min(), box.max(), {matt, matt, matt, matt, matt, matt}, false);
  }
  void add_ball(const Sphere& shape) {
    scene.surfaces.push_back({.name = "ball", .material = matt, .shape = shape});
  }

  Scene scene{};
  int matt = -1;
};

// The gather points of the ball's vertices, with and without BodyExits.
struct Points {
  explicit Points(const Scene& scene)
      : mesh(build_patches(scene, {.max_patch_size = 0.1})),
        caster(mesh),
        light(scene, mesh),
        inside(vertex_points(caster)),
        outside(vertex_points(LitScene{scene, caster, light})) {}

  bool is_moved(int v) const { return inside[v].position != outside[v].position; }
  bool is_on_ball(int v) const { return round_grid_of(mesh, inside[v].facet) != nullptr; }
  // Whether a corner of one of the vertex' elements has a property.
  template <class Is>
  bool has_neighbour(int v, const Is& is) const {
    for (const auto& corners : mesh.corners) {
      if (std::find(corners.begin(), corners.end(), v) == corners.end()) continue;
      for (const int c : corners) {
        if (c >= 0 && is(mesh.position(c))) return true;
      }
    }
    return false;
  }

  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  GatherPoints inside, outside;
};

// Expects that vertices of the ball's front which lie within a body, next to others that do not,
// and only these, have points outside the body, on the ball.
template <class Is>
void expect_points_outside(const Points& points, const Is& is_inside, const Sphere& shape) {
  const auto is_outside = [&](const Vector3d& p) { return !is_inside(p); };
  int moved = 0;
  for (int v = 0; v < points.mesh.vertex_count(); ++v) {
    const Vector3d at = points.mesh.position(v);
    const bool is_front = points.inside[v].normal.dot(at - shape.center) > 0.0;
    if (!points.is_on_ball(v) || !is_front) continue;
    const bool is_covered = is_inside(at) && points.has_neighbour(v, is_outside);
    EXPECT_EQ(points.is_moved(v), is_covered) << at.transpose();
    if (!is_covered) continue;
    ++moved;
    EXPECT_TRUE(is_inside(points.inside[v].position)) << at.transpose();
    const GatherPoint out = points.outside[v];
    EXPECT_FALSE(is_inside(out.position)) << out.position.transpose();
    // A point of the shape to the rounding of double precision of a room of 1 m.
    EXPECT_NEAR((out.position - shape.center).norm(), shape.radius, 1e-14);
    EXPECT_NEAR((out.normal - (out.position - shape.center).normalized()).norm(), 0.0, 1e-13);
  }
  EXPECT_GE(moved, 8);
}

TEST(BodyExits, OfABallInABlockLieOutside) {
  Room room;
  const Box block(Vector3d(0.3, 0.3, 0.2), Vector3d(0.7, 0.7, 0.52));
  room.add_block(block);
  room.add_ball(ball);
  expect_points_outside(
      Points(room.scene), [&](const Vector3d& p) { return block.contains(p); }, ball);
}

TEST(BodyExits, OfABallInAnotherLieOutside) {
  Room room;
  const Sphere other{.center = {0.61, 0.53, 0.55}, .radius = 0.15};
  room.add_ball(ball);
  room.add_ball(other);
  const auto within = [](const Sphere& shape) {
    return [shape](const Vector3d& p) { return (p - shape.center).norm() < shape.radius; };
  };
  const Points points(room.scene);
  int moved = 0;
  for (int v = 0; v < points.mesh.vertex_count(); ++v) {
    if (!points.is_moved(v)) continue;
    ++moved;
    const GatherPoint in = points.inside[v], out = points.outside[v];
    EXPECT_TRUE(within(ball)(in.position) || within(other)(in.position));
    EXPECT_FALSE(within(ball)(0.999 * (out.position - ball.center) + ball.center) &&
                 within(other)(0.999 * (out.position - other.center) + other.center));
  }
  EXPECT_GE(moved, 16);
}

TEST(BodyExits, OfABallInAFloorLieAboveIt) {
  Room room;
  const Sphere sunk{.center = {0.5, 0.48, 0.05}, .radius = 0.13};
  room.add_ball(sunk);
  expect_points_outside(
      Points(room.scene), [](const Vector3d& p) { return p.z() < 0.0; }, sunk);
}

TEST(BodyExits, ASheetCoversNothing) {
  Room room;
  test::add_polygon(room.scene, "sheet", room.matt,
                    {{0.2, 0.2, 0.52}, {0.8, 0.2, 0.52}, {0.8, 0.8, 0.52}, {0.2, 0.8, 0.52}});
  room.add_ball(ball);
  const Points points(room.scene);
  for (int v = 0; v < points.mesh.vertex_count(); ++v) EXPECT_FALSE(points.is_moved(v)) << v;
}

TEST(BodyExits, AWallDoesNotCoverTheRoomBehind) {
  Room room;
  room.add_block(Box(Vector3d(0.5, 0, 0), Vector3d(0.51, 1, 1)));
  room.add_ball(ball);
  const Points points(room.scene);
  for (int v = 0; v < points.mesh.vertex_count(); ++v) {
    const double x = points.mesh.position(v).x();
    EXPECT_TRUE((x > 0.5 && x < 0.51) || !points.is_moved(v)) << x;
  }
}

}  // namespace
}  // namespace lightwell::body_exits_test
