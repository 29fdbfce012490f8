// Frames of a fade as means of pictures of its states, against pictures rendered at the moment.
#include "raytrace/fade_pictures.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "radiosity/solution/relight.h"
#include "raytrace/scene_renderer.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::fade_pictures_test {
namespace {

constexpr int size = 32;

/// A room whose desk lamp rises to its double in two seconds while its panel falls to a quarter in
/// four.
struct Fading {
  Fading() {
    SolveOptions options = test::exact_and_even();
    options.channels = channels_per_luminaire(scene);
    solved = solve_scene(scene, options);
    const Spectrum one = Spectrum::Ones(3);
    fade = {
        .from = {one, one}, .to = {2.0f * one, 0.25f * one}, .fade = {2.0, 4.0}, .seconds = 4.0};
  }
  Image rendered(double second, const RenderOptions& options) const {
    SolvedScene relit = solved;
    relight(relit, scales_at(fade, second));
    return SceneRenderer(scene, relit.mesh, relit.solution).render(camera, options);
  }

  Scene scene = test::two_lamps();
  SolvedScene solved;
  CueFade fade;
  Camera camera{.position = {1.7, 0.2, 1.3},
                .direction = Eigen::Vector3d(-0.5, 1.0, 0.2).normalized(),
                .up = Eigen::Vector3d(0.5, -1.0, 6.25).normalized(),
                .fov_degrees = 90.0,
                .width = size,
                .height = size};
};

/// Pixels that are not subdivided by their contrast take the same rays in every light.
TEST(FadePictures, FramesAreThePicturesOfTheirMoments) {
  const Fading room;
  const RenderOptions options{.pass = Pass::interpolate, .max_subdivision = 0};
  FadePictures pictures(room.scene, room.solved, room.camera, options);
  for (const double second : {0.0, 0.5, 1.9, 2.0, 3.0, 4.0}) {
    const Image frame = pictures.at(shares_at(room.fade, second));
    const Image whole = room.rendered(second, options);
    ASSERT_EQ(frame.radiance.rows(), whole.radiance.rows());
    EXPECT_GT(whole.radiance.mean(), 0.0f);
    // Twenty float roundings of 6e-8 in each picture: ten in the solution and ten to the pixel.
    const float rounding = 2 * 20 * 6e-8f * whole.radiance.maxCoeff();
    EXPECT_LT((frame.radiance - whole.radiance).abs().maxCoeff(), rounding) << second;
  }
  EXPECT_EQ(pictures.rendered(), 3) << "the states of the fade, however many its frames";
}

/// With shadow rays, whose numbers follow the brightness of lamps, frames differ within the noise.
TEST(FadePictures, FramesByShadowRaysDifferWithinTheirNoise) {
  const Fading room;
  const RenderOptions options{.pass = Pass::direct, .max_subdivision = 0};
  FadePictures pictures(room.scene, room.solved, room.camera, options);
  const Image frame = pictures.at(shares_at(room.fade, 1.0));
  const Image whole = room.rendered(1.0, options);
  const float mean = whole.radiance.mean();
  const float difference = (frame.radiance - whole.radiance).abs().mean();
  std::printf("mean difference %.2g of the mean\n", static_cast<double>(difference / mean));
  // 16 rays or more to a lamp find a share of half with an error of 1 / (2 sqrt(16)) = 13 % of the
  // lamp's light, in penumbras, which are less than a tenth of the picture.
  EXPECT_LT(difference, 0.1f * 0.13f * mean);
}

}  // namespace
}  // namespace lightwell::fade_pictures_test
