#include "viewer/export/baked_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/shared_floor.h"
#include "viewer/export/appearance.h"

namespace lightwell::baked_model_test {
namespace {

TEST(BakedModel, OfTwoSidesOneWithoutLightIsLeftOut) {
  const BakedModel back_dark = bake_model(square_of_two_sides(white, dark), {});
  ASSERT_EQ(back_dark.parts.size(), 1u);
  EXPECT_FALSE(back_dark.parts[0].is_back);
  EXPECT_EQ(back_dark.black_behind, std::vector<std::uint8_t>{1});
  EXPECT_EQ(back_dark.vertex_count(), 4);

  const BakedModel front_dark = bake_model(square_of_two_sides(dark, white), {});
  ASSERT_EQ(front_dark.parts.size(), 1u);
  EXPECT_TRUE(front_dark.parts[0].is_back);
}

TEST(BakedModel, TwoLitSidesAreBothThere) {
  const BakedModel model = bake_model(square_of_two_sides(white, red), {});
  ASSERT_EQ(model.parts.size(), 2u);
  EXPECT_EQ(model.black_behind, (std::vector<std::uint8_t>{0, 0}));
  EXPECT_FALSE(model.parts[0].is_back);
  EXPECT_TRUE(model.parts[1].is_back);
  EXPECT_EQ(model.parts[0].name, "surface 0");
  EXPECT_EQ(model.parts[1].first_vertex, 4);
  EXPECT_EQ(model.parts[1].vertex_count, 4);
}

/// The dark floor of a lit room stays in the model.
TEST(BakedModel, OfTwoDarkSidesTheFrontStays) {
  const BakedModel model = bake_model(square_of_two_sides(dark, dark), {});
  ASSERT_EQ(model.parts.size(), 1u);
  EXPECT_FALSE(model.parts[0].is_back);
  EXPECT_EQ(model.black_behind, std::vector<std::uint8_t>{1});
}

TEST(BakedModel, ASharedPolygonIsPartedByNameAgain) {
  const SharedFloor floor;
  ASSERT_TRUE(floor.names);
  EXPECT_EQ(bake_model(floor.solved, floor.scene).parts.size(), 2u);
  const BakedModel model = bake_model(floor.solved, floor.scene, 0.0, floor.names.get());
  ASSERT_EQ(model.parts.size(), 3u);
  for (const BakedPart& part : model.parts) {
    EXPECT_EQ(model.materials[part.material].name, part.name + " paint");
    if (part.name == "lamp") continue;
    for (int v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      // Elements are 0.25 long, so the border at x = 1 lies on element edges.
      EXPECT_TRUE(part.name == "left" ? model.position[v].x() <= 1.0
                                      : model.position[v].x() >= 1.0);
    }
  }
}

TEST(BakedModel, NamesMaterialsAndCamerasComeFromTheScene) {
  Scene scene = box_scene();
  scene.materials[0].dielectric = Dielectric{.tint = Spectrum::Ones(3)};
  scene.materials[1].specular = Spectrum::Constant(3, 0.5f);
  const BakedModel model = bake_model(solved_box(), scene);
  ASSERT_EQ(model.parts.size(), 5u);
  EXPECT_EQ(model.parts[2].name, "wall");
  EXPECT_EQ(model.materials[model.parts[2].material].name, "wall paint");
  EXPECT_TRUE(model.materials[model.parts[0].material].is_glass);
  EXPECT_TRUE(model.materials[model.parts[1].material].is_mirror);
  EXPECT_TRUE(model.cameras_are_given);
  ASSERT_EQ(model.cameras.size(), 1u);
  EXPECT_EQ(model.cameras[0].camera.name, "front");
}

/// Reflectance is 1 and nothing emits: B = E, L = E / pi, and 683 lm/W make lux of W/m^2.
TEST(BakedModel, VerticesCarryTheSolutionsLight) {
  const BakedModel model = bake_model(solved_box(), box_scene());
  const BakedPart& wall = model.parts[3];
  for (int v = wall.first_vertex; v < wall.first_vertex + wall.vertex_count; ++v) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(model.radiosity(v, k), grey[k]);
      EXPECT_EQ(model.irradiance(v, k), grey[k]);
      EXPECT_FLOAT_EQ(model.radiance(v, k), grey[k] / std::numbers::pi_v<float>);
    }
    // The luminance weights add up to 1.
    EXPECT_NEAR(model.illuminance[v], 683.0f, 683.0f * 1e-6f);
  }
}

