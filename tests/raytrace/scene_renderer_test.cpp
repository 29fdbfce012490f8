#include "raytrace/scene_renderer.h"

#include <gtest/gtest.h>

#include <string_view>

#include "tests/raytrace/lit_scene.h"

namespace lightwell::scene_renderer_test {
namespace {

// A lamp over a mirror, which reflects light to the ceiling.
struct MirroredLamp {
  TracedScene lit{SceneBuilder()
                      .square({.exitance = 10.0f, .one_sided = true}, {0, 0, 1}, {0, 0, -1}, 0.1)
                      .square({.specular = 0.8f, .one_sided = true}, {0, 0, 0}, {0, 0, 1}, 0.5)
                      .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 2}, {0, 0, -1}, 4.0)
                      .build()};
  MirroredLamp() { lit.solution.caustic_irradiance = lit.solution.indirect_irradiance; }
};

// Options whose progress callback counts the tracings of photons in `traced`.
RenderOptions counting(int& traced, int photons) {
  return {.photons = photons, .run = {.progress = [&traced](std::string_view phase, double share) {
                                if (phase == "photons" && share == 0.0) ++traced;
                                return true;
                              }}};
}

TEST(SceneRenderer, PicturesShareTheirPhotonsAndHaveTheBitsOfPicturesAlone) {
  const MirroredLamp mirrored;
  SceneRenderer renderer(mirrored.lit.scene, mirrored.lit.mesh, mirrored.lit.solution);
  const Camera cameras[] = {camera_towards({0.75, 0.1, 1.0}, {0.75, 0.1, 2.0}, 40.0, 16),
                            camera_towards({-0.75, 0.4, 0.5}, {-0.7, 0.1, 2.0}, 60.0, 12)};
  int traced = 0;
  for (const Camera& camera : cameras) {
    const Image shared = renderer.render(camera, counting(traced, 1 << 12));
    const Image alone = mirrored.lit.render(camera, {.photons = 1 << 12});
    EXPECT_GT(alone.radiance.maxCoeff(), 0.0f);
    EXPECT_TRUE((shared.radiance == alone.radiance).all());
  }
  EXPECT_EQ(traced, 1);

  const Image more = renderer.render(cameras[0], counting(traced, 1 << 13));
  EXPECT_EQ(traced, 2) << "more photons are others";
  EXPECT_TRUE(
      (more.radiance == mirrored.lit.render(cameras[0], {.photons = 1 << 13}).radiance).all());
  renderer.render(cameras[0], counting(traced, 0));
  EXPECT_EQ(traced, 2) << "the solution's own caustics need none";
}

TEST(SceneRenderer, RecordsThatPicturesShareGiveTheBitsOfPicturesAlone) {
  MirroredLamp mirrored;
  const int elements = mirrored.lit.mesh.element_count();
  mirrored.lit.solution.interpolation_error = Eigen::ArrayXf::Constant(elements, 0.1f);
  SceneRenderer renderer(mirrored.lit.scene, mirrored.lit.mesh, mirrored.lit.solution);
  const Camera camera = camera_towards({0.75, 0.1, 1.0}, {0.75, 0.1, 2.0}, 40.0, 16);
  int found = 0;
  RenderOptions options{.run = {.progress = [&found](std::string_view phase, double) {
                          found += phase == "records" ? 1 : 0;
                          return true;
                        }}};
  const Image alone = renderer.render(camera, options);
  EXPECT_GT(found, 0);
  options.records = renderer.records(camera, options);
  ASSERT_TRUE(options.records);
  found = 0;
  EXPECT_TRUE((renderer.render(camera, options).radiance == alone.radiance).all());
  EXPECT_EQ(found, 0) << "the picture takes the records that it is given";
}

TEST(SceneRenderer, StoppedWhileItTracesPhotonsItStartsAgain) {
  const MirroredLamp mirrored;
  SceneRenderer renderer(mirrored.lit.scene, mirrored.lit.mesh, mirrored.lit.solution);
  const Camera camera = camera_towards({0.75, 0.1, 1.0}, {0.75, 0.1, 2.0}, 40.0, 8);
  EXPECT_THROW(
      renderer.render(camera, {.run = {.progress = [](std::string_view phase,
                                                      double) { return phase != "photons"; }}}),
      Interrupted);
  EXPECT_TRUE((renderer.render(camera).radiance == mirrored.lit.render(camera).radiance).all());
}

}  // namespace
}  // namespace lightwell::scene_renderer_test
