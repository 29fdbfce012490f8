#include "raytrace/readings/read_error.h"

#include <gtest/gtest.h>

#include <vector>

#include "radiosity/gather/gap_exits.h"
#include "radiosity/solve.h"
#include "raytrace/readings/sure_gather.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::read_error_test {
namespace {

using namespace test;

// A room of 4 m x 3 m x 2.5 m with a luminous ceiling, and a board of 1 m x 1 m that lies 1 mm
// above the floor.
Scene room_with_board() {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f)),
            lamp = add_material(scene, diffuse(scene.bands, 0.5f, 10.0f));
  add_box(scene, {0, 0, 0}, {4, 3, 2.5}, {wall, wall, wall, wall, wall, lamp}, true);
  add_box(scene, {1, 1, 0.001}, {2, 2, 0.021}, {wall, wall, wall, wall, wall, wall}, false);
  return scene;
}

TEST(ReadErrors, InAGapHoldPathsThatNoRayMet) {
  const Scene scene = room_with_board();
  const SolvedScene solved = solve_scene(scene, {.gather = {.rays = 64}});
  const ElementCaster caster(solved.mesh);
  const DirectLight direct(scene, solved.mesh);
  const BandArray radiosity =
      gatherable_radiosity(solved.mesh, direct, solved.solution.irradiance());
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::vector<GatherPoint> points;
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(1.5, 1.5, 0.0), Eigen::Vector3d(3.2, 1.5, 0.0)}) {
    const Ray ray{.origin = at + 5e-4 * up, .direction = -up};
    ElementHit hit;
    caster.closest_elements({&ray, 1}, {&hit, 1});
    points.push_back({.position = at, .normal = up, .facet = hit.facet});
  }
  const LitScene lit{scene, caster, direct};
  const auto errors = [&](int rays) {
    return read_errors(lit, solved.solution, radiosity, points, rays);
  };
  // Fewer rays than exits of gaps are looked for with, so the paths of both are the same.
  const Eigen::ArrayXd of_missed = 2.0 * (errors(100) - errors(200));
  // Every ray begins in the gap. All surfaces absorb half of the light, so that the mean of rho E
  // is the power over the area: 12 m2 of 10 W/m2 over 59 m2 of the room and 2.08 m2 of the board.
  // The solve is good to 2 %.
  const double lumens = luminous(scene.bands, constant_spectrum(scene.bands, 1.0f));
  const double expected = 0.03 * lumens * 120.0 / 61.08;
  EXPECT_NEAR(of_missed[0], expected, 0.02 * expected);
  // The share falls as one over the rays.
  EXPECT_NEAR((errors(200) - errors(400))[0], 0.25 * of_missed[0], 1e-3 * of_missed[0]);
  // Nothing is missed in a gap whose exits are known. Half a metre inside a gap of 1 mm, which no
  // wall darkens further, light is some 10^-5 of the room's, and its error no more.
  EXPECT_LT(errors(rays_over_set * GapExits::fewest_rays)[0], 1e-3 * expected);
  EXPECT_EQ(of_missed[1], 0.0) << "in the open nothing is added";
}

}  // namespace
}  // namespace lightwell::read_error_test
