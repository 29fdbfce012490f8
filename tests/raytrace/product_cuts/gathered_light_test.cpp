#include "raytrace/product_cuts/gathered_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "scene/parallel.h"
#include "scene/place_at_rest.h"
#include "tests/raytrace/product_cuts/lamp_hall.h"
#include "tests/sample_mean.h"

namespace lightwell::gathered_light_test {
namespace {

constexpr int keys = 64;

// The radiance of points with each light asked by each and by itself, over keys: beside brighter
// lights a light gets few rays, whose visible share is right to some 1e-4 in the mean.
test::SampleMean of_all_lights(const TracedScene& lit, const std::vector<PixelPoint>& points) {
  constexpr int few_keys = 16;
  std::vector<double> found;
  for (int key = 0; key < few_keys; ++key) {
    double sum = 0.0;
    for (const PixelPoint& point : points) {
      LightQuery query{.at = point.at,
                       .key = static_cast<std::uint64_t>(key),
                       .shadows = {.min_rays = 16, .max_rays = 16},
                       .base = point.base.get(),
                       .relief = point.relief ? &*point.relief : nullptr};
      for (int light = 0; light < lit.direct_light.light_count(); ++light) {
        const std::vector<LightSample> one{{.light = light}};
        query.asked = &one;
        sum += static_cast<double>(
            (point.weight * lit.direct_light.irradiance(lit.caster, query)).mean());
      }
    }
    found.push_back(sum);
  }
  return test::mean_of(found);
}

struct Drawn {
  test::SampleMean radiance{};
  double noise = 0.0, asked = 0.0;  ///< root mean square, mean
};

Drawn of_product_cuts(const TracedScene& lit, const std::vector<PixelPoint>& points, double share) {
  std::vector<double> found;
  Drawn drawn;
  for (int key = 0; key < keys; ++key) {
    const GatheredLight light =
        gathered_light(lit.direct_light, points,
                       {.key = static_cast<std::uint64_t>(key),
                        .shadows = {.min_rays = 4, .max_rays = 4, .cluster_share = share}});
    found.push_back(static_cast<double>(light.radiance.mean()));
    drawn.noise += light.noise * light.noise / keys;
    drawn.asked += static_cast<double>(light.asked) / keys;
  }
  drawn.noise = std::sqrt(drawn.noise);
  drawn.radiance = test::mean_of(found);
  return drawn;
}

// `bend`: changes some points.
template <class Bend>
void expect_the_light_of_all(const Bend& bend) {
  const TracedScene lit(test::lamp_hall(200, 200));
  double said = 0.0, is = 0.0;
  int lit_clusters = 0;
  for (int cluster = 0; cluster < 12; ++cluster) {
    std::vector<PixelPoint> points =
        test::points_about(lit, cluster, 16, cluster % 2 == 0 ? 0.1 : 1.5);
    for (std::size_t i = 0; i < points.size(); ++i) bend(i, points[i]);
    const test::SampleMean all = of_all_lights(lit, points);
    for (PixelPoint& point : points) point.about = all.value / static_cast<double>(points.size());
    const Drawn drawn = of_product_cuts(lit, points, 0.02);
    if (!(all.value > 0.0)) continue;
    ++lit_clusters;
    EXPECT_NEAR(drawn.radiance.value, all.value,
                4.0 * std::hypot(all.standard_error, drawn.radiance.standard_error))
        << cluster;
    EXPECT_LT(drawn.asked, 0.5 * 16 * lit.direct_light.light_count());
    // The standard error is that of the mean over keys.
    is += std::pow(drawn.radiance.standard_error / all.value, 2) * keys;
    said += std::pow(drawn.noise / all.value, 2);
  }
  EXPECT_GT(lit_clusters, 8);
  std::printf("noise of product cuts %.2f %%, by pairs %.2f %%\n",
              100.0 * std::sqrt(is / lit_clusters), 100.0 * std::sqrt(said / lit_clusters));
  // Members from two halves of the chances differ by more than members drawn apart; shadow rays of
  // single lights, which pairs do not say, add less than as much again.
  EXPECT_GT(said, 0.5 * is);
  EXPECT_LT(said, 8.0 * is);
}

TEST(GatheredLight, IsTheLightOfAllLightsAtAllPointsInTheMean) {
  expect_the_light_of_all([](std::size_t, PixelPoint&) {});
}

TEST(GatheredLight, WeighsLightByCoatAndRelief) {
  Material material;
  material.coat = Coat{.index_of_refraction = 1.5f};
  material.specular = Spectrum::Ones(3);
  const auto base = std::make_shared<const CoatedBase>(material);
  expect_the_light_of_all([&](std::size_t i, PixelPoint& point) {
    if (i % 2 == 0) point.base = base;
    if (i % 3 == 0) {
      point.relief =
          ReliefSlope{.normal = point.at.normal, .rise = 0.5 * point.at.normal.unitOrthogonal()};
    }
  });
}

// A row of 32 lamps 10 m above two points of which one is turned by 60 degrees: what they get is 2
// to 1, to 4 % since the row is short against its distance. The variance of 2 and 1 is 1/4, over
// the square of their mean 1/9.
TEST(GatheredLight, KnowsHowFarPointsDiffer) {
  Scene scene =
      SceneBuilder().box({.reflectance = 0.5f}, {-20, -20, 0}, {20, 20, 40}, true).build();
  for (int k = 0; k < 32; ++k) {
    scene.lamps.push_back({.name = "lamp" + std::to_string(k),
                           .position = {0.1 * (k - 15.5), 0, 20},
                           .intensity = constant_spectrum(scene.bands, 100.0f)});
  }
  const TracedScene lit(scene);
  std::vector<PixelPoint> points;
  for (const double y : {0.0, std::sqrt(3.0)}) {
    points.push_back({.at = {{0, 0, 10}, Eigen::Vector3d(0, y, 1).normalized(), -1},
                      .weight = Spectrum::Ones(3),
                      .about = 10.0,
                      .caster = &lit.caster});
  }
  const GatheredLight light = gathered_light(lit.direct_light, points, {.key = 1});
  const double mean = static_cast<double>(light.radiance.mean()) / 2.0;
  EXPECT_NEAR(light.spread / (mean * mean), 1.0 / 9.0, 2.0 * 0.04 / 3.0);
}

// A hall in which 400 lights shine, seen through a wide lens.
Camera blurred_camera(int pixels) {
  Camera camera = camera_towards({-9, -9, 2}, {4, 3, 2}, 60, pixels);
  camera.lens_radius = 0.3;
  camera.focus_distance = 4.0;
  return camera;
}

// `samples` of each pixel.
RenderOptions sampled(ManyLights many_lights, int samples) {
  return {.shadows = {.min_rays = 1, .max_rays = 1, .many_lights = many_lights},
          .sampling = {.most = samples, .least = 16, .noise = 0.0f}};
}

// Both pictures have the same samples, so that they differ by what is drawn alone: about 2 % of a
// pixel, of which 256 leave 0.1 % to the mean.
TEST(GatheredLight, MakesThePictureOfAllLightsInTheMean) {
  TracedScene lit(test::lamp_hall(200, 200));
  lit.set_direct([](const Eigen::Vector3d&) { return 3.0f; });
  const Image brute = lit.render(blurred_camera(16), sampled(ManyLights::all, 64)),
              cut = lit.render(blurred_camera(16), sampled(ManyLights::lightcuts, 64));
  const double expected = brute.radiance.cast<double>().mean(),
               found = cut.radiance.cast<double>().mean();
  const double off = std::sqrt((cut.radiance / brute.radiance - 1.0f).square().mean());
  std::printf("mean radiance %.5f of all lights, %.5f of product cuts; pixels %.2f %% off\n",
              expected, found, 100.0 * off);
  EXPECT_NEAR(found, expected, 0.005 * expected);
  EXPECT_LT(off, 0.04);
}

TEST(GatheredLight, HasTheSameBitsForAnyNumberOfThreads) {
  Scene scene = test::lamp_hall(50, 50);
  scene.motions = {{.name = "m",
                    .keys = {{.time = 0.0, .translation = {0, -1, 0}},
                             {.time = 1.0, .translation = {0, 1, 0}}}}};
  scene.surfaces[3].motion = 0;
  place_at_rest(scene, 0.5);
  const TracedScene lit(scene);
  Camera camera = blurred_camera(16);
  camera.shutter_open = 0.25;
  camera.shutter_close = 0.75;
  const auto picture = [&](int threads) {
    const ThreadLimit limit(threads);
    return lit.render(camera, sampled(ManyLights::lightcuts, 64));
  };
  const Image one = picture(1), two = picture(2);
  EXPECT_TRUE((one.radiance == two.radiance).all());
  EXPECT_GT(one.radiance.minCoeff(), 0.0f);
}

}  // namespace
}  // namespace lightwell::gathered_light_test
