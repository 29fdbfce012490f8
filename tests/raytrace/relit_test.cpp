// A relit solution with the unchanged scene file: pictures and measurements have the relit light.
#include <gtest/gtest.h>

#include "mesh/elements/element_caster.h"
#include "radiosity/solution/relight.h"
#include "raytrace/readings/probe.h"
#include "raytrace/render.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::relit_test {
namespace {

constexpr Eigen::Index size = 32;

Image picture(const Scene& scene, const SolvedScene& solved, Pass pass) {
  const Camera camera{.position = {1.7, 0.2, 1.3},
                      .direction = Eigen::Vector3d(-0.5, 1.0, 0.2).normalized(),
                      .up = Eigen::Vector3d(-0.5, 1.0, -6.25).normalized() * -1.0,
                      .fov_degrees = 90.0,
                      .width = size,
                      .height = size};
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  return render(scene, caster, direct_light, solved.solution, camera, {.pass = pass});
}

BandArray probed(const Scene& scene, const SolvedScene& solved) {
  const std::vector<Probe> probes = {
      {.position = {1.5, 0.6, 0.0}}, {.position = {0.6, 0.7, 0.8}}, {.position = {1.0, 1.5, 1.0}}};
  const ElementCaster caster(solved.mesh);
  return probe_irradiance(scene, caster, DirectLight(scene, solved.mesh), solved.solution, probes,
                          {.rays = 64});
}

// A scene solved and relit, and the same scene solved with the relit emission.
struct Both {
  explicit Both(float desk) {
    test::TwoLamps is{.with_mirror = true, .with_block = false};
    scene = test::two_lamps(is);
    SolveOptions options = test::exact_and_even();
    options.channels = channels_per_luminaire(scene);
    relit = solve_scene(scene, options);
    const Spectrum warm = (Spectrum(3) << 1.4f, 0.9f, 0.3f).finished();
    relight(relit, std::vector<Spectrum>{Spectrum::Constant(3, desk), warm});
    is.desk *= desk;
    is.panel *= warm;
    changed_scene = test::two_lamps(is);
    changed = solve_scene(changed_scene, test::exact_and_even());
  }
  Scene scene, changed_scene;
  SolvedScene relit, changed;
};

// The dimmed desk lamp stays the brighter one, so its shadow rays are the same.
constexpr float dimmed = 0.6f;

// Twenty float roundings of 6e-8: ten in the solution and ten from the hit to the pixel.
constexpr double rounding = 1.2e-6;

TEST(Relit, PicturesAreThoseOfTheChangedScene) {
  const Both both(dimmed);
  for (const Pass pass : {Pass::interpolate, Pass::direct}) {
    const Image a = picture(both.scene, both.relit, pass);
    const Image b = picture(both.changed_scene, both.changed, pass);
    const double mean = b.radiance.cast<double>().mean();
    ASSERT_GT(mean, 0.0);
    const double rms = std::sqrt((a.radiance - b.radiance).cast<double>().square().mean());
    EXPECT_LT(rms, rounding * mean) << "pass " << static_cast<int>(pass);
  }
}

TEST(Relit, ProbesAreThoseOfTheChangedScene) {
  const Both both(dimmed);
  const BandArray a = probed(both.scene, both.relit), b = probed(both.changed_scene, both.changed);
  EXPECT_LT((a - b).abs().maxCoeff(), rounding * b.maxCoeff());
  EXPECT_GT(b.minCoeff(), 0.0f);
}

// A lamp at scale 0 is black, although it emits in the scene file. Shadow rays to the other lamp
// differ from those without a second lamp: 32 rays, of which one row of cells may have errors.
TEST(Relit, ALampThatIsOffIsDarkItself) {
  const Both both(0.0f);
  const Camera up{.position = {0.5, 0.6, 0.9},
                  .direction = Eigen::Vector3d::UnitZ(),
                  .up = Eigen::Vector3d::UnitY(),
                  .fov_degrees = 10.0,
                  .width = 4,
                  .height = 4};
  const auto look = [&](const Scene& scene, const SolvedScene& solved) {
    return render(scene, ElementCaster(solved.mesh), DirectLight(scene, solved.mesh),
                  solved.solution, up)
        .radiance;
  };
  const BandArray a = look(both.scene, both.relit), b = look(both.changed_scene, both.changed);
  // The lamp reflects a tenth of its irradiance; at scale 1 it would emit 40 W/m2 in each band.
  EXPECT_LT(a.maxCoeff(), 0.02f * 40.0f / static_cast<float>(M_PI));
  EXPECT_GT(a.minCoeff(), 0.0f);
  EXPECT_LT((a - b).abs().maxCoeff(), b.maxCoeff() / 32);
}

}  // namespace
}  // namespace lightwell::relit_test
