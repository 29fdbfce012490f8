#include "radiosity/paths/light_path.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "scene/optics.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::light_path_test {
namespace {

using test::add_box;
using test::add_material;
using test::diffuse;

Material glass(const Bands& bands) {
  Material material = diffuse(bands, 0.0f);
  material.dielectric =
      Dielectric{.index_of_refraction = 1.5f, .tint = constant_spectrum(bands, 1.0f)};
  material.one_sided = false;
  return material;
}

// A closed room, turned and moved so that nothing lies on round numbers.
Scene room_with_block_of_glass(double height_above_floor) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f, 1.0f));
  const int clear = add_material(scene, glass(scene.bands));
  add_box(scene, {0, 0, 0}, {1.0, 1.2, 0.9}, {wall, wall, wall, wall, wall, wall}, true);
  add_box(scene, {0.3, 0.4, height_above_floor}, {0.6, 0.7, 0.5 + height_above_floor},
          {clear, clear, clear, clear, clear, clear}, false);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  for (Surface& surface : scene.surfaces) {
    for (auto& v : std::get<PolygonMesh>(surface.shape).vertices) {
      v = turn * v + Eigen::Vector3d(3.1, -1.7, 0.3);
    }
  }
  validate(scene);
  return scene;
}

struct Tally {
  double under_block = 0.0, elsewhere = 0.0, escaped = 0.0, cut = 0.0;
};

// Rays from the middle of the ceiling down on the block's top.
Tally shine_on_block(const Scene& scene) {
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 64);
  constexpr int floor = 4, top_of_block = 11;
  const auto& block = std::get<PolygonMesh>(scene.surfaces[top_of_block].shape).vertices;
  const auto& ceiling = std::get<PolygonMesh>(scene.surfaces[5].shape).vertices;
  const Eigen::Vector3d from = 0.25 * (ceiling[0] + ceiling[1] + ceiling[2] + ceiling[3]);
  Tally tally;
  constexpr int count = 4000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = random_uniform(random_key(i, 1)), v = random_uniform(random_key(i, 2));
    const Eigen::Vector3d at = block[0] + u * (block[1] - block[0]) + v * (block[3] - block[0]);
    const Ray ray{.origin = from, .direction = at - from, .origin_group = 5};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    EXPECT_EQ(hit.facet, top_of_block);
    const PathLosses losses = paths.follow(
        ray, hit, random_key(i, 3), [&](const ElementHit& end, const Spectrum& throughput) {
          (end.facet == floor ? tally.under_block : tally.elsewhere) +=
              static_cast<double>(throughput[0]) / count;
        });
    tally.escaped += static_cast<double>(losses.escaped[0]) / count;
    tally.cut += static_cast<double>(losses.cut[0]) / count;
  }
  return tally;
}

TEST(LightPaths, BlockOfGlassThatStandsOnTheFloorLightsIt) {
  const Tally standing = shine_on_block(room_with_block_of_glass(0.0));
  EXPECT_EQ(standing.escaped, 0.0) << "what enters the block must not pass the floor beneath it";
  EXPECT_NEAR(standing.under_block + standing.elsewhere + standing.cut, 1.0, 1e-6);

  // Standing, the block's bottom touches the floor, which takes up all that comes; a millimetre
  // above it, as physics has it for a real gap, the bottom reflects Fresnel's share first.
  const Tally hovering = shine_on_block(room_with_block_of_glass(1e-3));
  EXPECT_EQ(hovering.escaped, 0.0);
  EXPECT_NEAR(standing.under_block, hovering.under_block, 0.03);
  EXPECT_GT(standing.under_block, 0.5);
}

// N slabs, each of reflectance R1 = 2 r / (1 + r) for one polarisation, pass (1 - R1) / (1 + (N -
// 1) R1) of it, with all reflections within and between the slabs (Stokes 1862). The depth of 8
// surfaces is that of a straight path alone.
TEST(LightPaths, StackOfSlabsPassesTheSumOfAllItsReflections) {
  constexpr int slabs = 4, rays = 1 << 16;
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f));
  const int clear = add_material(scene, glass(scene.bands));
  test::add_polygon(scene, "floor", wall,
                    {{-900, -900, 0}, {900, -900, 0}, {900, 900, 0}, {-900, 900, 0}});
  for (int i = 0; i < slabs; ++i) {
    add_box(scene, {-200, -200, 1.0 + 0.2 * i}, {200, 200, 1.1 + 0.2 * i},
            {clear, clear, clear, clear, clear, clear}, false);
  }
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2000.0});
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  for (const double degrees : {0.0, 60.0, 75.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Ray ray{.origin = {0.1, 0.2, 3.0}, .direction = {std::sin(angle), 0, -std::cos(angle)}};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    double passed = 0.0, cut = 0.0;
    for (std::uint64_t i = 0; i < rays; ++i) {
      const PathLosses losses = paths.follow(ray, hit, random_key(i, 9),
                                             [&](const ElementHit&, const Spectrum& throughput) {
                                               passed += static_cast<double>(throughput[0]) / rays;
                                             });
      cut += static_cast<double>(losses.cut[0]) / rays;
    }
    const PolarisedReflectance face = polarised_reflectance(std::cos(angle), 1.5);
    double T = 0.0;
    for (const double r : {face.s, face.p}) {
      const double R1 = 2.0 * r / (1.0 + r);
      T += 0.5 * (1.0 - R1) / (1.0 + (slabs - 1) * R1);
    }
    // Four standard errors of a share of 2^16 rays.
    EXPECT_NEAR(passed, T, 4.0 * std::sqrt(T * (1.0 - T) / rays)) << degrees;
    EXPECT_LT(cut, 1e-3) << degrees;
  }
}

