#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "radiosity/emitters/emitter.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solve.h"
#include "raytrace/shading/shade.h"
#include "scene/optics.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::gloss_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

float radiance(const TracedScene& lit, const Ray& ray, const RenderOptions& options = {},
               std::uint64_t key = 1) {
  return RayTree(lit.scene, lit.caster, lit.direct_light, lit.solution, options)
      .trace(ray, key)
      .radiance[0];
}

// Options with hardly any cut of the ray tree.
const RenderOptions to_the_end{.max_depth = 400, .min_contribution = 1e-9f};

class GlossInAFurnace : public testing::TestWithParam<Paint> {};

// Rough surfaces neither absorb nor emit: in a world of radiance 1 they are invisible.
TEST_P(GlossInAFurnace, IsInvisible) {
  const TracedScene lit(SceneBuilder()
                            .box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true)
                            .sphere(GetParam(), {0.1, 0, 0}, 1.0)
                            .box(GetParam(), {1.5, -1, -1}, {2.5, 1, 1}, false)
                            .build());
  for (int i = 0; i <= 60; ++i) {
    const Ray ray{.origin = {-1.0 + 3.5 * i / 60.0, 0.3, 2.5}, .direction = -up};
    EXPECT_NEAR(radiance(lit, ray, to_the_end, static_cast<std::uint64_t>(i)), 1.0, 1e-3) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    MetalAndGlass, GlossInAFurnace,
    ::testing::Values(Paint{.specular = 1.0f, .roughness = 0.05f},
                      Paint{.specular = 1.0f, .roughness = 0.4f},
                      Paint{.specular = 1.0f, .roughness = 1.0f},
                      Paint{.index_of_refraction = 1.5f, .roughness = 0.05f},
                      Paint{.index_of_refraction = 1.5f, .roughness = 0.4f},
                      Paint{.index_of_refraction = 1.5f, .roughness = 1.0f},
                      Paint{.index_of_refraction = 1.5f, .roughness = 0.3f, .thin = true}));

TEST(Gloss, ReflectsTheShareThatItIsGiven) {
  const TracedScene lit(SceneBuilder()
                            .box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true)
                            .square({.specular = 0.6f, .roughness = 0.5f}, {0, 0, 0}, up, 1.0)
                            .build());
  EXPECT_NEAR(radiance(lit, {.origin = {0.5, 0.1, 2}, .direction = -up}), 0.6, 1e-6);
}

// A lamp's reflection in a rough surface: the second pass samples both lamps and the lobe, the
// first pass only the lobe. Both give the share of the lobe's rays that end on the lamp.
TEST(Gloss, ScattersAlikeInBothPasses) {
  for (const Paint& paint : {Paint{.specular = 0.9f, .roughness = 0.5f},
                             Paint{.index_of_refraction = 1.5f, .roughness = 0.3f}}) {
    for (const bool is_sphere : {false, true}) {
      SceneBuilder builder;
      builder.square(paint, {0, 0, 0}, up, 1.0).box({}, {-4, -4, -4}, {4, 4, 4}, true);
      const Paint shines{.exitance = pi_f};
      for (const double z : {-1.5, 1.5}) {  // one is reflected, the other refracted
        const Eigen::Vector3d at(-0.8, 0.1, z);
        is_sphere ? builder.sphere(shines, at, 0.5) : builder.square(shines, at, -z * up, 0.5);
      }
      const TracedScene lit(builder.build());
      ASSERT_EQ(lit.direct_light.emitters().size(), 2U);
      const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, to_the_end);
      const LightPaths paths(lit.scene, lit.caster, 400);
      const Ray ray{.origin = {0.8, 0.1, 1},
                    .direction = Eigen::Vector3d(-0.8, 0, -1).normalized()};
      ElementHit hit;
      lit.caster.closest_hits({&ray, 1}, {&hit, 1});
      ASSERT_TRUE(paths.is_specular(hit.facet));
      constexpr std::uint64_t count = 10000;
      double found = 0.0, seen = 0.0;
      for (std::uint64_t key = 0; key < count; ++key) {
        paths.follow(
            ray, hit, key,
            [&](const ElementHit& end, const Spectrum& throughput) {
              const float L = lit.mesh.emission(lit.mesh.patch[end.element], 0) / pi_f;
              found += static_cast<double>(throughput[0] * L) / count;
            },
            PathQuantity::radiance);
        if (key % 20 == 0)
          seen += static_cast<double>(tree.trace(ray, key).radiance[0]) * 20 / count;
      }
      // A share p of independent rays has sigma = sqrt(p (1 - p) / count), at most 0.005; the
      // second pass has 8 times 500 samples of the lobe, and samples of lamps, whose noise is not
      // larger.
      EXPECT_NEAR(seen, found, 4 * std::hypot(0.005, 0.5 / std::sqrt(4000.0)));
      EXPECT_GT(found, 0.1);
    }
  }
}

