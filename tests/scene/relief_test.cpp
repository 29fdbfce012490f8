// Relief: slopes of pictures of normals and of heights, their directions on a facet, and the gain
// of light.
#include "scene/relief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "scene/errors.h"
#include "scene/facet_relief.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace lightwell::relief_test {
namespace {

using Eigen::Vector3d;

// Shares have steps of 2e-5 of twice the steepest slope, and floats round what is left.
constexpr double step = 1e-4;

SurfaceTexture normals_of(const std::vector<Eigen::Array3i>& codes, int width) {
  std::vector<Texture::Code> texels;
  for (const Eigen::Array3i& code : codes) {
    for (const int c : code) texels.push_back(Texture::encode(static_cast<float>(c) / 255.0f));
  }
  const int height = static_cast<int>(codes.size()) / width;
  return {.picture = std::make_shared<const Texture>(width, height, 3, std::move(texels)),
          .is_smooth = false};
}

// A square of 2 m in the plane z = 0 that the picture covers: x to the right, y upwards.
Scene square_with(const Relief& relief) {
  Scene scene;
  scene.materials.push_back({.name = "wall",
                             .reflectance = Spectrum::Constant(3, 0.5f),
                             .specular = Spectrum::Zero(3),
                             .emission = Spectrum::Zero(3),
                             .relief = relief});
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
                   .facets = {{.boundary = {0, 1, 2, 3}, .uv_map = 0}}};
  UvMap map;
  map.gradient << 0.5, 0, 0, 0, -0.5, 0;
  map.offset << 0, 1;
  mesh.uv_maps = {map};
  scene.surfaces.push_back({.name = "wall", .material = 0, .shape = mesh});
  validate(scene);
  return scene;
}

Vector3d rise_at(const Scene& scene, double x, double y) {
  return FacetRelief(scene).rise(0, {x, y, 0}, Eigen::Matrix<double, 3, 2>::Zero());
}

// The first texel leans to the right by 0.598 / 0.803, the second upwards by as much; 127 and 128
// are both flat.
TEST(Relief, NormalsLeanToTheRightAndUpwardsOfThePicture) {
  const auto image =
      normals_of({{204, 128, 230}, {128, 204, 230}, {127, 127, 255}, {128, 128, 255}}, 2);
  const Scene scene = square_with(relief_of_normals(image, 1.0));
  const double slope = (204.0 - 128.0) / (230.0 - 128.0);
  // A surface that leans to the right falls to the right.
  EXPECT_LT((rise_at(scene, 0.5, 1.5) - Vector3d(-slope, 0, 0)).norm(), step);
  EXPECT_LT((rise_at(scene, 1.5, 1.5) - Vector3d(0, -slope, 0)).norm(), step);
  EXPECT_LT(rise_at(scene, 0.5, 0.5).norm(), step);
  EXPECT_LT(rise_at(scene, 1.5, 0.5).norm(), step);
  const Scene half = square_with(relief_of_normals(image, -0.5));
  EXPECT_LT((rise_at(half, 0.5, 1.5) - Vector3d(0.5 * slope, 0, 0)).norm(), step);
}

// Texels are 0.5 m wide on the square: a height of 1 over two texels is a slope of `depth`.
TEST(Relief, HeightsRiseByTheirDepthInMetresOrInTexels) {
  const SurfaceTexture image = picture_of(4, 1, {0.0f, 0.2f, 1.0f, 0.2f});
  const Scene metres = square_with(relief_of_heights(image, 0.1, DepthUnit::metre));
  EXPECT_LT((rise_at(metres, 0.75, 1) - Vector3d(0.1, 0, 0)).norm(), step);
  EXPECT_LT(rise_at(metres, 1.25, 1).norm(), step);
  EXPECT_LT((rise_at(metres, 1.75, 1) + Vector3d(0.1, 0, 0)).norm(), step);
  const Scene texels = square_with(relief_of_heights(image, 2.0, DepthUnit::texel));
  EXPECT_LT((rise_at(texels, 0.75, 1) - Vector3d(1.0, 0, 0)).norm(), 2.0 * step);
}