/// A stop doubles the exposure of every camera.
TEST(BakedModel, ExposureIsThatOfThePictureFromTheCamera) {
  const SolvedScene box = solved_box();
  const Scene scene = box_scene();
  const std::vector<ElementKind> kinds = element_kinds(box, scene.materials);
  const BandArray radiance = shown_radiance(box, scene.materials);
  const double scale =
      metered_scale(ElementCaster(box.mesh), kinds, {box.solution.irradiance(), radiance},
                    rgb_bands(), scene.cameras[0]);
  EXPECT_DOUBLE_EQ(bake_model(box, scene).cameras[0].scale, scale);
  EXPECT_DOUBLE_EQ(bake_model(box, scene, 1.0).cameras[0].scale, 2.0 * scale);
}

/// Corners 1 and 3 are alike, 0 and 2 are not: the crease goes from 1 to 3.
TEST(BakedModel, QuadsAreSplitAlongTheDiagonalThatDiffersLess) {
  SolvedQuads quads;
  quads.add({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {white, grey, dark, grey});
  const BakedModel model = bake_model(quads.solved(), {});
  const auto triangles = triangles_of(model, 0, 1);
  ASSERT_EQ(triangles.size(), 2u);
  const auto shared = [&](const Eigen::Vector3d& p) {
    int count = 0;
    for (const auto& triangle : triangles) {
      for (const int v : triangle) count += model.position[v] == p;
    }
    return count == 2;
  };
  EXPECT_TRUE(shared({1, 0, 0}));
  EXPECT_TRUE(shared({0, 1, 0}));
  EXPECT_FALSE(shared({0, 0, 0}));
}

TEST(BakedModel, UpwardsBecomesY) {
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 1, 0),
                                    Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(-1, 0, 0)}) {
    Scene scene = box_scene();
    scene.cameras[0].up = up;
    scene.cameras[0].direction = up.unitOrthogonal();
    const Eigen::Matrix3d turn = bake_model(solved_box(), scene).to_y_up;
    EXPECT_EQ(turn * up, Eigen::Vector3d::UnitY()) << up.transpose();
    EXPECT_EQ(turn * turn.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(turn.determinant(), 1.0);  // no mirror image
  }
  // z up is turned so that x stays, as programs that convert to glTF do.
  Scene scene = box_scene();
  scene.cameras[0].up = Eigen::Vector3d::UnitZ();
  scene.cameras[0].direction = Eigen::Vector3d::UnitY();
  EXPECT_EQ(bake_model(solved_box(), scene).to_y_up * Eigen::Vector3d(1, 2, 3),
            Eigen::Vector3d(1, 3, -2));
}

TEST(BakedModel, TwoBandsWithoutWavelengthsHaveNoColor) {
  SolvedScene box = solved_box();
  box.solution.bands.names = {"a", "b"};
  EXPECT_TRUE(says(message_of<InputError>([&] { bake_model(box, {}); }), "has no colour"));
}

TEST(BakedModel, ASceneOfFewerSurfacesIsNotTheOne) {
  Scene scene = box_scene();
  scene.surfaces.pop_back();
  EXPECT_TRUE(says(message_of<InputError>([&] { bake_model(solved_box(), scene); }), "4 surfaces"));
}

/// NaN and infinity, which a damaged solution may hold and glTF must not.
TEST(BakedModel, WhatIsNoNumberShowsBlack) {
  SolvedScene box = solved_box();
  box.solution.direct_irradiance(0, 1) = std::numeric_limits<float>::quiet_NaN();
  const BakedModel model = bake_model(box, box_scene());
  EXPECT_TRUE(model.radiance.allFinite());
  for (const float lux : model.illuminance) EXPECT_TRUE(std::isfinite(lux));
}

}  // namespace
}  // namespace lightwell::baked_model_test
