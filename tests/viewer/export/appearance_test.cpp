#include "viewer/export/appearance.h"
#include "mesh/patches/mesh_bounds.h"

#include <gtest/gtest.h>

#include <iterator>
#include <numbers>

#include "tests/viewer/solved_box.h"
#include "viewer/export/start_view.h"

namespace lightwell::appearance_test {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

TEST(Appearance, MatteSurfacesShowRadiosityOverPi) {
  const SolvedScene box = solved_box();
  const BandArray L = shown_radiance(box, {});
  EXPECT_FLOAT_EQ(L(0, 1), green[1] / pi);
  EXPECT_FLOAT_EQ(L(4, 0), red[0] / pi);
}

/// A vertex has the same bytes as a pixel of the second pass with the same radiance.
TEST(Appearance, VerticesAreToneMappedAsPicturesAre) {
  Image image{256, 1, BandArray(256, 3)};
  for (int x = 0; x < 256; ++x) {
    const auto L = static_cast<float>(x);
    image.radiance.row(x) << 0.02f * L, 0.01f * L, 0.001f * L * L;
  }
  const Bands bands = rgb_bands();
  EXPECT_EQ(display_colors(image.radiance, bands, exposure_scale(image, bands)),
            tone_map(image, bands));
}

/// A mirror is drawn as a matte surface that reflects as much.
TEST(Appearance, MirrorsShowTheirShareOfTheIrradiance) {
  SolvedScene box = solved_box();
  box.mesh.reflectance.row(2).setZero();
  std::vector<Material> materials(5);
  for (Material& m : materials) m.specular = constant_spectrum(box.solution.bands, 0.0f);
  EXPECT_EQ(shown_radiance(box, materials)(8, 0), 0.0f);
  materials[2].specular = constant_spectrum(box.solution.bands, 0.8f);
  EXPECT_FLOAT_EQ(shown_radiance(box, materials)(8, 0), 0.8f * white[0] / pi);
}

TEST(Appearance, ElementsWithoutLightAndOfGlassAreToldApart) {
  SolvedScene box = solved_box();
  box.solution.direct_irradiance.topRows(4).setZero();
  box.solution.direct_irradiance.middleRows(8, 4).setZero();
  box.mesh.emission(2, 1) = 1.0f;
  std::vector<Material> materials(5);
  for (Material& m : materials) m.specular = constant_spectrum(box.solution.bands, 0.0f);
  materials[4].dielectric = Dielectric{1.5f, constant_spectrum(box.solution.bands, 1.0f)};
  const auto kinds = element_kinds(box, materials);
  EXPECT_EQ(kinds[0], ElementKind::unlit);
  EXPECT_EQ(kinds[1], ElementKind::lit);
  EXPECT_EQ(kinds[2], ElementKind::lit) << "an emitter shows light even if none falls on it";
  EXPECT_EQ(kinds[4], ElementKind::glass);
}

class CoarsePicture : public testing::Test {
 protected:
  /// Radiance in the middle of a picture.
  Eigen::Array3f middle(const SolvedScene& box, const Camera& camera,
                        const std::vector<Material>& materials = {}) {
    const ElementCaster caster(box.mesh);
    const Image image = coarse_picture(caster, element_kinds(box, materials),
                                       shown_radiance(box, materials), camera, 41);
    EXPECT_EQ(image.width, 41);
    EXPECT_EQ(image.height, 31);  // 41 * 150 / 200 = 30.75
    return image.radiance.row(15 * 41 + 20).transpose();
  }
};

TEST_F(CoarsePicture, ShowsTheRadianceSeen) {
  EXPECT_LT((middle(solved_box(), box_camera()) - white / pi).abs().maxCoeff(), 1e-6f);
}

/// From behind the back wall the camera looks through it and out of the opening.
TEST_F(CoarsePicture, LooksThroughBacks) {
  Camera camera = box_camera();
  camera.position = {1, 1, 5};
  camera.direction = {0, 0, -1};
  EXPECT_EQ(middle(solved_box(), camera).maxCoeff(), 0.0f);
  camera.position = {-3, 1, 1};
  camera.direction = {1, 0, 0};
  EXPECT_LT((middle(solved_box(), camera) - green / pi).abs().maxCoeff(), 1e-6f);
}

TEST(StartView, AnOpenBoxIsSeenFromItsOpenSide) {
  const SolvedScene box = solved_box();
  const ElementCaster caster(box.mesh);
  const Bounds bounds = mesh_bounds(box.mesh);
  EXPECT_EQ(bounds.low, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(bounds.high, Eigen::Vector3d(2, 2, 2));
  const Camera camera = find_start(caster, element_kinds(box, {}), shown_radiance(box, {}),
                                   Eigen::Vector3d::UnitY(), 320, 240);
  // Every wall is one-sided, so each side of the box shows the inside; the whole box must be in
  // view.
  const double distance = (camera.position - Eigen::Vector3d(1, 1, 1)).norm();
  EXPECT_GT(distance, std::sqrt(3.0));
  EXPECT_NEAR(camera.direction.dot(camera.up), 0.0, 1e-12);
}

/// The bounding sphere just touches the narrower side of the picture: sin(half angle) = r / d.
TEST(StartView, FrameAllHoldsTheBoundingSphere) {
  const Bounds bounds{{-1, -2, -3}, {1, 2, 3}};
  const Camera camera = frame_all(bounds, {0, 0, -1}, {0, 1, 0}, 400, 200);
  const double half_height = std::atan(0.5 * std::tan(20.0 * std::numbers::pi / 180.0));
  EXPECT_NEAR(camera.position.z(), std::sqrt(14.0) / std::sin(half_height), 1e-9);
  EXPECT_EQ(camera.up, Eigen::Vector3d(0, 1, 0));
}

/// A square camera of 90 degrees in a window twice as wide as high: the height must still span
/// 90 degrees, so tan of half the width's angle doubles to 2. In a tall window the width spans 90
/// degrees.
TEST(StartView, WindowsShowAllOfTheCamerasPicture) {
  Camera camera;
  camera.fov_degrees = 90.0;
  camera.width = camera.height = 100;
  EXPECT_NEAR(fit_to_window(camera, 800, 400).fov_degrees, 2.0 * std::atan(2.0) * 180.0 / pi, 1e-5);
  EXPECT_EQ(fit_to_window(camera, 400, 800).fov_degrees, 90.0);
}

TEST(StartView, UpIsWhatTheCamerasSay) {
  const Bounds flat_in_y{{0, 0, 0}, {5, 3, 4}};
  const Bounds flat_in_z{{0, 0, 0}, {5, 4, 3}};
  EXPECT_EQ(guess_up_axis({}, flat_in_y), Eigen::Vector3d::UnitY());
  EXPECT_EQ(guess_up_axis({}, flat_in_z), Eigen::Vector3d::UnitZ());
  Camera tilted;
  tilted.up = Eigen::Vector3d(0.6, 0.0, 0.8);
  EXPECT_EQ(guess_up_axis({tilted}, flat_in_y), Eigen::Vector3d::UnitZ());
}

TEST(FalseColor, TheLuxScaleEndsOnRoundNumbersAroundTheValues) {
  std::vector<float> lux;
  for (int i = 1; i <= 1000; ++i) lux.push_back(0.7f * static_cast<float>(i));
  const LuxRange range = lux_range(lux);
  EXPECT_DOUBLE_EQ(range.high, 1000.0);  // the brightest is 700
  EXPECT_DOUBLE_EQ(range.low, 1.0);      // a thousandth of `high`
  EXPECT_DOUBLE_EQ(lux_range({150.0f, 190.0f}).high, 200.0);
  EXPECT_DOUBLE_EQ(lux_range({150.0f, 190.0f}).low, 100.0);
  const LuxRange dark = lux_range({0.0f, 0.0f});
  EXPECT_LT(dark.low, dark.high);
}

/// Equal ratios of illuminance are equal steps, and every step is lighter than the one before.
TEST(FalseColor, ColorsRiseInLightnessOverTheScale) {
  float before = -1.0f;
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Array3f c = false_color(0.01f * static_cast<float>(i));
    const float lightness = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    EXPECT_GT(lightness, before);
    before = lightness;
  }
  const auto bytes = false_colors({1.0f, 10.0f, 100.0f}, {1.0, 100.0});
  const Eigen::Array3f half = false_color(0.5f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(bytes[3 + c], 255.0f * half[c], 1.0f);
}

TEST(FalseColor, AScaleFromZeroIsEven) {
  const auto bytes = false_colors({-1.0f, 0.0f, 250.0f, 1000.0f, 2000.0f}, {0.0, 1000.0});
  const float places[] = {0.0f, 0.0f, 0.25f, 1.0f, 1.0f};
  for (std::size_t i = 0; i < std::size(places); ++i) {
    const Eigen::Array3f wanted = false_color(places[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(bytes[3 * i + c], 255.0f * wanted[static_cast<Eigen::Index>(c)], 1.0f) << i;
    }
  }
}

}  // namespace
}  // namespace lightwell::appearance_test