// The whole picture and one mirrored copy: a slope to the right, then one to the left.
TEST(Relief, MirroredPicturesSlopeTheOtherWay) {
  SurfaceTexture image = picture_of(4, 1, {0.0f, 0.2f, 1.0f, 0.2f});
  image.wrap.fill(TextureWrap::mirror);
  image.placement *= 2.0;
  const Scene scene = square_with(relief_of_heights(image, 0.1, DepthUnit::metre));
  // Texels are 0.25 m wide now.
  EXPECT_LT((rise_at(scene, 0.375, 0.5) - Vector3d(0.2, 0, 0)).norm(), step);
  EXPECT_LT((rise_at(scene, 2.0 - 0.375, 0.5) + Vector3d(0.2, 0, 0)).norm(), step);
}

// Coarser levels of the mip map hold the mean slope, which over a picture that repeats is 0.
TEST(Relief, FromAfarThereIsNone) {
  const SurfaceTexture image = picture_of(4, 1, {0.0f, 0.2f, 1.0f, 0.2f});
  const Scene scene = square_with(relief_of_heights(image, 0.1, DepthUnit::metre));
  Eigen::Matrix<double, 3, 2> wide;
  wide << 2, 0, 0, 2, 0, 0;
  EXPECT_LT(FacetRelief(scene).rise(0, {0.75, 1, 0}, wide).norm(), step);
}

TEST(Relief, GreyPicturesHaveNoNormals) {
  const SurfaceTexture grey = picture_of(2, 1, {0.5f, 1.0f});
  EXPECT_FALSE(shows_normals(*grey.picture));
  EXPECT_THROW(relief_of_normals(grey, 1.0), InputError);
  const SurfaceTexture red = normals_of({{200, 20, 20}, {180, 10, 30}}, 2);
  EXPECT_THROW(relief_of_normals(red, 1.0), InputError);
  EXPECT_TRUE(shows_normals(*normals_of({{128, 128, 255}, {204, 128, 230}}, 2).picture));
}

// g of opposite slopes adds up to 2 for every direction, steep slopes and grazing light included.
TEST(Relief, OppositeSlopesAreAsBrightAsTheFlatSurface) {
  for (const double slope : {0.1, 1.0, 4.0}) {
    const ReliefSlope one{.rise = {slope, 0, 0}}, other{.rise = {-slope, 0, 0}};
    for (int i = 0; i < 32; ++i) {
      const double cosine = (i + 0.5) / 32.0, phi = 2.4 * i, sine = std::sqrt(1 - cosine * cosine);
      const Vector3d w(sine * std::cos(phi), sine * std::sin(phi), cosine);
      EXPECT_NEAR(one.gain(w) + other.gain(w), 2.0, 1e-12);
      EXPECT_GE(one.gain(w), 0.0);
    }
  }
}

// The irradiance of a slope from a direction, per area of the flat surface.
TEST(Relief, GainIsThatOfTheInclinedSurface) {
  const ReliefSlope slope{.rise = {0.3, -0.2, 0}};
  const Vector3d w = Vector3d(0.2, 0.5, 0.8).normalized();
  const double inclined = w.dot(slope.bent()) / slope.bent().z();
  EXPECT_NEAR(slope.gain(3.0 * w), inclined / w.z(), 1e-12);
}

// Solutions do not know of relief.
TEST(Relief, SolutionsStayThoseOfTheScene) {
  const SurfaceTexture heights = picture_of(2, 1, {0.0f, 1.0f});
  const Scene shallow = square_with(relief_of_heights(heights, 0.01, DepthUnit::metre));
  const Scene deep = square_with(relief_of_heights(heights, 0.02, DepthUnit::metre));
  EXPECT_EQ(scene_hash(shallow), scene_hash(deep));
  Scene flat = shallow;
  flat.materials[0].relief.reset();
  EXPECT_EQ(scene_hash(shallow), scene_hash(flat));
  EXPECT_NE(FacetRelief(shallow).hash(), FacetRelief(deep).hash());
  EXPECT_TRUE(FacetRelief(flat).is_empty());
}

}  // namespace
}  // namespace lightwell::relief_test
