// Aimed rays find small bright patches, and do not change the mean.
#include "radiosity/gather/bright_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
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

// Mean and deviation of the gathered irradiance at a point.
Statistics gathered(const LitScene& lit, const BandArray& B, const GatherPoint& point, int rays,
                    int replicas) {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < replicas; ++i) {
    const double E = gather_indirect(lit, B, std::array{point},
                                     {.rays = rays, .replica = static_cast<std::uint64_t>(i)})
                         .indirect(0, 0);
    sum += E;
    squares += E * E;
  }
  const double mean = sum / replicas;
  return {mean, std::sqrt(std::max(0.0, squares / replicas - mean * mean))};
}

// The same at a point of the floor of a room.
template <class AnyRoom>
Statistics gathered(const AnyRoom& room, const BandArray& B, const Eigen::Vector3d& receiver,
                    int rays, int replicas) {
  constexpr int floor = 4;
  return gathered({room.scene, room.caster, room.direct_light}, B,
                  {.position = receiver, .normal = {0, 0, 1}, .facet = floor}, rays, replicas);
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
    constexpr int replicas = 200;
    const auto [mean, deviation] =
        gathered({room.scene, room.caster, room.direct_light}, B, point, 64, replicas);
    // Four standard errors of the mean, and roundings of floats, 2^-24 each: four of a corner's
    // weight, one of its product with B and one of the result.
    EXPECT_NEAR(mean, E, 4.0 * deviation / std::sqrt(replicas) + 6.0 * 0x1p-24 * E) << z;
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

// A room of 6 m with a shade below the middle of its ceiling: a square tube of 0.3 x 0.3 x 0.6 m,
// its lid above, of which only the inside is bright.
struct ShadedRoom {
  bool with_bulb = false;
  Scene scene = [this] {
    Scene made;
    const int grey = test::add_material(made, test::diffuse(made.bands, 0.5f));
    test::add_box(made, {0, 0, 0}, {6, 6, 6}, {grey, grey, grey, grey, grey, grey}, true);
    constexpr double a = 2.85, b = 3.15, low = 4.4, high = 5.0;
    // All face inwards.
    test::add_polygon(made, "lid", grey, {{a, a, high}, {a, b, high}, {b, b, high}, {b, a, high}});
    test::add_polygon(made, "west", grey, {{a, a, low}, {a, b, low}, {a, b, high}, {a, a, high}});
    test::add_polygon(made, "east", grey, {{b, b, low}, {b, a, low}, {b, a, high}, {b, b, high}});
    test::add_polygon(made, "south", grey, {{b, a, low}, {a, a, low}, {a, a, high}, {b, a, high}});
    test::add_polygon(made, "north", grey, {{a, b, low}, {b, b, low}, {b, b, high}, {a, b, high}});
    if (with_bulb) {
      made.surfaces.push_back(
          {.name = "bulb",
           .material = test::add_material(made, test::diffuse(made.bands, 0.0f)),
           .shape = Sphere{.center = {3, 3, 4.8}, .radius = 0.06}});
    }
    return made;
  }();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  ElementCaster caster{mesh};
  DirectLight direct_light{scene, mesh};

  // Counter-clockwise, seen from below.
  Loop mouth() const {
    return {{2.85, 2.85, 4.4}, {2.85, 3.15, 4.4}, {3.15, 3.15, 4.4}, {3.15, 2.85, 4.4}};
  }
  // Radiosity at vertices, 1 but for the inside of the shade.
  BandArray radiosity(float of_inside) const {
    BandArray B = BandArray::Ones(mesh.vertex_count(), 3);
    const Eigen::Vector3d middle(3, 3, 4.7);
    for (int e = 0; e < mesh.element_count(); ++e) {
      const PatchPoint center = element_center(mesh, e);
      if (mesh.facet[e] < 6 || mesh.facet[e] > 10 ||
          center.normal.dot(middle - center.position) < 0.0)
        continue;
      for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = of_inside;
    }
    return B;
  }
};

// An evenly bright inside looks as bright as its mouth would shine, whose form factor is known.
TEST(BrightPatches, InACavityGiveWhatItsMouthWould) {
  const ShadedRoom room;
  constexpr float bright = 1000.0f;
  const BandArray B = room.radiosity(bright);
  for (const Eigen::Vector3d& receiver :
       {Eigen::Vector3d(3.2, 2.5, 0), Eigen::Vector3d(4.5, 3, 0)}) {
    const double F = point_to_polygon(receiver, {0, 0, 1}, room.mouth());
    const double E = 1.0 + (bright - 1.0) * F;
    constexpr int replicas = 200;
    const auto [mean, deviation] = gathered(room, B, receiver, 256, replicas);
    std::printf("F %.2e, E %.4f, gathered %.4f, deviation %.4f\n", F, E, mean, deviation);
    EXPECT_NEAR(mean, E, 4.0 * deviation / std::sqrt(replicas));
  }
}

// Exact round shapes in a room of 6 m, with radiosity of `bright` on those elements that
// `is_bright` holds for by their middle, and of 1 elsewhere.
Statistics gathered_of_round(const std::vector<SurfaceShape>& shapes, float bright,
                             const std::function<bool(const PatchPoint&)>& is_bright,
                             const Eigen::Vector3d& receiver, int replicas) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {6, 6, 6}, {grey, grey, grey, grey, grey, grey}, true);
  for (const SurfaceShape& shape : shapes) {
    scene.surfaces.push_back({.name = "round", .material = grey, .shape = shape});
  }
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  BandArray B = BandArray::Ones(mesh.vertex_count(), 3);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] < 6 || !is_bright(element_center(mesh, e))) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = bright;
  }
  return gathered({scene, caster, direct_light}, B,
                  {.position = receiver, .normal = {0, 0, 1}, .facet = 4}, 256, replicas);
}

