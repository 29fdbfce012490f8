// A relit solution and the scene file as it was: what is seen and measured is the light in force.
#include <gtest/gtest.h>

#include "mesh/element_caster.h"
#include "radiosity/relight.h"
#include "raytrace/probe.h"
#include "raytrace/render.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell {
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

class Relit : public testing::Test {
 protected:
  void SetUp() override {
    test::TwoLamps is{.with_mirror = true};
    scene = test::two_lamps(is);
    SolveOptions options = test::exact_and_even();
    options.channels = channels_per_luminaire(scene);
    relit = solve_scene(scene, options);
    const Spectrum warm = (Spectrum(3) << 1.4f, 0.9f, 0.3f).finished();
    relight(relit, std::vector<Spectrum>{Spectrum::Zero(3), warm});
    is.desk.setZero();
    is.panel *= warm;
    changed_scene = test::two_lamps(is);
    changed = solve_scene(changed_scene, test::exact_and_even());
  }
  Scene scene, changed_scene;
  SolvedScene relit, changed;
};

// Both trace the same rays; what differs is the rounding of floats, and the shadow rays of a lamp
// that is off in one and not there in the other, whose number keys the others'.
TEST_F(Relit, PicturesAreThoseOfTheChangedScene) {
  for (const Pass pass : {Pass::interpolate, Pass::direct}) {
    const Image a = picture(scene, relit, pass);
    const Image b = picture(changed_scene, changed, pass);
    const double mean = b.radiance.cast<double>().mean();
    const double rms = std::sqrt((a.radiance - b.radiance).cast<double>().square().mean()) / mean;
    std::printf("pass %d: relit and changed differ by %.1e of the mean\n", static_cast<int>(pass),
                rms);
    ASSERT_GT(mean, 0.0);
    // Penumbrae sampled with 64 rays: a share of 1 / 64 is off here and there.
    EXPECT_LT(rms, pass == Pass::interpolate ? 1e-5 : 1.0 / 64);
  }
}

TEST_F(Relit, ProbesAreThoseOfTheChangedScene) {
  const BandArray a = probed(scene, relit), b = probed(changed_scene, changed);
  EXPECT_LT((a - b).abs().maxCoeff(), b.maxCoeff() / 64);
  EXPECT_GT(b.minCoeff(), 0.0f);
}

// The lamp that is off is black, though the scene file says that it shines.
TEST_F(Relit, ALampThatIsOffIsDarkItself) {
  const ElementCaster caster(relit.mesh);
  const DirectLight direct_light(scene, relit.mesh);
  const Camera up{.position = {0.5, 0.6, 0.9},
                  .direction = Eigen::Vector3d::UnitZ(),
                  .up = Eigen::Vector3d::UnitY(),
                  .fov_degrees = 10.0,
                  .width = 4,
                  .height = 4};
  const Image image = render(scene, caster, direct_light, relit.solution, up);
  const Image lit = render(changed_scene, ElementCaster(changed.mesh),
                           DirectLight(changed_scene, changed.mesh), changed.solution, up);
  // It reflects a tenth of what it gets; alight it would give 40 W/m2 in each band.
  EXPECT_LT(image.radiance.maxCoeff(), 0.02f * 40.0f / static_cast<float>(M_PI));
  EXPECT_LT((image.radiance - lit.radiance).abs().maxCoeff(), lit.radiance.maxCoeff() / 64);
}

}  // namespace
}  // namespace lightwell
