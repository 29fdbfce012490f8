#include "viewer/export/drawn_pictures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/facet_textures.h"
#include "tests/viewer/pictured_wall.h"
#include "viewer/export/baked_model.h"

namespace lightwell::drawn_pictures_test {
namespace {

float linear(std::uint8_t srgb) {
  const float v = static_cast<float>(srgb) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

// Half a step of 8-bit sRGB at its steepest slope, relative to white.
constexpr float byte_rounding = 0.005f;

TEST(DrawnPictures, TexelsTimesTheBrightestAreReflectances) {
  const PicturedBox box;
  const DrawnPictures drawn(box.scene, 1024);
  ASSERT_EQ(drawn.all().size(), 1u);
  const DrawnPicture& picture = drawn.all()[0];
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 1);
  EXPECT_FALSE(picture.has_holes);
  EXPECT_FALSE(picture.is_smooth);
  EXPECT_EQ(picture.rgba[0], 255) << "all of the range is used";
  EXPECT_NEAR(linear(picture.rgba[0]) * picture.brightest[1], bright_half, byte_rounding);
  EXPECT_NEAR(linear(picture.rgba[4]) * picture.brightest[1], dark_half, byte_rounding);
  EXPECT_EQ(drawn.of(0), 0);
  EXPECT_EQ(drawn.of(-1), -1);
  EXPECT_EQ(drawn.of(1), -1) << "the scene has no such facet";
  const Eigen::Vector2f place = drawn.place(0, {1.5, 0.5, 2.0});
  EXPECT_FLOAT_EQ(place.x(), 0.25f);
  EXPECT_FLOAT_EQ(place.y(), 0.25f);
}

// The mean of the gains times the texels is 1, so that a facet keeps its power.
TEST(DrawnPictures, TexelsTimesTheBrightestAreTheEmissionOfAFacetThatShines) {
  PicturedBox box;
  put_light(box.scene, 2, picture_of(2, 1, {0.8f, 0.2f}), 5.0f);
  PatchMesh& mesh = box.solved.mesh;
  mesh.material[2] = box.scene.surfaces[2].material;
  mesh.emission.row(2).setConstant(2.5f);
  mesh.element_area = Eigen::ArrayXd::Constant(mesh.element_count(), 4.0);
  mesh.textures = std::make_shared<const FacetTextures>(box.scene);
  const DrawnPictures drawn(box.scene, 1024);
  const DrawnPicture& picture = drawn.all().at(0);
  EXPECT_NEAR(linear(picture.rgba[0]) * picture.brightest[1], 4.0f, 4.0f * byte_rounding);
  EXPECT_NEAR(linear(picture.rgba[4]) * picture.brightest[1], 1.0f, 4.0f * byte_rounding);
  const float gain = picture_gains(mesh, drawn)(mesh.corners[2][0], 1);
  const float mean = 0.5f * (linear(picture.rgba[0]) + linear(picture.rgba[4]));
  EXPECT_NEAR(gain * mean, 1.0f, byte_rounding / mean);
}

TEST(DrawnPictures, HolesAreTransparentWhereverTheMaskLies) {
  PicturedBox box;
  Material& material = box.scene.materials.back();
  // The mask is turned by 180 degrees against the picture; dark texels of the mask are holes.
  SurfaceTexture holes = picture_of(2, 1, {1.0f, 0.0f});
  holes.placement << -1, 0, 1, 0, -1, 1;
  material.mask = Mask{.image = holes};
  const DrawnPicture picture = DrawnPictures(box.scene, 1024).all().at(0);
  EXPECT_TRUE(picture.has_holes);
  EXPECT_EQ(picture.rgba[3], 0);
  EXPECT_EQ(picture.rgba[7], 255);
  material.texture.reset();
  const DrawnPicture mask_alone = DrawnPictures(box.scene, 1024).all().at(0);
  EXPECT_EQ(mask_alone.rgba[0], 255) << "white, over the plain reflectance";
  EXPECT_FLOAT_EQ(mask_alone.brightest[0], material.reflectance[0]);
}

TEST(DrawnPictures, LargeOnesAreHalved) {
  PicturedBox box;
  std::vector<float> shares;
  for (int i = 0; i < 64 * 16; ++i) shares.push_back(i % 2 == 0 ? 0.2f : 0.6f);
  box.scene.materials.back().texture->image = picture_of(64, 16, shares);
  const DrawnPicture picture = DrawnPictures(box.scene, 16).all().at(0);
  EXPECT_EQ(picture.width, 16);
  EXPECT_EQ(picture.height, 4);
  EXPECT_NEAR(linear(picture.rgba[0]) * picture.brightest[0], 0.4f, byte_rounding);
}

/// The mean of a patch's texels is the patch's radiosity.
TEST(DrawnPictures, AModelWithThemHasTheSameLight) {
  const PicturedBox box;
  const BakedModel model = bake_model(box.solved, box.scene);
  ASSERT_EQ(model.pictures.size(), 1u);
  const DrawnPicture& picture = model.pictures[0];
  const float mean = 0.5f * (linear(picture.rgba[0]) + linear(picture.rgba[4]));
  int pictured = 0;
  for (const BakedPart& part : model.parts) {
    pictured += part.picture >= 0 ? 1 : 0;
    for (int v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      const float gain = model.picture_gain(v, 1);
      EXPECT_NEAR(part.picture >= 0 ? gain * mean : gain, 1.0f, byte_rounding / mean);
    }
  }
  EXPECT_EQ(pictured, 1);
}

/// A vertex between two texture maps that do not continue each other has two texture coordinates.
TEST(DrawnPictures, VerticesAreNotSharedAcrossMaps) {
  SolvedQuads quads;
  quads.add({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, grey);
  quads.add({{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}}, grey);
  SolvedScene solved = quads.solved();
  solved.mesh.corners[1] = {1, 4, 5, 2};
  solved.mesh.surface = {0, 0};
  solved.mesh.material = {0, 0};
  Scene scene;
  scene.materials.push_back({.name = "tiles",
                             .reflectance = Spectrum::Ones(3),
                             .specular = Spectrum::Zero(3),
                             .emission = Spectrum::Zero(3)});
  PolygonMesh plate{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}},
                    .facets = {{.boundary = {0, 1, 2, 3}}, {.boundary = {1, 4, 5, 2}}}};
  scene.surfaces.push_back({.name = "plate", .material = 0, .shape = plate});
  put_picture(scene, 0, picture_of(1, 1, {1.0f}));
  solved.mesh.material = {1, 1};
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  mesh.facets[1].uv_map = 0;
  EXPECT_EQ(bake_model(solved, scene).vertex_count(), 6);
  mesh.uv_maps.push_back(mesh.uv_maps[0]);
  mesh.uv_maps[1].offset.x() -= 0.5;
  mesh.facets[1].uv_map = 1;
  const BakedModel model = bake_model(solved, scene);
  EXPECT_EQ(model.vertex_count(), 8);
  EXPECT_EQ(model.parts.size(), 1u);
}

}  // namespace
}  // namespace lightwell::drawn_pictures_test
