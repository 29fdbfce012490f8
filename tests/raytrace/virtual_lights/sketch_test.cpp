// A first look: the light of virtual lights at the vertices of a coarse mesh.
#include "raytrace/virtual_lights/sketch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <vector>

#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/raytrace/virtual_lights/integrator.h"

namespace lightwell::sketch_test {
namespace {

TEST(Sketch, HasTheFluxOfTheRoom) {
  const test::Integrator room;
  const LitScene lit{room.lit.scene, room.lit.caster, room.lit.direct_light};
  const RadiositySolution sketched = sketch(lit, VirtualLights(lit, {.count = 4096}));
  const BandArray E = element_mean(lit.mesh(), sketched.irradiance());
  double flux = 0.0, area = 0.0;
  for (int e = 0; e < lit.mesh().element_count(); ++e) {
    if (lit.mesh().is_back[lit.mesh().patch[e]] != 0) continue;
    flux += static_cast<double>(E.row(e).mean()) * lit.mesh().element_area[e];
    area += lit.mesh().element_area[e];
  }
  EXPECT_NEAR(area, 2.0 * (2.0 + 3.0 + 1.5), 1e-9);  // roundings of sums of a few hundred areas
  const double arriving = 4.0 * std::numbers::pi / (1.0 - test::Integrator::rho);
  std::printf("flux on walls %.4f W of %.4f W\n", flux, arriving);
  // 1229 paths leave 3.5 % of the reflected 70 % (see
  // VirtualLights.SendOnAllThatSurfacesReflect), twice which is allowed; elements of 10 cm miss
  // less than 1 % of the slopes of the lamp's light.
  EXPECT_NEAR(flux / arriving, 1.0, 0.06);
}

/// In a cell larger than the room all vertices of a wall have one indirect light; the direct light
/// of each stays its own.
TEST(Sketch, SharesIndirectLightWithinCells) {
  const test::Integrator room;
  const LitScene lit{room.lit.scene, room.lit.caster, room.lit.direct_light};
  const VirtualLights lights(lit, {.count = 500});
  const RadiositySolution sketched = sketch(lit, lights, 100.0);
  std::map<int, std::vector<float>> direct, indirect;  // by patch side of a wall
  const PatchMesh& mesh = lit.mesh();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int wall = 2 * mesh.facet[e] + (mesh.is_back[mesh.patch[e]] != 0 ? 1 : 0);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      direct[wall].push_back(sketched.direct_irradiance.row(mesh.corners[e][c]).mean());
      indirect[wall].push_back(sketched.indirect_irradiance.row(mesh.corners[e][c]).mean());
    }
  }
  int lit_walls = 0;
  for (const auto& [wall, E] : indirect) {
    const auto [least, most] = std::ranges::minmax(E);
    // Evening out equal values leaves the roundings of a weighted mean of a dozen floats, twice.
    EXPECT_NEAR(least, most, 2.0f * 2.0f * 12.0f * 0x1p-24f * most) << wall;
    if (!(most > 0.0f)) continue;
    ++lit_walls;
    EXPECT_LT(std::ranges::min(direct[wall]), 0.9f * std::ranges::max(direct[wall])) << wall;
  }
  EXPECT_EQ(lit_walls, 6);
}

/// A room with a black block.
Scene room_with_a_black_block() {
  return SceneBuilder()
      .box({.reflectance = 0.5f}, {0, 0, 0}, {2, 2, 2}, true)
      .box({}, {0.4, 0.4, 0.0}, {0.8, 0.8, 0.6}, false)
      .square({.exitance = 10.0f}, {1, 1, 1.99}, -Eigen::Vector3d::UnitZ(), 0.2)
      .build();
}

/// Light that nothing sends on takes no time.
TEST(Sketch, LeavesBlackSurfacesDark) {
  const SolvedScene sketched = sketch_scene(room_with_a_black_block());
  const PatchMesh& mesh = sketched.mesh;
  const BandArray E = element_mean(mesh, sketched.solution.irradiance());
  int black = 0, lit = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool is_black = !(mesh.reflectance.row(mesh.patch[e]) > 0.0f).any();
    if (is_black) {
      EXPECT_EQ(E.row(e).maxCoeff(), 0.0f) << e;
    }
    ++(is_black ? black : lit);
  }
  EXPECT_GT(black, 0);
  EXPECT_GT(lit, 0);
  EXPECT_GT(E.maxCoeff(), 0.0f);
}

TEST(Sketch, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = room_with_a_black_block();
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return sketch_scene(scene, {.virtual_lights = 200}).solution.irradiance();
  };
  EXPECT_TRUE((with(1) == with(3)).all());
}

TEST(Sketch, NamesItsSceneAndStopsWhenAsked) {
  const Scene scene = room_with_a_black_block();
  EXPECT_EQ(sketch_scene(scene).solution.provenance.scene_hash, scene_hash(scene));
  const auto stop = [](std::string_view phase, double) { return phase != "sketch"; };
  EXPECT_THROW(sketch_scene(scene, {.progress = stop}), Interrupted);
}

}  // namespace
}  // namespace lightwell::sketch_test
