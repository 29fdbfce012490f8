// Aimed rays find small bright patches, and do not change the mean.
#include "radiosity/gather/bright_patches.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/gather/final_gather.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::bright_patches_test {
namespace {

// A room of 4 m with a tile of `side` metres a little below the middle of its ceiling, and
// optionally a shelf that hides half of the tile from the floor.
struct Room {
  double side;
  bool with_shelf;
  Scene scene = [this] {
    Scene made;
    const int grey = test::add_material(made, test::diffuse(made.bands, 0.5f));
    test::add_box(made, {0, 0, 0}, {4, 4, 4}, {grey, grey, grey, grey, grey, grey}, true);
    test::add_polygon(made, "tile", grey, tile());
    if (with_shelf) {
      test::add_polygon(made, "shelf", grey,
                        {{2, 1.5, 3.8}, {2, 2.5, 3.8}, {3, 2.5, 3.8}, {3, 1.5, 3.8}});
    }
    return made;
  }();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  ElementCaster caster{mesh};
  DirectLight direct_light{scene, mesh};

  // Counter-clockwise, seen from below.
  Loop tile() const {
    const double a = 2.0 - 0.5 * side, b = 2.0 + 0.5 * side, z = 3.9;
    return {{a, a, z}, {a, b, z}, {b, b, z}, {b, a, z}};
  }
  // Radiosity at vertices, 1 but for the tile's lower side.
  BandArray radiosity(float of_tile) const {
    BandArray B = BandArray::Ones(mesh.vertex_count(), 3);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.facet[e] != 6 || element_center(mesh, e).normal.z() > 0.0) continue;
      for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = of_tile;
    }
    return B;
  }
};

struct Statistics {
  double mean = 0.0, deviation = 0.0;
};

// Mean and deviation of the irradiance at a point of the floor.
Statistics gathered(const Room& room, const BandArray& B, const Eigen::Vector3d& receiver, int rays,
                    int replicas) {
  const GatherPoint point{.position = receiver, .normal = {0, 0, 1}, .facet = 4};
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < replicas; ++i) {
    const GatheredIrradiance E =
        gather_indirect({room.scene, room.caster, room.direct_light}, B, std::array{point},
                        {.rays = rays, .replica = static_cast<std::uint64_t>(i)});
    sum += E.indirect(0, 0);
    squares += std::pow(double{E.indirect(0, 0)}, 2);
  }
  const double mean = sum / replicas;
  return {mean, std::sqrt(std::max(0.0, squares / replicas - mean * mean))};
}

TEST(BrightPatches, AreNoneWhereAllIsOfOneKind) {
  const Room room{.side = 0.1, .with_shelf = false};
  EXPECT_TRUE(BrightPatches(room.scene, room.caster, room.radiosity(1.0f)).is_empty());
  EXPECT_TRUE(BrightPatches(room.scene, room.caster, room.radiosity(30.0f)).is_empty());
  EXPECT_FALSE(BrightPatches(room.scene, room.caster, room.radiosity(34.0f)).is_empty());
}

TEST(BrightPatches, GiveWhatTheFormFactorSays) {
  const Room room{.side = 0.1, .with_shelf = false};
  constexpr float bright = 1000.0f;
  const BandArray B = room.radiosity(bright);
  const Eigen::Vector3d receiver{1.2, 0.7, 0.0};
  const double F = point_to_polygon(receiver, {0, 0, 1}, room.tile());
  const double E = 1.0 + (bright - 1.0) * F;
  constexpr int replicas = 200;
  const Statistics estimate = gathered(room, B, receiver, 256, replicas);
  std::printf("F %.2e, E %.4f, gathered %.4f, deviation %.4f\n", F, E, estimate.mean,
              estimate.deviation);
  EXPECT_NEAR(estimate.mean, E, 4.0 * estimate.deviation / std::sqrt(replicas));
  // A cosine-distributed ray meets the tile with probability F, and 256 such rays alone would have
  // a deviation of (bright - 1) sqrt(F / 256). Aimed rays have the variation of the form factor's
  // kernel over the tile, here at most 5 % of the tile's light.
  EXPECT_LT(estimate.deviation, 0.05 * (E - 1.0));
  EXPECT_GT((bright - 1.0) * std::sqrt(F / 256.0), 10.0 * estimate.deviation);
}

