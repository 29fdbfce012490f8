#include "raytrace/shading/pixel_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/solve.h"
#include "tests/pictures.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::gather_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

// A point under the middle of a square with B = 3: four quarters, each with the form factor of a
// corner (Howell, B-4).
TEST(PixelGather, ReadsTheSolutionWhereItsRaysEnd) {
  constexpr double h = 1.0, half = 2.0;
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 0.5f}, {0, 0, 0}, up, 0.5)
                      .square({.reflectance = 1.0f}, {0, 0, h}, -up, half)
                      .build(),
                  0.05);
  lit.set_indirect([](const Eigen::Vector3d& p) { return p.z() > 0.5 ? 3.0f : 0.0f; });
  const PixelGather gather(lit.scene, lit.caster, lit.direct_light, lit.solution, 1024, 4);
  const ShadingPoint at{.position = {0, 0, 0}, .normal = up, .smooth_normal = up, .facet = 0};
  const double s = half / std::hypot(half, h);
  const double F = 4.0 / std::numbers::pi * s * std::atan(s);
  // About 4 sqrt(1024) of the 1024 strata cross the square's edge, each with a variance of at most
  // 1/4; the tolerance is four standard deviations.
  EXPECT_NEAR(gather.indirect_irradiance(lit.caster, at, 3, 1.0f)[0], 3.0 * F,
              4 * 3.0 * std::sqrt(4 * 32 * 0.25) / 1024);
  // A sixteenth of the rays has the same mean: 64 gathers of 64 rays, each ray with a standard
  // deviation of at most 1/2.
  double sum = 0.0;
  for (std::uint64_t key = 0; key < 64; ++key) {
    sum += static_cast<double>(gather.indirect_irradiance(lit.caster, at, key, 1.0f / 16.0f)[0]);
  }
  EXPECT_NEAR(sum / 64, 3.0 * F, 4 * 3.0 * 0.5 / 64);
}

// A point 0.4 m above a floor of one patch, too high for a gap, beside the line between the dark
// and the bright half of its picture: E = dark F_dark + bright F_bright for an irradiance of 1.
// About 4 sqrt(4096) of the 4096 strata cross the line, each with a standard deviation of (bright -
// dark) / 2 at most, and as many the floor's edge, where rays are worth less by their cosine; the
// tolerance is four standard deviations.
TEST(PixelGather, ReadsPicturesNearBy) {
  constexpr float dark = 0.1f, bright = 0.8f;
  constexpr double h = 0.4;
  Scene scene = SceneBuilder()
                    .polygon({.reflectance = 0.5f}, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}})
                    .build();
  put_picture(scene, 0, picture_of(2, 1, {dark, bright}));
  TracedScene lit(std::move(scene), 4.0);
  lit.set_indirect([](const Eigen::Vector3d&) { return 1.0f; });
  const PixelGather gather(lit.scene, lit.caster, lit.direct_light, lit.solution, 4096, 4);
  const Eigen::Vector3d from(1.0 + h, 1.0, h);
  const ShadingPoint at{.position = from, .normal = -up, .smooth_normal = -up};
  const auto form_factor = [&](double low, double high) {
    return point_to_polygon(from, -up, Loop{{low, 0, 0}, {high, 0, 0}, {high, 2, 0}, {low, 2, 0}});
  };
  constexpr double deviation = 0.5 * static_cast<double>(bright - dark);
  EXPECT_NEAR(gather.indirect_irradiance(lit.caster, at, 3, 1.0f)[0],
              dark * form_factor(0, 1) + bright * form_factor(1, 2),
              4.0 * deviation * std::sqrt(2.0 * 4.0 * 64.0) / 4096.0);
}

TEST(PixelGather, AMirrorDoublesWhatIsBesideIt) {
  // A lit wall with a black back; its light reaches a floor directly and by a mirror that faces the
  // wall.
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 0.5f}, {0, 0, 0}, up, 0.2)
                      .square({.reflectance = 1.0f}, {0, 0, 2}, -up, 0.5)
                      .square({.specular = 1.0f}, {0.8, 0, 1}, {-1, 0, 0}, 1.0)
                      .build());
  lit.set_indirect([](const Eigen::Vector3d& p) { return p.z() > 1.9 ? 1.0f : 0.0f; });
  const PixelGather gather(lit.scene, lit.caster, lit.direct_light, lit.solution, 1 << 14, 4);
  const ShadingPoint at{.position = {0, 0, 0}, .normal = up, .smooth_normal = up, .facet = 0};
  TracedScene open(SceneBuilder()
                       .square({.reflectance = 0.5f}, {0, 0, 0}, up, 0.2)
                       .square({.reflectance = 1.0f}, {0, 0, 2}, -up, 0.5)
                       .square({.reflectance = 1.0f}, {1.6, 0, 2}, -up, 0.5)  // the wall's image
                       .build());
  open.set_indirect([](const Eigen::Vector3d& p) { return p.z() > 1.9 ? 1.0f : 0.0f; });
  const PixelGather without(open.scene, open.caster, open.direct_light, open.solution, 1 << 14, 4);
  // From the point the image lies wholly within the mirror: rays to x = 1.1 to 2.1, z = 2 cross
  // x = 0.8 at heights of 0.76 to 1.45 and |y| < 0.37. The strata at edges are those of two
  // squares.
  EXPECT_NEAR(gather.indirect_irradiance(lit.caster, at, 3, 1.0f)[0],
              without.indirect_irradiance(open.caster, at, 3, 1.0f)[0],
              4 * std::sqrt(2 * 4 * 128 * 0.25) / 16384);
}

// All passes show the same light if the mesh is fine enough.
TEST(Passes, AgreeOnADiffuseRoom) {
  const Scene scene =
      SceneBuilder()
          .box({.reflectance = 0.6f, .one_sided = true}, {0, 0, 0}, {2, 2, 1.5}, true)
          .square({.exitance = 10 * pi_f, .one_sided = true}, {1, 1, 1.45}, -up, 0.3)
          .build();
  const SolvedScene solved = solve_scene(scene);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  Camera camera = camera_towards({0.3, 0.3, 0.9}, {1.6, 1.7, 0.2}, 60, 24);
  const auto picture = [&](Pass pass) {
    return render(scene, caster, direct_light, solved.solution, camera, {.pass = pass}).radiance;
  };
  const BandArray interpolated = picture(Pass::interpolate), direct = picture(Pass::direct),
                  gathered = picture(Pass::gather);
  const auto difference = [&](const BandArray& a, const BandArray& b) {
    return std::sqrt((a - b).square().mean()) / b.mean();
  };
  // The solution is refined to an interpolation error of 0.7 % of the mean irradiance, and its
  // vertices have noise of the same size; pixels gather 256 stratified rays, with noise of about 1
  // %.
  EXPECT_LT(difference(interpolated, direct), 0.02f);
  EXPECT_LT(difference(gathered, direct), 0.02f);
  EXPECT_LT(std::abs(gathered.mean() / direct.mean() - 1.0f), 0.005f);
}

}  // namespace
}  // namespace lightwell::gather_test
