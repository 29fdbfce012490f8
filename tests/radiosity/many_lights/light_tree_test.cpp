#include "radiosity/many_lights/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/projected_picture.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::light_tree_test {
namespace {

using Eigen::Vector3d;

double uniform(int k, int use) {
  return random_uniform(random_key(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(use)));
}

Vector3d direction(int k, int use) {
  const double z = 2.0 * uniform(k, use) - 1.0, phi = 2.0 * std::numbers::pi * uniform(k, use + 1);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A beam narrower than a step of IntensityByAngle, beside a wide part that ends at once at 130
/// degrees and is twice as bright along C = 90 as along C = 0.
SharedWeb narrow_web() {
  Eigen::ArrayXXd values(2, 5);
  values << 1.0, 1.0, 9.0, 1.0, 0.5,  //
      1.0, 1.0, 9.0, 2.0, 1.0;
  return std::make_shared<const PhotometricWeb>(
      std::vector<double>{0.0, 90.0}, std::vector<double>{0.0, 17.0, 17.5, 18.0, 130.0}, values);
}

/// A picture of 8 x 6 texels of many colours; every other one in focus at 3 m alone.
SharedPicture picture(int k) {
  std::vector<Texture::Code> codes;
  for (int i = 0; i < 8 * 6 * 3; ++i) {
    codes.push_back(static_cast<Texture::Code>(65535.0 * uniform(i, 40)));
  }
  ProjectorOptics optics{.beam = 0.2 + uniform(k, 41), .shutters = {.left = 0.3 * uniform(k, 42)}};
  if (k % 2 == 0) optics.focus = 3.0;
  return std::make_shared<const ProjectedPicture>(
      std::make_shared<const PictureSums>(std::make_shared<const Texture>(8, 6, 3, codes)), optics,
      RgbBasis());
}

/// A black hall of 20 x 20 x 6 m with screens, `panels` that face everywhere, and `lamps`: spots,
/// lamps with openings, measured ones, coloured ones that project a picture, and even ones.
struct Hall {
  Scene scene;
  PatchMesh mesh;

  /// `down`: panels face down instead.
  Hall(int panels, int lamps, bool down = false) {
    const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
    test::add_box(scene, {-10, -10, 0}, {10, 10, 6}, {black, black, black, black, black, black},
                  true);
    const int screens = 6;
    for (int k = 0; k < screens; ++k) {
      const double x = -8.0 + 3.0 * k;
      test::add_box(scene, {x, -4, 1}, {x + 0.2, 4, 4}, {black, black, black, black, black, black},
                    false);
    }
    for (int k = 0; k < panels; ++k) {
      const float M = 1.0f + 9.0f * static_cast<float>(uniform(k, 1));
      const int bright = test::add_material(scene, test::diffuse(scene.bands, 0.0f, M));
      const Vector3d at = place(k, 2);
      const Vector3d normal = down ? Vector3d(-Vector3d::UnitZ()) : direction(k, 5);
      Vector3d a, b;
      tangent_frame(normal, a, b);
      const double h = 0.02 + 0.1 * uniform(k, 7);
      test::add_polygon(
          scene, "panel" + std::to_string(k), bright,
          {at - h * a - h * b, at + h * a - h * b, at + h * a + h * b, at - h * a + h * b});
    }
    for (int k = 0; k < lamps; ++k) {
      Lamp lamp{.name = "lamp" + std::to_string(k),
                .position = place(k, 12),
                .axes = lamp_axes(direction(k, 15)),
                .intensity = constant_spectrum(scene.bands,
                                               1.0f + 9.0f * static_cast<float>(uniform(k, 17)))};
      if (k % 3 == 0) lamp.shape = SpotCone{.inner = 0.2, .outer = 0.3 + uniform(k, 18)};
      if (k % 6 == 2) lamp.shape = narrow_web();
      if (k % 6 == 5) {
        lamp.shape = picture(k / 6);
        lamp.intensity *= Eigen::Array3f(1.0f, 0.2f, 0.5f);
      }
      if (k % 3 == 1) lamp.opening = {.along_c0 = 0.6 * uniform(k, 19), .along_c90 = 0.1};
      scene.lamps.push_back(lamp);
    }
    mesh = build_patches(scene, {.max_patch_size = 4.0, .elements_per_patch_edge = 1});
  }

  static Vector3d place(int k, int use) {
    return {-9.5 + 19.0 * uniform(k, use), -9.5 + 19.0 * uniform(k, use + 1),
            4.2 + 1.5 * uniform(k, use + 2)};
  }
};

SurfacePoint point(int k) {
  return {.position = {-9.0 + 18.0 * uniform(k, 30), -9.0 + 18.0 * uniform(k, 31),
                       0.1 + 4.0 * uniform(k, 32)},
          .normal = direction(k, 33),
          .facet = -1};
}

/// The unobstructed irradiance of each light at a point, mean of the bands, W/m^2.
std::vector<double> unoccluded(const DirectLight& light, const SurfacePoint& at) {
  std::vector<double> E;
  for (const Emitter& emitter : light.emitters()) {
    E.push_back(light.unoccluded_form_factor(emitter, at) * emitter.exitance.mean());
  }
  for (const FreeSource& source : light.free_sources()) {
    E.push_back(unoccluded_kernel(source, at.position, at.normal) *
                light_towards(source, at.position).mean());
  }
  return E;
}

LightTree tree_of(const DirectLight& light) {
  std::vector<LightBound> bounds = bounds_of(light.emitters());
  const auto of_lamps = bounds_of(light.free_sources(), static_cast<int>(light.emitters().size()));
  bounds.insert(bounds.end(), of_lamps.begin(), of_lamps.end());
  return LightTree(std::move(bounds));
}

/// Checks the bound of a node and of all nodes below; returns the light of the node.
double expect_bounded(const LightTree& tree, const LightTree::Seen& seen, const SurfacePoint& at,
                      const std::vector<double>& E) {
  double sum = 0.0;
  if (tree.is_cluster(seen.node)) {
    for (const auto& half : tree.halves(seen.node, at)) sum += expect_bounded(tree, half, at, E);
  } else {
    sum = E[static_cast<std::size_t>(tree.light(seen.node))];
  }
  // Intensities are floats.
  EXPECT_LE(sum, seen.bound * (1.0 + 1e-6) + 1e-12) << "node " << seen.node;
  return sum;
}

void expect_bounds(const Hall& hall) {
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  for (int k = 0; k < 200; ++k) {
    const SurfacePoint at = point(k);
    const std::vector<double> E = unoccluded(light, at);
    double all = 0.0;
    for (const double of_one : E) all += of_one;
    // Two orders of the same sum of at most 120 terms, each rounded by 2^-53 of the sum.
    EXPECT_NEAR(expect_bounded(tree, tree.root(at), at, E), all, 2.0 * 120.0 * 0x1p-53 * all);
  }
}

TEST(LightTree, NoNodeGivesMoreThanItsBound) {
  expect_bounds(Hall(60, 60));
}

// Points of surfaces that send on light, some of them nearer than the limit of their kernel.
TEST(LightTree, NoNodeOfVirtualLightsGivesMoreThanItsBound) {
  const Hall hall(1, 0);
  std::vector<FreeSource> sources;
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {
    sources.push_back(
        {.number = k,
         .light = constant_spectrum(hall.scene.bands, 1.0f + k % 7),
         .shape =
             VirtualLight{.position = point(k).position, .normal = direction(k, 40), .most = 0.3}});
  }
  const LightTree tree(bounds_of(sources, 0));
  const DirectLight light(hall.scene, std::move(sources));
  EXPECT_EQ(light.light_count(), count);
  for (int k = 0; k < 200; ++k) {
    const SurfacePoint at = point(k + count);
    expect_bounded(tree, tree.root(at), at, unoccluded(light, at));
  }
}

TEST(LightTree, PanelsThatFaceDownGiveNothingAbove) {
  const Hall hall(60, 0, true);
  expect_bounds(hall);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  const SurfacePoint above{.position = {0, 0, 5.9}, .normal = -Vector3d::UnitZ(), .facet = -1};
  EXPECT_EQ(tree.root(above).bound, 0.0);
}

// The chances of the lights of a cluster, with those of none, add up to 1, and each light that
// gives something has one: the mean of light over chance is then the light of the cluster.
TEST(LightTree, DrawsEveryLightByItsChance) {
  const Hall hall(20, 20);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  int clusters = 0;
  for (int k = 0; k < 20; ++k) {
    const SurfacePoint at = point(k);
    const std::vector<double> E = unoccluded(light, at);
    for (const CutPart& part : light_cut(roots({&tree}, at), at, {.share = 0.2, .most = 1 << 20})) {
      if (!tree.is_cluster(part.seen.node)) continue;
      ++clusters;
      // The chances follow from how often each light is drawn, to 1/draws at each of its ends.
      constexpr int draws = 1 << 14;
      std::map<int, double> drawn, chance;
      for (int i = 0; i < draws; ++i) {
        const LightTree::Draw draw = tree.draw(part.seen.node, at, (i + 0.5) / draws);
        drawn[draw.light] += 1.0 / draws;
        chance[draw.light] = draw.chance;
      }
      for (const auto& [number, share] : drawn) {
        if (number < 0) continue;
        EXPECT_NEAR(share, chance[number], 2.0 / draws);
        // Weights hold cosines and distances of middles, where bounds hold the nearest point's.
        EXPECT_LE(E[static_cast<std::size_t>(number)] / chance[number], 4.0 * part.seen.bound);
      }
    }
  }
  EXPECT_GT(clusters, 20);
}

TEST(LightTree, CutsHaveNoClusterAboveTheShare) {
  const Hall hall(100, 100);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  for (int k = 0; k < 50; ++k) {
    const SurfacePoint at = point(k);
    // A finer cut has the single lights of a coarser one, and more. Halves that give nothing are
    // left out, so that the finer cut may have fewer parts.
    int before = 0;
    for (const double share : {0.1, 0.02, 0.0}) {
      int singles = 0;
      for (const CutPart& part :
           light_cut(roots({&tree}, at), at, {.share = share, .light = 7.0, .most = 1 << 20})) {
        if (tree.is_cluster(part.seen.node)) {
          EXPECT_LE(part.seen.bound, share * 7.0);
        } else {
          ++singles;
        }
      }
      EXPECT_GE(singles, before);
      before = singles;
    }
    // Single lights alone, as far as they give anything.
    for (const CutPart& part :
         light_cut(roots({&tree}, at), at, {.share = 0.0, .light = 7.0, .most = 1 << 20})) {
      EXPECT_FALSE(tree.is_cluster(part.seen.node));
    }
  }
}

TEST(LightTree, ManyLightsAtOnePlaceAreOneCluster) {
  std::vector<LightBound> lights(1000);
  for (int k = 0; k < 1000; ++k) {
    lights[k].light = k;
    lights[k].box = {Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
    lights[k].intensity.fill(2.0f);
  }
  const LightTree tree(std::move(lights));
  const SurfacePoint at{.position = {1, 2, 0}, .normal = Vector3d::UnitZ()};
  const LightTree::Seen root = tree.root(at);
  // Sums of powers of two times 1000 are exact in float; the quotient by 3^2 and the cosine take
  // four roundings, the quotient by 3^3 five.
  EXPECT_NEAR(root.bound, 1000 * 2.0 / 9.0, 4.0 * 0x1p-53 * root.bound);
  EXPECT_NEAR(root.about, root.bound, 9.0 * 0x1p-53 * root.bound);
  const LightTree::Draw draw = tree.draw(root.node, at, 0.75);
  // Ten halvings, each the product of a share with three roundings.
  EXPECT_NEAR(draw.chance, 1e-3, 10.0 * 4.0 * 0x1p-53 * 1e-3);
}

// 300 panels and 300 lamps behind screens: the mean over keys is the sum over all lights, and the
// noise is what drawn_noise says.
TEST(LightTree, ClustersGiveTheLightOfAllInTheMean) {
  const Hall hall(300, 300);
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
    const SurfacePoint at = point(k);
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

TEST(LightTree, FewLightsHaveNoClusters) {
  const Hall hall(20, 20);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  EXPECT_FALSE(light.has_emitter_clusters());
  const ShadowOptions fine{.cluster_share = 0.0}, coarse{.cluster_share = 0.5};
  for (int k = 0; k < 20; ++k) {
    const Spectrum a = light.irradiance(caster, {.at = point(k), .shadows = fine}),
                   b = light.irradiance(caster, {.at = point(k), .shadows = coarse});
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
  const Hall hall(200, 200);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  constexpr int keys = 64;
  const auto variance = [](const Eigen::ArrayXd& E) {
    return (E - E.mean()).square().sum() / (keys - 1);
  };
  int lit = 0;
  for (int k = 0; k < 16; ++k) {
    const Eigen::ArrayXd all = by_method(light, caster, point(k), ManyLights::all, keys),
                         some = by_method(light, caster, point(k), ManyLights::importance, keys);
    if (!(all.mean() > 0.0)) continue;
    ++lit;
    // Four standard errors of both means.
    EXPECT_NEAR(some.mean(), all.mean(), 4.0 * std::sqrt((variance(all) + variance(some)) / keys))
        << k;
  }
  EXPECT_GT(lit, 8);
}

TEST(ManyLights, InOrderMissNoMoreThanTheRestMayGive) {
  const Hall hall(200, 200);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  for (int k = 0; k < 40; ++k) {
    const SurfacePoint at = point(k);
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
  const Hall hall(400, 400);
  const ElementCaster caster(hall.mesh);
  const DirectLight light(hall.scene, hall.mesh);
  const auto asked = [&](ManyLights method) {
    double sum = 0.0;
    constexpr int points = 50;
    for (int k = 0; k < points; ++k) {
      const LightQuery query{.at = point(k),
                             .shadows = {.cluster_share = 0.05, .many_lights = method}};
      sum += static_cast<double>(light.asked(caster, query)) / points;
    }
    return sum;
  };
  EXPECT_EQ(asked(ManyLights::all), light.light_count());
  for (const ManyLights method :
       {ManyLights::lightcuts, ManyLights::sorted, ManyLights::importance}) {
    std::printf("lights asked: %.0f of %d\n", asked(method), light.light_count());
    EXPECT_LT(asked(method), 0.5 * light.light_count());
    EXPECT_GT(asked(method), 1.0);
  }
}

}  // namespace
}  // namespace lightwell::light_tree_test