// A mirror in a hall of few elements, whose light in the solution is set apart from what shadow
// rays find: a rough one shows the solution, a smooth one what shadow rays find. The lamp is behind
// the mirror.
TEST(Gloss, ShowsTheSolutionWhereItsLobeCoversElements) {
  constexpr float rho = 0.5f, E_of_solution = 7.0f;
  for (const float roughness : {0.0f, 0.5f}) {
    TracedScene lit(SceneBuilder()
                        .box({.reflectance = rho}, {-40, -40, -1}, {40, 40, 79}, true)
                        .square({.specular = 1.0f, .roughness = roughness}, {0, 0, 9}, -up, 0.5)
                        .square({.exitance = pi_f}, {20, 0, 60}, -up, 1.0)
                        .build());
    lit.solution.direct_irradiance.setConstant(E_of_solution);
    lit.solution.indirect_irradiance.setZero();
    const Ray ray{.origin = {0.0, 0.1, 8.0}, .direction = up};
    const float L = radiance(lit, ray), of_solution = rho * E_of_solution / pi_f;
    if (roughness > 0.0f) {
      // The mean over eight rays of the lobe, each a float.
      constexpr float rounding = 8 * std::numeric_limits<float>::epsilon();
      EXPECT_NEAR(L, of_solution, rounding * of_solution);
    } else {
      // The lamp of 4 m^2 is 61 m above the floor: E < 4 / 61^2.
      EXPECT_LT(L, rho * 4.0f / (61.0f * 61.0f) / pi_f);
      EXPECT_GT(L, 0.0f);
    }
  }
}

// Every wall emits M and reflects rho: B = M / (1 - rho) with any rough bodies between the walls.
TEST(Gloss, NeitherTakesNorGivesLightInTheFirstPass) {
  for (const Paint& paint : {Paint{.specular = 1.0f, .roughness = 0.4f},
                             Paint{.index_of_refraction = 1.5f, .roughness = 0.1f}}) {
    const Scene scene = SceneBuilder()
                            .box({.reflectance = 0.5f, .exitance = 1.0f, .one_sided = true},
                                 {0, 0, 0}, {2, 2, 2}, true)
                            .sphere(paint, {1.1, 0.9, 0.8}, 0.6)
                            .build();
    // All rays bring the same, so that few do.
    const SolvedScene solved =
        solve_scene(scene, {.mesh = {.max_patch_size = 0.5},
                            .form_factors = {.rays_per_patch = 64, .rays_per_emitter = 4096},
                            .gather = {.rays = 64},
                            .refine = {.tolerance = 0.0}});
    const BandArray irradiance = solved.solution.irradiance();
    for (int p = 0; p < solved.mesh.patch_count(); ++p) {
      if (!(solved.mesh.emission(p, 0) > 0.0f)) continue;
      for (int e = solved.mesh.first_element[p]; e < solved.mesh.first_element[p + 1]; ++e) {
        const float E = irradiance(solved.mesh.corners[e][0], 0);
        // The tolerance is the light still within the ball after 64 surfaces.
        EXPECT_NEAR(E, 2.0f, 2e-3f);
      }
    }
  }
}

