#include "radiosity/gather/body_exits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/round_grid.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::body_exits_test {
namespace {

using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

const Sphere ball{.center = {0.5, 0.48, 0.5}, .radius = 0.13};
const Sphere sunk{.center = {0.5, 0.48, 0.06}, .radius = 0.13};  // in the floor z = 0

bool is_below_floor(const Vector3d& p) {
  return p.z() < 0.0;
}

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

// The exits of a scene, and the elements around.
struct Exits {
  explicit Exits(const Scene& of)
      : scene(of),
        mesh(build_patches(scene, {.max_patch_size = 0.1})),
        caster(mesh),
        light(scene, mesh),
        points(mesh),
        exits(lit()) {}

  LitScene lit() const { return {scene, caster, light}; }
  const BodyExit* of(int vertex) const {
    for (const BodyExit& exit : exits.all()) {
      if (exit.vertex == vertex) return &exit;
    }
    return nullptr;
  }
  bool is_on_ball(int v) const { return round_grid_of(mesh, points.on_facet(v).facet) != nullptr; }
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

  const Scene& scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  VertexGatherPoints points;
  BodyExits exits;
};

// Expects an exit outside the body, on the ball, between its corners.
template <class Is>
void expect_outside(const PatchMesh& mesh, const BodyExit& exit, const Is& is_inside,
                    const Sphere& shape) {
  EXPECT_FALSE(is_inside(mesh.position(exit.towards)));
  EXPECT_GT(exit.share, 0.0);
  EXPECT_LE(exit.share, 1.0);
  for (const GatherPoint& point : {exit.point, exit.middle}) {
    EXPECT_FALSE(is_inside(point.position)) << point.position.transpose();
    // Coordinates of up to 1 m go through some ten operations, each with a rounding of half an
    // epsilon; a normal's error is that over the radius.
    constexpr double rounding = 10.0 * std::numeric_limits<double>::epsilon();
    const Vector3d from_center = point.position - shape.center;
    EXPECT_NEAR(from_center.norm(), shape.radius, rounding);
    EXPECT_NEAR((point.normal - from_center.normalized()).norm(), 0.0, rounding / shape.radius);
  }
}

// Expects that vertices of the ball's front which lie within a body, next to others that do not,
// and only these, have exits.
template <class Is>
void expect_exits(const Exits& of, const Is& is_inside, const Sphere& shape) {
  const auto is_outside = [&](const Vector3d& p) { return !is_inside(p); };
  int covered = 0;
  for (int v = 0; v < of.mesh.vertex_count(); ++v) {
    const Vector3d at = of.mesh.position(v);
    const bool is_front = of.points.on_facet(v).normal.dot(at - shape.center) > 0.0;
    if (!of.is_on_ball(v) || !is_front) continue;
    const bool is_covered = is_inside(at) && of.has_neighbour(v, is_outside);
    const BodyExit* exit = of.of(v);
    EXPECT_EQ(exit != nullptr, is_covered) << at.transpose();
    if (!exit) continue;
    ++covered;
    expect_outside(of.mesh, *exit, is_inside, shape);
  }
  EXPECT_GE(covered, 8);
}

TEST(BodyExits, OfABallInABlockLieOutside) {
  Room room;
  const Box block(Vector3d(0.3, 0.3, 0.2), Vector3d(0.7, 0.7, 0.52));
  room.add_block(block);
  room.add_ball(ball);
  expect_exits(
      Exits(room.scene), [&](const Vector3d& p) { return block.contains(p); }, ball);
}

TEST(BodyExits, OfABallInAFloorLieAboveIt) {
  Room room;
  room.add_ball(sunk);
  expect_exits(Exits(room.scene), is_below_floor, sunk);
}

TEST(BodyExits, OfABallInAnotherLieOutside) {
  Room room;
  const Sphere other{.center = {0.61, 0.53, 0.55}, .radius = 0.15};
  room.add_ball(ball);
  room.add_ball(other);
  const Exits of(room.scene);
  const auto depth = [](const Sphere& shape, const Vector3d& p) {
    return shape.radius - (p - shape.center).norm();
  };
  int covered = 0;
  for (const BodyExit& exit : of.exits.all()) {
    const Vector3d in = of.points.on_facet(exit.vertex).position, out = exit.point.position;
    const bool is_of_ball = std::abs(depth(ball, out)) < std::abs(depth(other, out));
    const Sphere &own = is_of_ball ? ball : other, &body = is_of_ball ? other : ball;
    // The inside of a ball is cut in two by the other ball, and both parts are dark.
    if (exit.point.normal.dot(out - own.center) < 0.0) continue;
    ++covered;
    EXPECT_GT(depth(body, in), 0.0) << in.transpose();
    EXPECT_LT(depth(body, out), 0.0) << out.transpose();
  }
  EXPECT_GE(covered, 16);
}

TEST(BodyExits, ASheetCoversNothing) {
  Room room;
  test::add_polygon(room.scene, "sheet", room.matt,
                    {{0.2, 0.2, 0.52}, {0.8, 0.2, 0.52}, {0.8, 0.8, 0.52}, {0.2, 0.8, 0.52}});
  room.add_ball(ball);
  const Exits of(room.scene);
  for (const BodyExit& exit : of.exits.all()) {
    // Within the ball, the sheet parts two dark halves.
    const Vector3d out = exit.point.position;
    EXPECT_LT(exit.point.normal.dot(out - ball.center), 0.0) << out.transpose();
  }
}

TEST(BodyExits, AWallDoesNotCoverTheRoomBehind) {
  Room room;
  // No vertex lies in a face of the wall, where vertices are neither inside nor outside.
  const double low = 0.503, high = 0.513;
  room.add_block(Box(Vector3d(low, 0, 0), Vector3d(high, 1, 1)));
  room.add_ball(ball);
  const Exits of(room.scene);
  for (const BodyExit& exit : of.exits.all()) {
    const double x = of.points.on_facet(exit.vertex).position.x();
    EXPECT_TRUE(x > low && x < high) << x;
  }
}

TEST(BodyExits, CoverPointsOfElementsThatAreCut) {
  Room room;
  room.add_ball(sunk);
  const Exits of(room.scene);
  int covered = 0, open = 0;
  for (int e = 0; e < of.mesh.element_count(); ++e) {
    const bool is_cut =
        round_grid_of(of.mesh, of.mesh.facet[e]) &&
        std::ranges::any_of(
            std::span(of.mesh.corners[e]).first(static_cast<std::size_t>(of.mesh.corner_count(e))),
            [&](int v) { return of.of(v) != nullptr; });
    for (const double v : {0.05, 0.25, 0.5, 0.75, 0.95}) {
      const PatchPoint at = PatchSampler(of.mesh, of.mesh.patch[e], e).point(0.4, v);
      const bool is_inside = is_cut && is_below_floor(at.position);
      EXPECT_EQ(of.exits.covers(at), is_inside) << at.position.transpose();
      if (is_cut) ++(is_inside ? covered : open);
    }
  }
  EXPECT_GE(covered, 16);
  EXPECT_GE(open, 16);
}

TEST(BodyExits, LightOfCoveredVerticesIsThatOfTheNearestLine) {
  Room room;
  room.add_ball(sunk);
  const Exits of(room.scene);
  // Rays from outside of the body meet fronts alone, whose light is 1.
  const Eigen::Index vertices = of.mesh.vertex_count(), bands = room.scene.bands.count();
  const BandArray radiosity = BandArray::Ones(vertices, bands);
  // The line nearest to light of E_b = 2 at the other corner and 1 along the way falls by 3/2 at
  // the exit. Less than 0 is no light.
  for (const float E_b : {1.0f, 2.0f}) {
    GatheredIrradiance found{.direct = BandArray::Zero(vertices, bands),
                             .indirect = BandArray::Constant(vertices, bands, E_b),
                             .variance = Eigen::ArrayXf::Zero(vertices)};
    for (const BodyExit& exit : of.exits.all()) found.indirect.row(exit.vertex).setZero();
    light_covered_vertices(of.lit(), of.exits.all(), radiosity, {.rays = 16}, found);
    for (const BodyExit& exit : of.exits.all()) {
      const Vector3d at = of.mesh.position(exit.vertex);
      if (exit.point.normal.dot(at - sunk.center) < 0.0) continue;
      const double fall = 1.5 * (E_b - 1.0) / std::max(exit.share, 0.5);
      // Means of 16 rays of 1 are 1 to the rounding of single precision, 6e-8 a sum.
      EXPECT_NEAR(found.indirect(exit.vertex, 0), std::max(0.0, E_b - fall), 1e-5);
    }
  }
}

// A room whose walls and ceiling shine and whose floor and ball are black. A point of the ball has
// E = M (1 + cos t) / 2, t being the angle of its normal with the vertical, and a little more since
// the floor ends at walls that reach below the point's horizon.
TEST(BodyExits, ASunkBallHasNoDarkRim) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f)),
            lit = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 1.0f));
  test::add_box(scene, {0, 0, 0}, {4, 4, 2}, {lit, lit, lit, lit, black, lit}, true);
  scene.surfaces.push_back({.name = "ball",
                            .material = black,
                            .shape = Sphere{.center = {2.0, 1.9, 0.1}, .radius = 0.3}});
  SolveOptions options;
  options.mesh = {.max_patch_size = 0.3};
  options.gather = {.rays = 4096, .shadows = {.min_rays = 4096, .max_rays = 4096}};
  const SolvedScene solved = solve_scene(scene, options);
  const PatchMesh& mesh = solved.mesh;
  const BandArray E = solved.solution.irradiance();
  // Interpolation over rings of pi/8: an eighth of their square times the greatest curvature of
  // cos t / 2 for cos t from -1/3 to 0.
  const double curved = std::pow(std::numbers::pi / 8.0, 2) / 8.0 / 6.0;
  // Three standard errors of 4096 rays that meet light or none.
  const double noise = 3.0 * 0.5 / std::sqrt(4096.0);
  // Light from d below the horizon of a receiver that stands upright is 2 d / pi. The vertices of
  // the rim are at most 0.1 m high, and 1.6 m from the walls.
  const double below_horizon = 2.0 / std::numbers::pi * 0.1 / 1.6;
  int checked = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (!round_grid_of(mesh, mesh.facet[e]) || mesh.is_back[p] != 0) continue;
    for (int i = 0; i < 25; ++i) {
      const PatchPoint at = PatchSampler(mesh, p, e).point(0.05 + 0.2 * (i % 5), 0.04 * i);
      if (at.position.z() < 0.0 || at.position.z() > 0.1) continue;
      ++checked;
      const double above =
          interpolate(mesh, E, point_on_element(mesh, at))[0] - 0.5 * (1.0 + at.normal.z());
      EXPECT_GE(above, -(curved + noise)) << at.position.transpose();
      EXPECT_LE(above, curved + noise + below_horizon) << at.position.transpose();
    }
  }
  EXPECT_GE(checked, 16);
}

}  // namespace
}  // namespace lightwell::body_exits_test