// Near the tile cosine-distributed rays are better than aimed ones; both together have no bias.
TEST(BrightPatches, GiveTheSameNearBy) {
  const Room room{.side = 1.0, .with_shelf = false};
  constexpr float bright = 100.0f;
  const BandArray B = room.radiosity(bright);
  for (const double z : {3.89, 3.5, 2.0}) {
    const Eigen::Vector3d receiver{1.9, 1.6, z};
    const double E = 1.0 + (bright - 1.0) * point_to_polygon(receiver, {0, 0, 1}, room.tile());
    const GatherPoint point{.position = receiver, .normal = {0, 0, 1}};
    double sum = 0.0, squares = 0.0;
    constexpr int replicas = 200;
    for (int i = 0; i < replicas; ++i) {
      const double estimate =
          gather_indirect({room.scene, room.caster, room.direct_light}, B, std::array{point},
                          {.rays = 64, .replica = static_cast<std::uint64_t>(i)})
              .indirect(0, 0);
      sum += estimate / replicas;
      squares += estimate * estimate / replicas;
    }
    const double deviation = std::sqrt(std::max(0.0, squares - sum * sum));
    // The last term is rounding of float sums.
    EXPECT_NEAR(sum, E, 4.0 * deviation / std::sqrt(replicas) + 1e-6 * E) << z;
  }
}

TEST(BrightPatches, AreHiddenByWhatStandsBefore) {
  const Room room{.side = 0.4, .with_shelf = true};
  constexpr float bright = 400.0f;
  const BandArray B = room.radiosity(bright);
  const Eigen::Vector3d receiver{2.0, 2.0, 0.0};
  // The shelf's edge is in the vertical plane of the receiver, so half of the tile is seen.
  const Loop half = {{1.8, 1.8, 3.9}, {1.8, 2.2, 3.9}, {2, 2.2, 3.9}, {2, 1.8, 3.9}};
  const double E = 1.0 + (bright - 1.0) * point_to_polygon(receiver, {0, 0, 1}, half);
  constexpr int replicas = 200;
  const Statistics estimate = gathered(room, B, receiver, 256, replicas);
  EXPECT_NEAR(estimate.mean, E, 4.0 * estimate.deviation / std::sqrt(replicas));
}

TEST(BrightPatches, HaveDirectionsOfTheStatedDensity) {
  const Room room{.side = 1.2, .with_shelf = false};
  const BrightPatches bright(room.scene, room.caster, room.radiosity(100.0f));
  const Eigen::Vector3d receiver{1.0, 0.5, 2.0};
  const BrightPatches::View view = bright.view(receiver, {0, 0, 1}, 64);
  ASSERT_FALSE(view.is_empty());
  // The mean of f / density is the integral of f over the tile's solid angle: f = cos / pi gives
  // the form factor.
  const SobolPoints aims(4096);
  double sum = 0.0;
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const BrightPatches::Aim aim = bright.draw(view, u[0], u[1], u[2]);
    const double distance = (3.9 - receiver.z()) / aim.direction.z();
    const double density = bright.density(view, aim.element, aim.direction, distance);
    ASSERT_GT(density, 0.0);
    sum += aim.direction.z() * std::numbers::inv_pi / density;
  }
  const double F = point_to_polygon(receiver, {0, 0, 1}, room.tile());
  // Stratified points err by a few times 1 / count of the summand's variation, which is about 1.
  EXPECT_NEAR(sum / aims.count(), F, 3e-3 * F);
}

TEST(BrightPatches, AreTheSameBitsAgain) {
  const Room room{.side = 0.1, .with_shelf = true};
  const BandArray B = room.radiosity(1000.0f);
  const Statistics one = gathered(room, B, {1, 1, 0}, 64, 3),
                   other = gathered(room, B, {1, 1, 0}, 64, 3);
  EXPECT_EQ(one.mean, other.mean);
  EXPECT_EQ(one.deviation, other.deviation);
}

}  // namespace
}  // namespace lightwell::bright_patches_test