// A ball of radius r at the distance d: F = cos (r / d)^2 from a point that sees all of it (Howell,
// "A catalog of radiation heat transfer configuration factors", B-37).
TEST(BrightPatches, OnABallGiveWhatTheFormFactorSays) {
  const Eigen::Vector3d center(3, 3, 4), receiver(2, 2.5, 0);
  constexpr double radius = 0.1;
  constexpr int replicas = 200;
  constexpr float bright = 1000.0f;
  const Statistics estimate = gathered_of_round(
      {Sphere{.center = center, .radius = radius}}, bright, [](const PatchPoint&) { return true; },
      receiver, replicas);
  const Eigen::Vector3d to = center - receiver;
  const double F = to.normalized().z() * radius * radius / to.squaredNorm();
  const double E = 1.0 + (bright - 1.0) * F;
  std::printf("ball: E %.4f, gathered %.4f, deviation %.4f\n", E, estimate.mean,
              estimate.deviation);
  EXPECT_NEAR(estimate.mean, E, 4.0 * estimate.deviation / std::sqrt(replicas));
  // 256 / 4 aimed rays, a share p = 1/2 of which are for the near side and count: independent ones
  // leave sqrt((1 - p) / (64 p)) = 1/8 of the ball's light.
  EXPECT_LT(estimate.deviation, 0.125 * (E - 1.0));
}

// A tube under a lid, bright inside: the mouth's form factor is that of a disc, here a polygon of
// 720 corners, whose area is smaller by 1.3e-5.
TEST(BrightPatches, InARoundShadeGiveWhatItsMouthWould) {
  const Eigen::Vector3d base(3, 3, 4.4), up = Eigen::Vector3d::UnitZ(), receiver(4.5, 3, 0);
  constexpr double radius = 0.15, height = 0.6;
  constexpr int replicas = 200;
  constexpr float bright = 1000.0f;
  const Eigen::Vector3d middle = base + 0.5 * height * up;
  const Statistics estimate = gathered_of_round(
      {Frustum{.base = base,
               .axis = up,
               .height = height,
               .base_radius = radius,
               .top_radius = radius,
               .inward = true},
       Frustum{.base = base + height * up,
               .axis = -up,
               .height = 0.0,
               .base_radius = radius,
               .top_radius = 0.0}},
      bright, [&](const PatchPoint& at) { return at.normal.dot(middle - at.position) > 0.0; },
      receiver, replicas);
  Loop mouth;
  constexpr int corners = 720;
  for (int i = 0; i < corners; ++i) {
    const double turn = -2.0 * std::numbers::pi * i / corners;
    mouth.push_back(base + radius * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.0));
  }
  const double E = 1.0 + (bright - 1.0) * point_to_polygon(receiver, {0, 0, 1}, mouth);
  std::printf("round shade: E %.4f, gathered %.4f, deviation %.4f\n", E, estimate.mean,
              estimate.deviation);
  EXPECT_NEAR(estimate.mean, E, 4.0 * estimate.deviation / std::sqrt(replicas));
  // Rays through the mouth all count, and half of those to points on the inside: an eighth is left
  // if all were of the second kind, as for the ball.
  EXPECT_LT(estimate.deviation, 0.125 * (E - 1.0));
}

