#include "daylight/daylight_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "daylight/sky_year.h"
#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::daylight_model_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

DaylightOptions few_patches() {
  DaylightOptions options;
  options.sky_subdivision = 2;
  options.mesh.auto_patch_count = 400;
  return options;
}

Eigen::ArrayXXf coefficients(const Scene& scene, const DaylightOptions& options = few_patches()) {
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), options);
  model.set_sensors(test::desks());
  return model.sky_coefficients().sum();
}

}  // namespace

// The furnace: surfaces that reflect all light, in a world of luminance 1 all around, have that
// luminance too, so that every sensor gets pi. A ray ends on a surface or leaves, each with the
// same radiance; what is left is that the share of rays through the window is found twice, by the
// view of the dome and by the gather's 4096 rays: sqrt(s (1 - s) / 4096) for a share s of up to 0.2
// is 0.6 %, less by stratification; two of these.
TEST(DaylightModel, WhiteRoomInAWhiteWorldIsAsBrightAsTheWorld) {
  const Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 1.0f));
  DaylightOptions options = few_patches();
  options.tolerance = 1e-6;
  const Eigen::ArrayXXf D = coefficients(room, options);
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    EXPECT_NEAR(double{D.row(i).sum()}, pi, 0.012 * pi) << "sensor " << i;
  }
}

TEST(DaylightModel, ClosedRoomIsBlack) {
  Scene room;
  const int rho = test::add_material(room, test::diffuse(room.bands, 0.5f));
  test::add_box(room, {0.0, 0.0, 0.0}, {4.0, 3.0, 2.5}, {rho, rho, rho, rho, rho, rho}, true);
  EXPECT_EQ(coefficients(room).sum(), 0.0f);
}

// The sum over patches under one sky is what a solve under that sky finds, by rows, gathers and
// views of the sky of its own.
TEST(DaylightModel, SumOfPatchesIsTheSolveUnderTheSky) {
  Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  const Eigen::ArrayXXf D = coefficients(room);
  const SkyPatches patches(2, Vector3d::UnitZ(), Vector3d::UnitY());
  const Eigen::ArrayXf by_patches =
      (D.matrix() * overcast_luminances(patches, 0.2).matrix()).array();
  // The overcast sky of 1 W/m^2 per band on open ground.
  Sky sky{.up = Vector3d::UnitZ(), .north = Vector3d::UnitY(), .kind = SkyKind::overcast};
  sky.scale = constant_spectrum(room.bands, static_cast<float>(9.0 / (7.0 * pi)));
  sky.ground = constant_spectrum(room.bands, static_cast<float>(0.2 / pi));
  room.sky = sky;
  SolveOptions options = options_for_probes();
  options.mesh.auto_patch_count = 1600;
  const SolvedScene solved = solve_scene(room, options);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(room, solved.mesh);
  std::vector<Probe> probes;
  for (const GatherPoint& desk : test::desks()) probes.push_back({desk.position, desk.normal});
  ProbeBounds bounds;
  const BandArray E = probe_irradiance(room, caster, direct_light, solved.solution, probes,
                                       {.rays = 1024}, &bounds);
  for (Eigen::Index i = 0; i < E.rows(); ++i) {
    // Patches of 0.4 m change the light at the desks by up to a hundredth (four times as many
    // change it by 0.7 %), and each of the two gathers has 1024 rays, with noise below half a
    // percent.
    EXPECT_NEAR(double{by_patches[i]}, double{E(i, 1)}, 0.02 * double{E(i, 1)}) << "sensor " << i;
  }
}