// An index of 1 neither refracts nor reflects: through the middle exp(-a 2 r) of the world's
// radiance is transmitted.
TEST(Absorption, FollowsBeerAndLambertThroughABall) {
  const TracedScene lit(
      SceneBuilder()
          .box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true)
          .sphere({.index_of_refraction = 1.0f, .absorption = 0.7f}, {0, 0, 0}, 1.0)
          .build());
  for (const double off : {0.0, 0.3, 0.8}) {
    const double chord = 2.0 * std::sqrt(1.0 - off * off);
    EXPECT_NEAR(radiance(lit, {.origin = {off, 0, 2}, .direction = -up}), std::exp(-0.7 * chord),
                1e-5);
  }
  // From the centre the absorbing path is half as long.
  EXPECT_NEAR(radiance(lit, {.origin = {0, 0, 0}, .direction = -up}), std::exp(-0.7), 1e-5);
}

// Transmission of a slab with all inner reflections: T = (1-R)^2 a / (1 - R^2 a^2), with
// a = exp(-absorption d).
TEST(Absorption, SlabPassesWhatItsManyReflectionsLeave) {
  const TracedScene lit(
      SceneBuilder()
          .box({.index_of_refraction = 1.5f, .absorption = 2.0f}, {-5, -5, 0}, {5, 5, 0.25}, false)
          .square({.exitance = pi_f}, {0, 0, -4}, up, 20)
          .build());
  const double R = 0.04, a = std::exp(-0.5);
  EXPECT_NEAR(radiance(lit, {.origin = {0.1, 0.2, 3}, .direction = -up}, to_the_end),
              (1 - R) * (1 - R) * a / (1 - R * R * a * a), 1e-6);
}

// Transmission of two panes: T1 T2 / (1 - R1 R2), 0.857142... for index 1.5.
TEST(ThinPanes, TwoPassWhatTheirReflectionsLeave) {
  const Paint pane{.index_of_refraction = 1.5f, .thin = true};
  const TracedScene lit(SceneBuilder()
                            .square(pane, {0, 0, 0}, up, 5)
                            .square(pane, {0, 0, 0.5}, up, 5)
                            .square({.exitance = pi_f}, {0, 0, -4}, up, 20)
                            .build());
  const double R = pane_reflectance(1.0, 1.5);
  EXPECT_NEAR(radiance(lit, {.origin = {0.1, 0.2, 3}, .direction = -up}, to_the_end),
              (1 - R) * (1 - R) / (1 - R * R), 1e-6);
  EXPECT_NEAR((1 - R) * (1 - R) / (1 - R * R), 0.857142857, 1e-9);
}

TEST(Gloss, GivesTheSameBitsOnOneTwoAndThreeThreads) {
  const TracedScene lit(
      SceneBuilder()
          .box({.reflectance = 0.6f}, {-3, -3, -3}, {3, 3, 3}, true)
          .sphere({.specular = 0.9f, .roughness = 0.2f}, {-1, 0, 0}, 0.9)
          .sphere({.index_of_refraction = 1.5f, .roughness = 0.1f, .absorption = 1}, {1, 0, 0}, 0.9)
          .square({.exitance = pi_f}, {0, 0, 2.9}, -up, 0.5)
          .build());
  Camera camera = camera_towards({0, 2.5, 0.5}, {0, 0, 0}, 70, 24);
  camera.lens_radius = 0.05;
  camera.focus_distance = 2.0;
  BandArray first;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const Image image =
        lit.render(camera, {.pass = Pass::gather, .gather_rays = 64, .sampling = {.most = 32}});
    ASSERT_TRUE(image.radiance.isFinite().all());
    if (threads == 1) first = image.radiance;
    EXPECT_TRUE((image.radiance == first).all()) << threads;
  }
  EXPECT_GT(first.mean(), 0.0f);
}

// A wall of radiance 1, and a rough ball that mostly mirrors the black world before the wall.
TracedScene ball_before_a_wall(const Eigen::Vector3d& ball) {
  return TracedScene(SceneBuilder()
                         .square({.exitance = pi_f}, {3, 0, 0}, {-1, 0, 0}, 5)
                         .sphere({.specular = 0.5f, .roughness = 0.3f}, ball, 0.1)
                         .build());
}