// Draws through the mouth and towards the patches, as one density.
TEST(BrightPatches, InACavityHaveDirectionsOfTheStatedDensity) {
  const ShadedRoom room;
  const BrightPatches bright(room.scene, room.caster, room.radiosity(1000.0f));
  const Eigen::Vector3d receiver(5.8, 2.5, 1.0);
  const BrightPatches::View view = bright.view(receiver, {0, 0, 1}, 64);
  const SobolPoints aims(4096);
  double sum = 0.0, squares = 0.0;
  int counted = 0;
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const BrightPatches::Aim aim = bright.draw(view, u[0], u[1], u[2]);
    const Ray ray{.origin = receiver, .direction = aim.direction, .origin_group = 4};
    ElementHit hit;
    room.caster.closest_hits({&ray, 1}, {&hit, 1});
    if (!bright.counts(aim, hit)) continue;
    ++counted;
    const double value = aim.direction.z() * std::numbers::inv_pi /
                         bright.density(view, hit.element, aim.direction, hit.t);
    sum += value;
    squares += value * value;
  }
  const double count = aims.count(), mean = sum / count,
               error = std::sqrt((squares / count - mean * mean) / count);
  const double F = point_to_polygon(receiver, {0, 0, 1}, room.mouth());
  std::printf("F %.3e, by draws %.3e, counted %.2f\n", F, mean, counted / count);
  EXPECT_NEAR(mean, F, 4.0 * error);
  EXPECT_GT(mean, 20.0 * error);  // so that the line above can fail
  // More than twice as many count as would of rays to random points on the inside.
  std::vector<double> area{0.0};
  std::vector<int> patches;
  const BandArray B = room.radiosity(1000.0f);
  for (int p = 0; p < room.mesh.patch_count(); ++p) {
    if (!(B(room.mesh.corners[room.mesh.first_element[p]][0], 0) > 1.0f)) continue;
    patches.push_back(p);
    area.push_back(area.back() + room.mesh.area[p]);
  }
  int seen = 0;
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 8).cast<double>();
    const auto drawn = std::upper_bound(area.begin() + 1, area.end() - 1, u[2] * area.back());
    const int p = patches[static_cast<std::size_t>(drawn - area.begin() - 1)];
    const PatchPoint point = PatchSampler(room.mesh, p).point(u[0], u[1]);
    const Ray ray{.origin = receiver,
                  .direction = (point.position - receiver).normalized(),
                  .origin_group = 4};
    ElementHit hit;
    room.caster.closest_hits({&ray, 1}, {&hit, 1});
    seen += hit.element == point.element ? 1 : 0;
  }
  std::printf("seen of random points %.2f\n", seen / count);
  EXPECT_GT(seen, 0);
  EXPECT_GT(counted, 2 * seen);
}

// A bulb within ends many rays, in all directions.
class BrightCavitiesWithABulb : public testing::TestWithParam<bool> {};

TEST_P(BrightCavitiesWithABulb, HaveTheirMouthWhereLightLeaves) {
  const ShadedRoom room{.with_bulb = GetParam()};
  const BandArray B = room.radiosity(1000.0f);
  std::vector<double> of_element(static_cast<std::size_t>(room.mesh.element_count()), 0.0);
  std::vector<BrightPatch> bright;
  for (int p = 0; p < room.mesh.patch_count(); ++p) {
    const int first = room.mesh.first_element[p];
    if (!(B(room.mesh.corners[first][0], 0) > 1.0f)) continue;
    bright.push_back({.patch = p, .openness = 0.2});
    for (int e = first; e < room.mesh.first_element[p + 1]; ++e) of_element[e] = 1000.0;
  }
  for (BrightPatch& b : bright) {
    for (const BrightPatch& other : bright) b.met.push_back(other.patch);
  }
  const BrightCavities found = find_cavities(room.caster, bright, of_element);
  ASSERT_EQ(found.cavities.size(), 1u);
  EXPECT_EQ(found.cavities[0].patches.size(), bright.size());
  // The quotient of two sums of one term for each element, each rounded by 2^-53 of the sum.
  const int elements = room.mesh.element_count();
  EXPECT_NEAR(found.cavities[0].brightness, 1000.0, 2.0 * elements * 0x1p-53 * 1000.0);
  ASSERT_EQ(found.mouths.size(), 1u);
  const CavityMouth& mouth = found.mouths[0];
  // A twentieth of the mouth's width: of directions through the disc a twentieth more miss.
  EXPECT_LT((mouth.center - Eigen::Vector3d(3.0, 3.0, 4.4)).norm(), 0.05 * 0.3);
  // The normal is the mean of some 500 directions with slopes of 0.35 in the mean square, along x
  // and y: four standard errors, 4 * 0.35 / sqrt(500) = 0.063 in each, are 0.996 along z.
  EXPECT_LT(mouth.normal.z(), -0.995);
  // Up to the corners of the mouth.
  EXPECT_NEAR(mouth.radius, 0.15 * std::numbers::sqrt2, 0.02);
  // No light leaves upwards: there is a tenth of the mean at least and no more.
  EXPECT_GT(mouth.intensity(-Eigen::Vector3d::UnitZ()), 10.0 * mouth.intensity({0, 0, 1}));
}

INSTANTIATE_TEST_SUITE_P(OrWithout, BrightCavitiesWithABulb, testing::Bool());

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