// Grey scenes are computed in one band. Light of a scene that is grey but for a speck in a corner
// is nearly the same, and is computed in three.
TEST(DaylightModel, OneBandGivesWhatThreeDo) {
  Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  const Eigen::ArrayXXf grey = coefficients(room);
  Material red = test::diffuse(room.bands, 0.5f);
  red.reflectance[0] = 0.6f;
  test::add_polygon(room, "speck", test::add_material(room, red),
                    {{3.9, 2.99, 0.01}, {3.91, 2.99, 0.01}, {3.91, 2.98, 0.01}, {3.9, 2.98, 0.01}});
  const Eigen::ArrayXXf coloured = coefficients(room);
  // Other patches have other rays: patches and noise as above.
  for (Eigen::Index i = 0; i < grey.rows(); ++i) {
    EXPECT_NEAR(double{coloured.row(i).sum()}, double{grey.row(i).sum()},
                0.02 * double{grey.row(i).sum()});
  }
}

// Reflected light by the importance of patches is that by a solve for each source, with the same
// rays of the sensors: no patch is so bright that gathers would aim at it. A radiosity that is
// solved for errs by at most 1e-6 / (1 - rho) of the largest in its column, and so does a
// gather, which is a mean of radiosities; importance is solved for a thousand times as exactly.
// Four errors of sums of 400 floats, 4 sqrt(400) 6e-8, come on top.
TEST(DaylightModel, ImportanceGivesTheLightOfColumns) {
  Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  room.materials[0].reflectance[0] = 0.6f;
  const DaylightModel model(room, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  const std::vector<GatherPoint> desks = test::desks();
  constexpr Eigen::Index bands = 3;
  constexpr int sources = 5, rays = 64;
  BandArray E0 = BandArray::Zero(model.mesh().patch_count(), sources * bands);
  for (Eigen::Index p = 0; p < E0.rows(); ++p) {
    E0.row(p).segment(p % sources * bands, bands) = static_cast<float>(1 + p % 7);
  }
  const BandArray by_importance = reflected_by_importance(model.importance(desks, rays), E0, bands);
  const BandArray B = model.radiosity(E0), by_columns = model.gather(B, desks, rays);
  ASSERT_EQ(by_importance.rows(), std::ssize(desks));
  EXPECT_GT(by_columns.minCoeff(), 0.0f);
  const double rho = 0.6, share = model.options().tolerance / (1.0 - rho);
  for (Eigen::Index c = 0; c < B.cols(); ++c) {
    for (Eigen::Index i = 0; i < by_columns.rows(); ++i) {
      const auto E = double{by_columns(i, c)};
      const double within = share * double{B.col(c).maxCoeff()} + 4.0 * std::sqrt(400.0) * 6e-8 * E;
      EXPECT_NEAR(double{by_importance(i, c)}, E, within) << "desk " << i << ", column " << c;
    }
  }
}

TEST(DaylightModel, SunIsDirectAndReflected) {
  const Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  DaylightModel model(room, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  model.set_sensors(test::desks());
  // Suns 45 degrees high: the southern one reaches the first desk alone, the northern one none.
  const std::vector<SunDisc> suns = {{model.sky(), Vector3d(0.0, -1.0, 1.0).normalized()},
                                     {model.sky(), Vector3d(0.0, 1.0, 1.0).normalized()}};
  const SensorLight light = model.sun_coefficients(suns);
  // Cosines vary over the disc by half its radius, 0.0047, times sin 45; four errors of 16 rays.
  EXPECT_NEAR(double{light.direct(0, 0)}, std::sqrt(0.5), 4.0 * 0.5 * 0.0047 * 0.71 / 4.0);
  EXPECT_EQ(light.direct(2, 0), 0.0f);
  EXPECT_EQ(light.direct(0, 1), 0.0f);
  EXPECT_GT(light.reflected(2, 0), 0.0f);
  // The flux that comes in, 2 m x 1 m x cos 45, is reflected rho + rho^2 + ... = 1 times over;
  // spread over the surfaces, 59 m^2, that is 0.024 in the mean, and no desk has five times as
  // much.
  EXPECT_LT(light.reflected.maxCoeff(), 5.0f * 0.024f);
  // Nothing comes in from the north, where the wall has no window.
  EXPECT_EQ(light.reflected.col(1).maxCoeff(), 0.0f);
}

}  // namespace lightwell::daylight_model_test
