// Sky and ground around the scene, for windows and pages.
#include "viewer/export/sky_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/viewer/lit_sides.h"
#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell::sky_grid_test {
namespace {

/// The CIE overcast sky above ground.
Sky graded_sky() {
  return {.name = "graded",
          .up = Eigen::Vector3d::UnitY(),
          .north = Eigen::Vector3d::UnitZ(),
          .kind = SkyKind::overcast,
          .scale = Eigen::Array3f(1.0f, 2.0f, 4.0f),
          .ground = Eigen::Array3f(0.5f, 0.4f, 0.3f)};
}

/// L = L_z (1 + 2 cos Z) / 3: L_z at the zenith, L_z / 3 at the horizon.
TEST(SkyGrid, HasTheSkyOnItsRowsAndASharpHorizon) {
  const Sky sky = graded_sky();
  const SkyGrid grid = sky_grid(sky, 65);
  ASSERT_EQ(grid.rows_above, 16);
  ASSERT_EQ(grid.rows_below, 2);
  ASSERT_EQ(grid.radiance.rows(), 18 * 65);
  const auto row = [&](int r) -> Eigen::Array3f { return grid.radiance.row(r * 65).transpose(); };
  const Eigen::Array3f zenith = sky.scale;
  EXPECT_TRUE(((row(0) - zenith).abs() < 1e-6f * zenith).all());
  EXPECT_TRUE(((row(15) - zenith / 3.0f).abs() < 1e-5f * zenith).all());
  for (const int below : {16, 17}) {
    EXPECT_TRUE((row(below) == Eigen::Array3f(sky.ground)).all()) << below;
  }
  EXPECT_DOUBLE_EQ(row_altitude(grid, 0), 90.0);
  EXPECT_DOUBLE_EQ(row_altitude(grid, 15), 0.0);
  EXPECT_DOUBLE_EQ(row_altitude(grid, 16), 0.0);
  EXPECT_DOUBLE_EQ(row_altitude(grid, 17), -90.0);
  EXPECT_TRUE((grid.radiance.row(3 * 65) == grid.radiance.row(3 * 65 + 64)).all()) << "both north";
}

/// The channels of sky and sun scale their visible radiance; that of the lamp precedes both.
TEST(SkyInForce, IsAsBrightAsTheSolutionHasIt) {
  Scene scene = box_scene();
  scene.sky = graded_sky();
  scene.sky->sun = Sun{.irradiance = Eigen::Array3f(8.0f, 8.0f, 8.0f)};
  scene.lamps.push_back({.name = "bulb", .intensity = Spectrum::Ones(3)});
  SolvedScene box = solved_box();
  EXPECT_EQ(sky_hash(*effective_sky(scene, box.mesh)), sky_hash(*scene.sky));
  box.mesh.source_scale = BandArray(3, 3);
  box.mesh.source_scale << 9, 9, 9, 0.5f, 1, 2, 0.25f, 0.25f, 0.25f;
  const Sky dimmed = *effective_sky(scene, box.mesh);
  EXPECT_TRUE((dimmed.scale == Eigen::Array3f(0.5f, 2.0f, 8.0f)).all());
  EXPECT_TRUE((dimmed.ground == Eigen::Array3f(0.25f, 0.4f, 0.6f)).all());
  EXPECT_TRUE((dimmed.sun->irradiance == 2.0f).all());
  scene.sky.reset();
  EXPECT_FALSE(effective_sky(scene, box.mesh).has_value());
}

/// A ray that misses the scene shows the sky, which counts for the exposure.
TEST(SkyInForce, IsInTheCoarsePicture) {
  const SolvedScene box = solved_box();
  const ElementCaster caster(box.mesh);
  const auto kinds = element_kinds(box, {});
  const BandArray L = shown_radiance(box, {});
  Camera away = box_camera();
  away.direction = {0, 0.6, -0.8};  // Z = 53.13 degrees: (1 + 1.2) / 3
  away.up = {0, 0.8, 0.6};
  const Sky sky = graded_sky();
  const Image seen = coarse_picture(caster, kinds, L, away, 1, &sky);
  EXPECT_TRUE(((seen.radiance.row(0).transpose() - 2.2f / 3.0f * sky.scale).abs() < 1e-5f).all());
  EXPECT_EQ(coarse_picture(caster, kinds, L, away, 1).radiance.maxCoeff(), 0.0f);
}

TEST(BakedSky, TellsChannelsAndAxes) {
  Scene scene = box_scene();
  scene.sky = graded_sky();
  const BakedModel model = bake_model(solved_box(), scene);
  ASSERT_TRUE(model.sky.has_value());
  EXPECT_EQ(model.sky->channel, -1);
  EXPECT_FALSE(model.sky->sun.has_value());
  EXPECT_EQ(model.sky->radiance.rows(),
            model.sky->columns * (model.sky->rows_above + model.sky->rows_below));
  // North is +z and up +y, so that east is -x.
  EXPECT_NEAR((model.sky->axes.col(1) - Eigen::Vector3d(-1, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_FALSE(bake_model(solved_box(), box_scene()).sky.has_value());
}

}  // namespace
}  // namespace lightwell::sky_grid_test