// Light that enters a square shaft of 0.98, 1 m wide and 40 m deep, at 45 degrees to its axis meets
// its sides 40 times, and arrives at the floor with 0.98^40 = 0.446. A product of 40 floats is off
// by 2^-24 of itself for each factor.
TEST(LightPaths, FollowLightDownAMirroredShaft) {
  Scene scene;
  const int sides = add_material(scene, test::mirror(scene.bands, 0.98f));
  const int floor = add_material(scene, diffuse(scene.bands, 0.5f));
  add_box(scene, {0, 0, 0}, {1, 1, 40}, {sides, sides, sides, sides, floor, sides}, true);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 50.0});
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  const Ray ray{.origin = {0.3, 0.4, 39.9}, .direction = {1, 0, -1}};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  double arrived = 0.0;
  const PathLosses losses = paths.follow(ray, hit, 1, [&](const ElementHit& at, const Spectrum& w) {
    EXPECT_EQ(at.facet, 4);
    arrived += static_cast<double>(w[0]);
  });
  EXPECT_NEAR(arrived / std::pow(double{0.98f}, 40), 1.0, 40 * 0x1p-24);
  EXPECT_EQ(losses.cut[0], 0.0f);
}

/// Light from the floor of a closed box of brushed metal that reflects 0.7, to the floor again;
/// mean of one path of each of `count`, its standard error, and the surfaces that are met.
struct BrushedBox {
  double mean = 0.0, deviation = 0.0, absorbed = 0.0, worst_sum = 0.0;

  explicit BrushedBox(int max_depth) {
    Scene scene;
    Material metal = test::mirror(scene.bands, 0.7f);
    metal.specular_roughness = 0.3f;
    const int walls = add_material(scene, metal);
    const int floor = add_material(scene, diffuse(scene.bands, 0.5f, 1.0f));
    // A small floor in a large box: most paths are long.
    add_box(scene, {0, 0, 0}, {1, 1, 1}, {walls, walls, walls, walls, walls, walls}, true);
    test::add_polygon(scene, "target", floor,
                      {{0.4, 0.4, 0.01}, {0.6, 0.4, 0.01}, {0.6, 0.6, 0.01}, {0.4, 0.6, 0.01}});
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
    const ElementCaster caster(mesh);
    const LightPaths paths(scene, caster, max_depth);
    constexpr int count = 40000;
    double squares = 0.0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const Eigen::Vector3d d =
          cosine_direction(static_cast<float>(random_uniform(random_key(i, 1))),
                           static_cast<float>(random_uniform(random_key(i, 2))));
      const Ray ray{.origin = {0.5, 0.5, 0.01}, .direction = d, .origin_group = 6};
      ElementHit hit;
      caster.closest_hits({&ray, 1}, {&hit, 1});
      double arrived = 0.0;
      const PathLosses losses = paths.follow(ray, hit, random_key(i, 3),
                                             [&](const ElementHit&, const Spectrum& throughput) {
                                               arrived += static_cast<double>(throughput[0]);
                                             });
      const double lost =
          static_cast<double>(losses.absorbed[0] + losses.cut[0] + losses.escaped[0]);
      worst_sum = std::max(worst_sum, std::abs(arrived + lost - 1.0));
      mean += arrived / count;
      absorbed += static_cast<double>(losses.absorbed[0]) / count;
      squares += arrived * arrived / count;
    }
    deviation = std::sqrt((squares - mean * mean) / count);
  }
};

// Paths that may meet 128 mirrors anyway are not ended by chance.
TEST(LightPaths, WeakPathsEndByChanceAndLoseNothingInTheMean) {
  const BrushedBox by_chance(2), to_the_end(128);
  const double both = std::hypot(by_chance.deviation, to_the_end.deviation);
  EXPECT_NEAR(by_chance.mean, to_the_end.mean, 3.0 * both);
  EXPECT_NEAR(by_chance.absorbed, to_the_end.absorbed, 3.0 * both);
  // Some two hundred roundings of float.
  EXPECT_LT(by_chance.worst_sum, 1e-5);
  EXPECT_LT(to_the_end.worst_sum, 1e-5);
}

}  // namespace
}  // namespace lightwell::light_path_test
