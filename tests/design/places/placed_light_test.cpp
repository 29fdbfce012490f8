#include "design/places/placed_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/readings/cylinder.h"
#include "raytrace/readings/glare.h"
#include "raytrace/readings/probe.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::placed_light_test {
namespace {

constexpr float reflectance = 0.6f;

/// A room of 5 m x 4 m x 3 m, all of whose surfaces reflect, with two lamps: a measured
/// distribution with an opening, and a point.
Scene room_with_lamps(float rho = reflectance) {
  SceneBuilder builder;
  builder.box({.reflectance = rho, .one_sided = true}, {0, 0, 0}, {5, 4, 3}, true);
  Scene scene = builder.build();
  Eigen::ArrayXXd values(4, 4);
  values << 400, 300, 150, 0, 400, 320, 200, 0, 400, 250, 120, 0, 400, 280, 180, 0;
  const auto web = std::make_shared<const PhotometricWeb>(
      std::vector<double>{0, 90, 180, 270}, std::vector<double>{0, 30, 60, 90}, values);
  scene.lamps = {{.name = "panel",
                  .position = {1.6, 1.3, 2.6},
                  .axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
                  .intensity = constant_spectrum(scene.bands, 1.0f / 683.0f),
                  .shape = web,
                  .opening = {.along_c0 = 0.6, .along_c90 = 0.3}},
                 {.name = "bulb",
                  .position = {3.4, 2.7, 2.1},
                  .intensity = constant_spectrum(scene.bands, 80.0f / 683.0f)}};
  return scene;
}

/// A black room full of water that absorbs and does not bend light, in two bodies with a narrow gap
/// between them beside a wall: no way from a lamp to a point crosses the gap, since light by way of
/// bodies is none that places are searched by.
Scene room_full_of_water() {
  Scene scene = room_with_lamps(0.0f);
  const Paint water{.index_of_refraction = 1.0f, .absorption = 0.3f};
  const Eigen::Vector3d middle(2.5, 0.1, 1.5), y = Eigen::Vector3d::UnitY();
  Scene surfaces = SceneBuilder()
                       .square(water, middle - 0.001 * y, y, 0.9)
                       .square(water, middle + 0.001 * y, -y, 0.9)
                       .build();
  for (Surface& surface : surfaces.surfaces) {
    surface.material = static_cast<int>(scene.materials.size());
    scene.surfaces.push_back(surface);
  }
  scene.materials.push_back(surfaces.materials[0]);
  return scene;
}

/// Nine points 0.8 m above the floor.
LuxGrid plane() {
  LuxGrid grid{.name = "plane", .columns = 3, .rows = 3};
  for (int i = 0; i < 9; ++i) {
    grid.points.push_back({.position = {1.0 + 1.4 * (i % 3), 0.8 + 1.2 * (i / 3), 0.8}});
  }
  return grid;
}

constexpr int both[] = {0, 1};

PlacedLightOptions coarse() {
  PlacedLightOptions options;
  options.mesh.max_patch_size = 0.5;
  return options;
}

/// dE/dx beside central differences of E, with the same random numbers, in a room where two thirds
/// of the light of some points is reflected. E is a float: 6e-8 of some 100 lx over 2 h = 0.02 m is
/// 3e-4 lx/m beside slopes of 50 lx/m. E changes over 2 m, so that h^2 / 6 of its third derivative
/// is 1e-5 of the slope.
void expect_slopes_of_central_differences(const Scene& scene) {
  const PlacedLight light(scene, both, {.grids = {plane()}}, {}, coarse());
  Eigen::Matrix3Xd places(3, 2);
  places << scene.lamps[0].position, scene.lamps[1].position;
  const PlacedReadings here = light.at(places);
  constexpr double h = 0.01;
  for (int lamp = 0; lamp < 2; ++lamp) {
    double largest = 0.0;
    for (const Eigen::MatrixXd& slope : here.lux.slope) {
      largest = std::max(largest, slope.col(lamp).cwiseAbs().maxCoeff());
    }
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix3Xd forth = places, back = places;
      forth(axis, lamp) += h;
      back(axis, lamp) -= h;
      const Eigen::VectorXd difference =
          (light.at(forth).lux.value - light.at(back).lux.value).col(lamp) / (2.0 * h);
      const Eigen::VectorXd slope = here.lux.slope[static_cast<std::size_t>(axis)].col(lamp);
      EXPECT_LE((slope - difference).cwiseAbs().maxCoeff(), 1e-3 * largest)
          << "lamp " << lamp << ", axis " << axis;
    }
  }
}

TEST(PlacedLight, SlopesAreThoseOfCentralDifferences) {
  expect_slopes_of_central_differences(room_with_lamps());
}

TEST(PlacedLight, SlopesWithinWaterAreThoseOfCentralDifferences) {
  expect_slopes_of_central_differences(room_full_of_water());
}

/// The light of a lamp is that of a solve of the scene, which shares no mesh, no form factors and
/// no random numbers with it.
void expect_lux_of_a_solve(const Scene& scene) {
  const PlacedLight light(scene, both, {.grids = {plane()}}, {}, coarse());
  Eigen::Matrix3Xd places(3, 2);
  places << scene.lamps[0].position, scene.lamps[1].position;
  const PlacedReadings here = light.at(places);
  for (std::size_t lamp = 0; lamp < 2; ++lamp) {
    Scene alone = scene;
    alone.lamps = {scene.lamps[lamp]};
    const SolvedScene solved = solve_scene(alone, options_for_probes());
    const ElementCaster caster(solved.mesh);
    const DirectLight lights(alone, solved.mesh);
    const LuxField field =
        measure_grid(alone, caster, lights, solved.solution, plane(), 1.0, {.rays = 1024});
    const Eigen::VectorXd lux = here.lux.value.col(static_cast<Eigen::Index>(lamp));
    // Both have errors of their own, for which the bound of the one is taken.
    for (Eigen::Index p = 0; p < lux.size(); ++p) {
      EXPECT_NEAR(lux[p], field.lux[p], 2.0 * field.lux_within[p]) << "point " << p;
    }
    EXPECT_NEAR(lux.mean(), field.mean, 0.01 * field.mean);
  }
}

