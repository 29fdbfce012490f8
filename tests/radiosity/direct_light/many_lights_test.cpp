// Direct light of points that choose among many lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "tests/radiosity/many_lights/many_lamp_hall.h"

namespace lightwell::many_lights_test {
namespace {

using test::ManyLampHall, test::point_in_hall, test::unoccluded;

// 300 panels and 300 lamps behind screens: the mean over keys is the sum over all lights, and the
// noise is what drawn_noise says.
TEST(ManyLights, ClustersGiveTheLightOfAllInTheMean) {
  const ManyLampHall hall(300, 300);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  ASSERT_TRUE(light.has_emitter_clusters());
  constexpr int keys = 64;
  const auto by_key = [&](const SurfacePoint& at, double share, double& said) {
    Eigen::ArrayXd E(keys);
    said = 0.0;
    for (int i = 0; i < keys; ++i) {
      EmitterVisibility visibility;
      const LightQuery query{.at = at,
                             .key = static_cast<std::uint64_t>(i),
                             .shadows = {.min_rays = 64, .max_rays = 256, .cluster_share = share}};
      E[i] = light.irradiance(caster, query, &visibility).mean();
      said += visibility.drawn_noise * visibility.drawn_noise / keys;
    }
    return E;
  };
  const auto variance = [](const Eigen::ArrayXd& E) {
    return (E - E.mean()).square().sum() / (keys - 1);
  };
  double said = 0.0, found = 0.0;
  int lit = 0;
  for (int k = 0; k < 24; ++k) {
    const SurfacePoint at = point_in_hall(k);
    double none = 0.0, of_clusters = 0.0;
    const Eigen::ArrayXd all = by_key(at, 0.0, none), clustered = by_key(at, 0.02, of_clusters);
    if (!(all.mean() > 0.0)) continue;
    ++lit;
    EXPECT_EQ(none, 0.0);
    // Four standard errors of both means.
    EXPECT_NEAR(clustered.mean(), all.mean(),
                4.0 * std::sqrt((variance(all) + variance(clustered)) / keys))
        << k;
    const double squared = all.mean() * all.mean();
    said += of_clusters / squared;
    found += std::max(0.0, variance(clustered) - variance(all)) / squared;
  }
  EXPECT_GT(lit, 12);
  // Members from two halves of the chances differ by more than members drawn apart.
  EXPECT_GT(said, 0.5 * found);
  EXPECT_LT(said, 8.0 * found);
}

// One of 300 panels and 300 lamps stands for all, behind screens. Draws by what each may give leave
// less noise than draws with equal chances, whose variance is N sum E_i^2 - E^2.
TEST(ManyLights, OneStandsForAllInTheMean) {
  const ManyLampHall hall(300, 300);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  constexpr int keys = 2048;
  double variances = 0.0, of_equal_chances = 0.0;
  for (int k = 0; k < 24; ++k) {
    const SurfacePoint at = point_in_hall(k);
    double all = 0.0, squares = 0.0;
    for (int i = 0; i < light.light_count(); ++i) {
      const std::vector<LightSample> one{{.light = i}};
      const double E =
          light
              .irradiance(caster,
                          {.at = at, .shadows = {.min_rays = 256, .max_rays = 256}, .asked = &one})
              .mean();
      all += E;
      squares += E * E;
    }
    Eigen::ArrayXd E(keys);
    for (int i = 0; i < keys; ++i) {
      E[i] = light
                 .irradiance(caster, {.at = at,
                                      .key = static_cast<std::uint64_t>(i),
                                      .shadows = {.min_rays = 1, .max_rays = 1},
                                      .one_stands_for_all = true})
                 .mean();
    }
    const double variance = (E - E.mean()).square().sum() / (keys - 1);
    // Four standard errors of the draws, and four of 256 shadow rays, half of which pass at most.
    EXPECT_NEAR(E.mean(), all, 4.0 * (std::sqrt(variance / keys) + 0.5 * std::sqrt(squares / 256)))
        << k;
    variances += variance;
    of_equal_chances += light.light_count() * squares - all * all;
  }
  EXPECT_GT(variances, 0.0);
  EXPECT_LT(variances, of_equal_chances);
}

TEST(ManyLights, FewLightsHaveNoClusters) {
  const ManyLampHall hall(20, 20);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  EXPECT_FALSE(light.has_emitter_clusters());
  const ShadowOptions fine{.cluster_share = 0.0}, coarse{.cluster_share = 0.5};
  for (int k = 0; k < 20; ++k) {
    const Spectrum a = light.irradiance(caster, {.at = point_in_hall(k), .shadows = fine}),
                   b = light.irradiance(caster, {.at = point_in_hall(k), .shadows = coarse});
    EXPECT_TRUE((a == b).all());
  }
}

// The light of points by one of the methods, mean of the bands, over keys.
Eigen::ArrayXd by_method(const DirectLight& light, const ElementCaster& caster,
                         const SurfacePoint& at, ManyLights method, int keys) {
  Eigen::ArrayXd E(keys);
  for (int i = 0; i < keys; ++i) {
    E[i] = light
               .irradiance(caster, {.at = at,
                                    .key = static_cast<std::uint64_t>(i),
                                    .shadows = {.min_rays = 64,
                                                .max_rays = 256,
                                                .cluster_share = 0.02,
                                                .many_lights = method}})
               .mean();
  }
  return E;
}

TEST(ManyLights, OfImportanceGiveTheLightOfAllInTheMean) {
  const ManyLampHall hall(200, 200);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  constexpr int keys = 64;
  const auto variance = [](const Eigen::ArrayXd& E) {
    return (E - E.mean()).square().sum() / (keys - 1);
  };
  int lit = 0;
  for (int k = 0; k < 16; ++k) {
    const Eigen::ArrayXd all = by_method(light, caster, point_in_hall(k), ManyLights::all, keys),
                         some = by_method(light, caster, point_in_hall(k), ManyLights::importance,
                                          keys);
    if (!(all.mean() > 0.0)) continue;
    ++lit;
    // Four standard errors of both means.
    EXPECT_NEAR(some.mean(), all.mean(), 4.0 * std::sqrt((variance(all) + variance(some)) / keys))
        << k;
  }
  EXPECT_GT(lit, 8);
}

TEST(ManyLights, InOrderMissNoMoreThanTheRestMayGive) {
  const ManyLampHall hall(200, 200);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  for (int k = 0; k < 40; ++k) {
    const SurfacePoint at = point_in_hall(k);
    double unobstructed = 0.0;
    for (const double E : unoccluded(light, at)) unobstructed += E;
    const double all = by_method(light, caster, at, ManyLights::all, 1)[0],
                 some = by_method(light, caster, at, ManyLights::sorted, 1)[0];
    // The rest may give 2 % of the light, and counts with a visibility between none and all. What
    // lights may give is known to a factor of two for panels that are near.
    EXPECT_NEAR(some, all, 2.0 * 0.02 * unobstructed) << k;
  }
}

TEST(ManyLights, AskFewerThanAll) {
  const ManyLampHall hall(400, 400);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  const auto asked = [&](ManyLights method) {
    double sum = 0.0;
    constexpr int points = 50;
    for (int k = 0; k < points; ++k) {
      const LightQuery query{.at = point_in_hall(k),
                             .shadows = {.cluster_share = 0.05, .many_lights = method}};
      sum += static_cast<double>(light.asked(caster, query)) / points;
    }
    return sum;
  };
  EXPECT_EQ(asked(ManyLights::all), light.light_count());
  for (const ManyLights method :
       {ManyLights::lightcuts, ManyLights::sorted, ManyLights::importance}) {
    std::printf("lights asked: %.0f of %d\n", asked(method), light.light_count());
    // A choice among lights that asks half of them saves nothing, since choosing takes time too.
    EXPECT_LT(asked(method), 0.5 * light.light_count());
    EXPECT_GT(asked(method), 1.0);
  }
}

}  // namespace
}  // namespace lightwell::many_lights_test