TEST(SampledPixels, AreThoseAloneThatShowGloss) {
  constexpr int size = 24, corners = (size + 1) * (size + 1);
  const Camera camera = camera_towards({0, 0, 0}, {1, 0, 0}, 30, size);
  RenderReport behind, before;
  ball_before_a_wall({-1, 0, 0}).render(camera, {}, &behind);
  EXPECT_EQ(behind.eye_rays, corners);  // the wall is even, so no pixel is split
  ball_before_a_wall({1.5, 0, 0}).render(camera, {}, &before);
  // The ball is 24 * 0.1 / (1.5 tan 15 degrees) = 6 pixels wide and covers parts of fewer than 8^2.
  EXPECT_GT(before.eye_rays, corners);
  EXPECT_LT(before.eye_rays, corners + 64 * SampleOptions::most_by_default);
}

TEST(SampledPixels, BesideSubdividedOnesLoseNoLight) {
  const TracedScene lit = ball_before_a_wall({1.5, 0.013, 0.021});
  const Camera camera = camera_towards({0, 0, 0}, {1, 0, 0}, 30, 24);
  const auto hidden = [&](const RenderOptions& options) {
    return (1.0f - lit.render(camera, options).radiance).sum();
  };
  const float all = hidden({.sampling = {.most = 1024, .least = 1024, .noise = 0.0f}});
  ASSERT_GT(all, 0.0f);
  // About 28 pixels' worth is hidden. The 20 pixels of the ball's edge have standard errors of 2 %
  // each, 0.09 in all, or 0.3 % of what is hidden; six times that, and a percent for pixels within.
  EXPECT_NEAR(hidden({}), all, 0.03f * all);
}

TEST(Depth, OfAThousandMirrorsIsFollowedAndBeyondRefused) {
  const TracedScene lit(SceneBuilder()
                            .square({.specular = 1.0f}, {0, 0, 0}, up, 5)
                            .square({.specular = 1.0f}, {0, 0, 1}, -up, 5)
                            .build());
  const Camera camera = camera_towards({0, 0, 0.5}, {0, 0, 1}, 1, 2);
  RenderReport report;
  lit.render(camera, {.max_depth = deepest_tree}, &report);
  EXPECT_GT(report.depth_cut, 0);
  EXPECT_THROW(lit.render(camera, {.max_depth = 10000}), std::invalid_argument);
}

TEST(Eye, WithinAnOpaqueObjectSeesItsInside) {
  TracedScene lit(SceneBuilder()
                      .sphere({.reflectance = 0.5f}, {0, 0, 0}, 1.0)
                      .sphere({.reflectance = 0.5f, .one_sided = true}, {3, 0, 0}, 1.0)
                      .square({.exitance = pi_f}, {0, 0, 5}, -up, 1)
                      .build());
  const Image within = lit.render(camera_towards({0, 0, 0}, {1, 0, 0}, 60, 8));
  const Image behind = lit.render(camera_towards({3, 0, 0}, {4, 0, 0}, 60, 8));
  EXPECT_TRUE((within.radiance == 0.0f).all());  // no light gets in
  EXPECT_TRUE((behind.radiance == 0.0f).all());
}

// Rough metal under a dim ceiling, beside an upright mirror in which it finds a small bright lamp
// by one direction in thousands. Such a direction would show as a dot hundreds of times as bright
// as the metal around.
TEST(Gloss, ShowsNoDotsOfLampsInMirrors) {
  SceneBuilder room;
  room.square({.specular = 0.8f, .roughness = 0.5f}, {0, 0, 0}, up, 1.0);
  room.square({.specular = 1.0f}, {0, 1.5, 1}, {0, -1, 0}, 1.0);
  room.square({.exitance = pi_f}, {0, 0, 4}, -up, 4.0);
  room.square({.exitance = 1e5f * pi_f, .one_sided = true}, {0, -1.5, 2.25}, {0, 1, 0}, 0.01);
  const TracedScene lit(room.build(), 0.5);
  const Image image = lit.render(camera_towards({0, -1.6, 0.8}, {0, 0, 0}, 20, 48));
  std::vector<float> light;
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) light.push_back(image.radiance(i, 0));
  std::ranges::sort(light);
  const float median = light[light.size() / 2];
  std::printf("rough metal beside a mirror: median %.3f, brightest %.3f\n", double{median},
              double{light.back()});
  EXPECT_GT(median, 0.0f);
  // A sample counts up to a tenth of the pixel's other light, and three in one pixel are rarer than
  // one in 48 x 48 pixels; a fifth is left for what the metal varies by.
  EXPECT_LT(light.back(), 1.5f * median);
}