TEST(PlacedLight, LuxIsThatOfASolve) {
  expect_lux_of_a_solve(room_with_lamps());
}

TEST(PlacedLight, LuxWithinWaterIsDimmedByTheWay) {
  const Scene scene = room_full_of_water();
  const PlacedLight light(scene, std::span(both).last(1), {.grids = {plane()}}, {}, coarse());
  const Eigen::Vector3d bulb = scene.lamps[1].position;
  const PlacedReadings here = light.at(bulb);
  const LuxGrid grid = plane();
  for (std::size_t p = 0; p < grid.points.size(); ++p) {
    const Eigen::Vector3d to = bulb - grid.points[p].position;
    const double r = to.norm(), candela = 80.0, absorption = 0.3;
    const double expected = candela * to.z() / (r * r * r) * std::exp(-absorption * r);
    // Floats, and the first millimetre before the lamp, where rays of light begin.
    EXPECT_NEAR(here.lux.value(static_cast<Eigen::Index>(p), 0), expected,
                expected * (std::ldexp(32.0, -24) + 1e-3 * absorption));
  }
}

/// The parts of UGR for an eye are those of a rating of the solved scene: the glare by the same
/// sum, the background, a tenth of whose light comes from a patch at most, by other rays.
TEST(PlacedLight, GlareIsThatOfARating) {
  Scene scene = room_with_lamps();
  scene.lamps.pop_back();
  // Central differences would round the kinks of a table.
  scene.lamps[0].shape = EvenIntensity{};
  scene.lamps[0].intensity *= 200.0f;
  const Camera eye{.name = "seat",
                   .position = {4.2, 2.0, 1.2},
                   .direction = -Eigen::Vector3d::UnitX(),
                   .up = Eigen::Vector3d::UnitZ()};
  const PlacedLight light(scene, std::span(both, 1), {.eyes = {eye}}, {}, coarse());
  const PlacedReadings here = light.at(scene.lamps[0].position);
  const SolvedScene solved = solve_scene(scene, options_for_probes());
  const ElementCaster caster(solved.mesh);
  const DirectLight lights(scene, solved.mesh);
  const Glare glare =
      unified_glare_rating(scene, caster, lights, solved.solution, eye, {.rays = 1 << 14});
  ASSERT_EQ(glare.sources.size(), 1u);
  EXPECT_FLOAT_EQ(static_cast<float>(here.glare.value(0, 0)),
                  static_cast<float>(glare.sources[0].share));
  EXPECT_NEAR(here.background.value(0, 0), glare.background, 0.02 * glare.background);
  // All of the opening is in sight. The lamp is 2.6 m away along x, over which its share changes by
  // a power: differences over 0.15 m and over 0.02 m are (0.075 / 2.6)^2, 1e-3, of some slopes
  // apart.
  const auto glare_at = [&](double x) {
    return light.at(scene.lamps[0].position + x * Eigen::Vector3d::UnitX()).glare.value(0, 0);
  };
  const double glare_slope = (glare_at(0.01) - glare_at(-0.01)) / 0.02;
  EXPECT_NEAR(here.glare.slope[0](0, 0), glare_slope, 0.02 * std::abs(glare_slope));
  Eigen::Vector3d slope, difference;
  constexpr double h = 0.01;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
    const auto background = [&](const Eigen::Vector3d& place) {
      return light.at(place).background.value(0, 0);
    };
    slope[axis] = here.background.slope[static_cast<std::size_t>(axis)](0, 0);
    difference[axis] =
        (background(scene.lamps[0].position + step) - background(scene.lamps[0].position - step)) /
        (2.0 * h);
  }
  EXPECT_LE((slope - difference).cwiseAbs().maxCoeff(), 1e-3 * difference.cwiseAbs().maxCoeff());
}

/// A reading of a cylinder is the mean of its planes.
TEST(PlacedLight, CylindersAreMeansOfPlanes) {
  const Scene scene = room_with_lamps();
  LuxGrid cylinder{.name = "faces", .quantity = GridQuantity::cylindrical, .columns = 1, .rows = 1};
  cylinder.points = {{.position = {2.5, 2.0, 1.2}}};
  LuxGrid planes{.name = "planes", .columns = planes_of_a_cylinder, .rows = 1};
  planes.points = cylinder_probes(cylinder, cylinder.points[0].position);
  PlacedLightOptions effort = coarse();
  effort.gather_rays = 4096;
  const PlacedLight light(scene, both, {.grids = {cylinder, planes}}, {}, effort);
  Eigen::Matrix3Xd places(3, 2);
  places << scene.lamps[0].position, scene.lamps[1].position;
  const Eigen::MatrixXd lux = light.at(places).lux.value;
  ASSERT_EQ(lux.rows(), 1 + planes_of_a_cylinder);
  // Planes of their own have other random numbers: about 1 % of each reading over the root of 25.
  for (Eigen::Index lamp = 0; lamp < 2; ++lamp) {
    const double mean = lux.col(lamp).tail(planes_of_a_cylinder).mean();
    EXPECT_NEAR(lux(0, lamp), mean, 0.01 * mean);
  }
}

}  // namespace
}  // namespace lightwell::placed_light_test