// A black room with a rough mirror as its floor and a window in its ceiling, under a sky of
// radiance 2, with or without a pane.
TracedScene mirror_under_window(bool has_pane) {
  const auto ceiling = [](double x0, double y0, double x1, double y1) {
    return std::vector<Eigen::Vector3d>{{x0, y0, 3}, {x0, y1, 3}, {x1, y1, 3}, {x1, y0, 3}};
  };
  SceneBuilder room;
  room.square({.specular = 0.8f, .roughness = 0.5f}, {0, 0, 0}, up, 3.0);
  room.polygon({}, ceiling(-3, -3, 1, 3)).polygon({}, ceiling(2, -3, 3, 3));
  room.polygon({}, ceiling(1, -3, 2, 0)).polygon({}, ceiling(1, 1, 2, 3));
  for (const Eigen::Vector3d& to : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0),
                                    Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0)}) {
    room.square({}, 3.0 * to, -to, 3.0);
  }
  if (has_pane) {
    room.polygon({.index_of_refraction = 1.5f, .thin = true}, ceiling(1, 0, 2, 1));
  }
  Scene scene = room.build();
  Sky sky;
  sky.up = up;
  sky.north = Eigen::Vector3d::UnitY();
  sky.gradation = standard_sky(5);
  sky.bright = up;
  sky.scale = constant_spectrum(scene.bands, 2.0f);
  sky.ground = constant_spectrum(scene.bands, 0.0f);
  scene.sky = sky;
  return TracedScene(std::move(scene), 0.5);
}

// Directions towards the window and those of the lobe together find the integral of the lobe over
// the window. The mean of independent keys is within four of its standard errors, and within half a
// percent besides, which the table of the lobe's masking is off by.
TEST(Gloss, ShowsAWindowWithoutBiasAndWithLittleNoise) {
  for (const bool has_pane : {false, true}) {
    const TracedScene lit = mirror_under_window(has_pane);
    const Eigen::Vector3d point(0.1, 0.1, 0), eye(-0.8, -0.2, 1.8);
    const Material& metal = lit.scene.materials[0];
    const SurfaceInteraction interaction{
        .material = metal, .direction = (point - eye).normalized(), .normal = up};
    const RoughLobe lobe(metal, false);
    double share = 0.0, exact = 0.0;
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const Eigen::Vector3d to =
            Eigen::Vector3d(1.0 + (i + 0.5) / steps, (j + 0.5) / steps, 3.0) - point;
        const Eigen::Vector3d d = to.normalized();
        const double p = lobe.density(interaction, d) * d.z() / to.squaredNorm() / (steps * steps);
        const Spectrum passed = lit.direct_light.passed(
            lit.caster, {.origin = point, .direction = d, .origin_group = 0});
        share += p;
        exact += p * 0.8 * 2.0 * double{passed[0]};
      }
    }
    constexpr int keys = 2000;
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < keys; ++k) {
      const double L = radiance(lit, {.origin = eye, .direction = interaction.direction}, {},
                                static_cast<std::uint64_t>(k));
      sum += L;
      squares += L * L;
    }
    const double mean = sum / keys, spread = std::sqrt(squares / keys - mean * mean);
    std::printf("window in rough metal%s: %.4f, exact %.4f, spread %.1f %%\n",
                has_pane ? ", with a pane" : "", mean, exact, 100.0 * spread / mean);
    EXPECT_NEAR(mean, exact, 4.0 * spread / std::sqrt(keys) + 0.005 * exact);
    // Spread of as many independent directions of the lobe alone, a share of which meets the
    // window. Half of that spread is a quarter of the rays for the same noise.
    const double of_lobe = std::sqrt((1.0 - share) / (share * RenderOptions{}.glossy_rays));
    EXPECT_LT(spread / mean, 0.5 * of_lobe);
  }
}

}  // namespace
}  // namespace lightwell::gloss_test
