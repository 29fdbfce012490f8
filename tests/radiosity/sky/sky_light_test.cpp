#include "radiosity/sky/sky_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "scene/optics.h"
#include "scene/parallel.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::sky_light_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

// z is up. Radiance 1 at the zenith, and a dark ground.
Sky sky_of(SkyKind kind = SkyKind::gradation) {
  const Bands bands = rgb_bands();
  return {.up = Vector3d::UnitZ(),
          .north = Vector3d::UnitY(),
          .kind = kind,
          .bright = Vector3d::UnitZ(),
          .scale = constant_spectrum(bands, 1.0f),
          .ground = constant_spectrum(bands, 0.0f)};
}

struct UnderSky {
  Scene scene;
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  ElementCaster caster{mesh};
  SkyLight light{scene, caster};

  double at(const Vector3d& point, const Vector3d& normal, int facet, std::uint64_t key = 1) const {
    return static_cast<double>(light.irradiance(caster, {point, normal, facet}, key).irradiance[1]);
  }
};

void add_floor(Scene& scene, double half) {
  test::add_polygon(scene, "floor", test::add_material(scene, test::diffuse(scene.bands, 0.5f)),
                    {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}});
}

Scene open_plane(SkyKind kind = SkyKind::gradation) {
  Scene scene{.sky = sky_of(kind)};
  add_floor(scene, 2.0);
  return scene;
}

TEST(SkyLight, OpenPlaneUnderAUniformSkyGetsPiL) {
  const UnderSky plane{open_plane()};
  for (const double x : {0.0, 0.7, 1.9}) {
    EXPECT_NEAR(plane.at({x, 0.3, 0}, Vector3d::UnitZ(), 0), pi, 1e-6 * pi);
  }
  // Nothing has been learnt far from all surfaces.
  EXPECT_NEAR(plane.at({30.0, 0.0, 20.0}, Vector3d::UnitZ(), -1), pi, 1e-6 * pi);
}

TEST(SkyLight, OvercastSkyGivesTheIrradiancesOfMoonAndSpencer) {
  const UnderSky plane{open_plane(SkyKind::overcast)};
  const double horizontal = plane.at({0.2, 0.1, 0}, Vector3d::UnitZ(), 0);
  EXPECT_NEAR(horizontal, 7.0 / 9.0 * pi, 3e-5);
  const Spectrum wall = plane.light.unobstructed(Vector3d(0.6, 0.8, 0.0));
  EXPECT_NEAR(static_cast<double>(wall[0]) / horizontal, 0.396, 6e-4);
}

TEST(SkyLight, TiltedSurfacesSeeTheirShareOfAUniformSky) {
  const UnderSky plane{open_plane()};
  for (const double tilt : {10.0, 45.0, 77.0, 120.0, 160.0}) {
    const double t = tilt * pi / 180.0;
    const Spectrum E = plane.light.unobstructed(
        Vector3d(std::sin(t) * std::cos(0.3), std::sin(t) * std::sin(0.3), std::cos(t)));
    EXPECT_NEAR(static_cast<double>(E[2]), pi * 0.5 * (1.0 + std::cos(t)), 5e-5 * pi) << tilt;
  }
}

// The share of the sky seen from the middle of the floor of an endless street is the cosine of the
// angle at which the eaves stand (Oke 1987).
TEST(SkyLight, StreetCanyonShowsTheCosineOfItsEaves) {
  for (const double height : {0.5, 1.0, 2.0}) {
    Scene scene{.sky = sky_of()};
    const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
    add_floor(scene, 1.0);
    constexpr double far = 300.0;
    test::add_polygon(scene, "left", wall,
                      {{-1, -far, 0}, {-1, far, 0}, {-1, far, height}, {-1, -far, height}});
    test::add_polygon(scene, "right", wall,
                      {{1, far, 0}, {1, -far, 0}, {1, -far, height}, {1, far, height}});
    const UnderSky street{scene};
    const double expected = pi * std::cos(std::atan(height));
    double mean = 0.0;
    constexpr int keys = 32;
    for (std::uint64_t key = 0; key < keys; ++key) {
      mean += street.at({0, 0.1, 0}, Vector3d::UnitZ(), 0, key) / keys;
    }
    // 32 looks of some 140 rays, of which the share that the walls leave varies: sqrt(0.5 / 4600).
    EXPECT_NEAR(mean, expected, 0.01 * expected) << height;
  }
}

// A room whose wall x = 3 has a window: what a point gets of a uniform sky is the closed form of
// the window's outline.
Scene room_with_window(bool has_pane = false) {
  Scene scene{.sky = sky_of()};
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_box(scene, {-3, -2, 0}, {3, 2, 3}, {wall, wall, wall, wall, wall, wall}, true);
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[1].shape);  // x1
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vector3d& p : {Vector3d(3, -0.6, 0.9), Vector3d(3, 0.6, 0.9), Vector3d(3, 0.6, 2.1),
                            Vector3d(3, -0.6, 2.1)}) {
    mesh.vertices.push_back(p);
  }
  mesh.facets[0].holes = {{first, first + 1, first + 2, first + 3}};
  if (has_pane) {
    Material glass = test::clear_glass(scene.bands);
    glass.dielectric->thin = true;
    glass.dielectric->tint.setConstant(0.9f);
    test::add_polygon(scene, "pane", test::add_material(scene, glass),
                      {{3, -0.6, 0.9}, {3, -0.6, 2.1}, {3, 0.6, 2.1}, {3, 0.6, 0.9}});
  }
  return scene;
}

double window_form_factor(const Vector3d& point, const Vector3d& normal) {
  return std::abs(point_to_polygon(point, normal,
                                   {{Vector3d(3, -0.6, 0.9), Vector3d(3, -0.6, 2.1),
                                     Vector3d(3, 0.6, 2.1), Vector3d(3, 0.6, 0.9)}}));
}

struct Spread {
  double mean = 0.0, deviation = 0.0;
};
Spread spread(const UnderSky& room, const Vector3d& point, const Vector3d& normal, int facet) {
  constexpr int count = 64;
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t key = 0; key < count; ++key) {
    const double E = room.at(point, normal, facet, key);
    sum += E;
    squares += E * E;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

TEST(SkyLight, WindowGivesItsClosedFormWithLittleNoise) {
  const UnderSky room{room_with_window()};
  constexpr int floor = 4, wall = 0;
  for (const double x : {2.0, 1.0, -0.5, -2.5}) {
    const double expected = pi * window_form_factor({x, 0.3, 0}, Vector3d::UnitZ());
    const Spread found = spread(room, {x, 0.3, 0}, Vector3d::UnitZ(), floor);
    // Half of 16 + 128 rays find the window: 1 / sqrt(144), and an eighth of that in 64 looks.
    EXPECT_NEAR(found.mean, expected, 2.0 / 8.0 * 0.08 * expected) << x;
    EXPECT_LT(found.deviation, 0.08 * expected) << x;
  }
  const double expected = pi * window_form_factor({-3, 0.3, 0.5}, Vector3d::UnitX());
  const Spread found = spread(room, {-3, 0.3, 0.5}, Vector3d::UnitX(), wall);
  EXPECT_NEAR(found.mean, expected, 0.02 * expected);
  EXPECT_LT(found.deviation, 0.08 * expected);
  // A desk, where there is no surface.
  const double on_desk = pi * window_form_factor({0, 0, 0.8}, Vector3d::UnitZ());
  EXPECT_NEAR(spread(room, {0, 0, 0.8}, Vector3d::UnitZ(), -1).mean, on_desk, 0.02 * on_desk);
}

// A hole in the wall x = 3: `high` along z, and as wide as that along y, or `wide`.
std::array<Vector3d, 4> hole_corners(double high, double wide = 0.0) {
  const double h = 0.5 * high, w = wide > 0.0 ? 0.5 * wide : h;
  return {Vector3d(3, -w, 1.5 - h), Vector3d(3, w, 1.5 - h), Vector3d(3, w, 1.5 + h),
          Vector3d(3, -w, 1.5 + h)};
}

Scene room_with_hole(double high, double wide = 0.0) {
  Scene scene = room_with_window();
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[1].shape);  // x1
  std::ranges::copy(hole_corners(high, wide), mesh.vertices.end() - 4);
  return scene;
}

// Sums over points and keys.
struct LightOfHole {
  double found = 0.0, expected = 0.0, error = 0.0;  // error: standard error as a share of expected
};

LightOfHole light_of_hole(const UnderSky& room, double size,
                          const std::vector<SurfacePoint>& points, double wide = 0.0,
                          const SkyEffort& effort = {.first = 256, .most = 2048}, int keys = 32) {
  const std::array<Vector3d, 4> corners = hole_corners(size, wide);
  const Loop hole(corners.begin(), corners.end());
  LightOfHole light;
  double squared_error = 0.0;
  for (const SurfacePoint& at : points) {
    light.expected += keys * pi * std::abs(point_to_polygon(at.position, at.normal, {hole}));
    double mean = 0.0, squares = 0.0;
    for (int key = 0; key < keys; ++key) {
      const SkyGlow glow =
          room.light.irradiance(room.caster, at, static_cast<std::uint64_t>(key), effort);
      const auto E = static_cast<double>(glow.irradiance[1]);
      mean += E / keys;
      squares += E * E;
    }
    light.found += keys * mean;
    squared_error += (squares - keys * mean * mean) * keys / (keys - 1.0);
  }
  light.error = std::sqrt(squared_error) / light.expected;
  std::printf("hole of %g m: %.4f of its light, standard error %.4f\n", size,
              light.found / light.expected, light.error);
  return light;
}

// Points of the floor, and of the wall opposite the hole below the hole: the ground is dark.
std::vector<SurfacePoint> points_below_a_hole(double height_of_floor) {
  constexpr int floor = 4, wall = 0, count = 24;
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double y = -1.9 + 3.8 * ((7 * i) % count) / count, s = (i + 0.3) / count;
    points.push_back(
        i % 2 == 0 ? SurfacePoint{{-2.9 + 5.0 * s, y, height_of_floor}, Vector3d::UnitZ(), floor}
                   : SurfacePoint{{-3, y, 0.1 + 1.2 * s}, Vector3d::UnitX(), wall});
  }
  return points;
}

// A hole of 0.03 m, seen from 4 m, is 0.9 % of a cell of the dome, so that of sites that look
// through each cell once few see it.
TEST(SkyLight, HoleGivesItsLightHoweverSmallItIs) {
  for (const double size : {0.3, 0.1, 0.03}) {
    const UnderSky room{room_with_hole(size)};
    const LightOfHole light = light_of_hole(room, size, points_below_a_hole(0.0));
    EXPECT_NEAR(light.found, light.expected, 4.0 * light.error * light.expected) << size;
    // Three quarters of 3072 rays go to nine cells of 0.0061 sr about an open one, or more evenly
    // to those of several. Through the smallest hole, of 5e-5 sr, get two of them, so that an
    // estimate is off by 0.7 of its mean, and the sum of 24 * 32 estimates by 2.6 %; half as much
    // again is for points that know more cells than nine.
    EXPECT_LT(light.error, 0.04) << size;
  }
}

// A seam of 20 um is narrower than seam_share of the room's length of 7.8 m, 39 um. Some of the 2.4
// million rays would get out there. A slit of 1 mm has 3.0e-5 of the hemisphere, weighted by the
// cosine, in the mean over the points. If no cell were known to be open, 71 rays would get out, and
// their sum would be off by 1 / sqrt(71) = 12 %.
TEST(SkyLight, SeamsOfRoundingLetNoLightThrough) {
  constexpr double length = 3.6;
  const std::vector<SurfacePoint> points = points_below_a_hole(0.0);
  EXPECT_EQ(light_of_hole(UnderSky{room_with_hole(2e-5, length)}, 2e-5, points, length).found, 0.0);
  const LightOfHole wide =
      light_of_hole(UnderSky{room_with_hole(1e-3, length)}, 1e-3, points, length);
  EXPECT_NEAR(wide.found, wide.expected, 4.0 * wide.error * wide.expected);
  EXPECT_LT(wide.error, 0.12);
}

// Most of the few first rays miss a slit. A goal of noise decides by them how many rays follow,
// which must not favour what they found: if 16 of 80 rays count only where they find nothing, a
// fifth of the light is lost.
TEST(SkyLight, SlitsHaveTheRightMeanByFewRays) {
  // Chance exceeds four standard errors once in 16 000 times. The loss is beyond them if the
  // standard error is below a quarter of it.
  constexpr double loss = 16.0 / 80.0, standard_errors = 4.0;
  constexpr double length = 3.6;
  constexpr int keys = 400;
  const std::vector<SurfacePoint> points = points_below_a_hole(0.0);
  for (const double high : {0.1, 0.01}) {
    const UnderSky room{room_with_hole(high, length)};
    for (const NoiseGoal& goal :
         {NoiseGoal{}, NoiseGoal{.share = 0.1}, NoiseGoal{.irradiance = 0.01, .share = 0.1}}) {
      const LightOfHole light =
          light_of_hole(room, high, points, length, {.first = 16, .most = 64, .goal = goal}, keys);
      EXPECT_NEAR(light.found, light.expected, standard_errors * light.error * light.expected)
          << high << " m, " << goal.irradiance;
      EXPECT_LT(light.error, loss / standard_errors) << high << " m, " << goal.irradiance;
    }
  }
}

// Below the floor, z = 0, is a dark box. Points of the floor are off by less than a rounding of the
// room's size, 3 * 2^-53 m.
TEST(SkyLight, RoundingOfAPlaneThroughTheOriginDoesNotMatter) {
  constexpr double size = 0.1;
  Scene scene = room_with_hole(size);
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_box(scene, {-3, -2, -0.05}, {3, 2, 0}, {black, black, black, black, black, black},
                true);
  const UnderSky room{scene};
  for (const double z : {0.0, -1e-17}) {
    const LightOfHole light = light_of_hole(room, size, points_below_a_hole(z));
    EXPECT_NEAR(light.found, light.expected, 4.0 * light.error * light.expected) << z;
    // Rays of the same number: 23 of them get through 5.5e-4 sr, so that the sum is off by 0.75 %;
    // half as much again is for points that know more cells than nine.
    EXPECT_LT(light.error, 0.012) << z;
  }
}

TEST(SkyLight, MeetsAGoalOfNoise) {
  const UnderSky room{room_with_window()};
  constexpr int floor = 4, count = 64;
  for (const double x : {2.0, -0.5, -2.5}) {
    const SurfacePoint at{{x, 0.3, 0}, Vector3d::UnitZ(), floor};
    const double expected = pi * window_form_factor(at.position, at.normal);
    for (const double share : {0.05, 0.01}) {
      for (const NoiseGoal& goal :
           {NoiseGoal{.irradiance = share * expected}, NoiseGoal{.share = share}}) {
        double squares = 0.0;
        for (std::uint64_t key = 0; key < count; ++key) {
          const SkyGlow glow =
              room.light.irradiance(room.caster, at, key, {.first = 32, .most = 128, .goal = goal});
          squares += std::pow(static_cast<double>(glow.irradiance[1]) - expected, 2) / count;
        }
        // The root of 64 squares is known to 1 / sqrt(128) = 9 %, three of which count. The rays
        // follow from the noise of the first 32, of which half meet the window's edge: known to
        // 1 / sqrt(2 * 16) = 18 %.
        EXPECT_LT(std::sqrt(squares), 1.45 * share * expected) << x << " m, " << share;
      }
    }
  }
}

// The points lie on surfaces, have a normal between the axes of sites, or lie where no site is
// near.
TEST(SkyLight, SingleRaysHaveTheRightMean) {
  const UnderSky room{room_with_window()};
  constexpr int floor = 4, wall = 0, count = 40000;
  const Vector3d oblique = Vector3d(1.0, 0.2, 0.7).normalized();
  for (const SurfacePoint& at : {SurfacePoint{{-0.5, 0.3, 0}, Vector3d::UnitZ(), floor},
                                 SurfacePoint{{-3, 0.3, 0.5}, Vector3d::UnitX(), wall},
                                 SurfacePoint{{-2.9, 0.3, 0.5}, oblique, -1},
                                 SurfacePoint{{0, 0, 0.8}, Vector3d::UnitZ(), -1}}) {
    const double expected = pi * window_form_factor(at.position, at.normal);
    double sum = 0.0, squares = 0.0;
    for (std::uint64_t key = 0; key < count; ++key) {
      const auto E = static_cast<double>(room.light.irradiance_by_one_ray(room.caster, at, key)[1]);
      sum += E / count;
      squares += E * E / count;
    }
    const double deviation = std::sqrt(squares - sum * sum);
    std::printf("deviation of a ray: %.2f of %.4f\n", deviation / expected, expected);
    // Four standard errors: chance exceeds one once in 16 000 times.
    EXPECT_NEAR(sum, expected, 4.0 * deviation / std::sqrt(double{count}));
  }
}

// A wall behind a picture sees none of the sky, which tells nothing of the picture's face.
TEST(SkyLight, APictureIsKnownAsTheWallBehindItIs) {
  Scene scene = room_with_window();
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  constexpr double face = -2.98;
  test::add_polygon(scene, "picture", black,
                    {{face, -1, 0.1}, {face, 1, 0.1}, {face, 1, 0.9}, {face, -1, 0.9}});
  const UnderSky room{scene};
  const int picture = room.mesh.facet.back();
  for (const double y : {-0.7, 0.0, 0.5}) {
    const Vector3d point(face, y, 0.5);  // the whole window is above its horizon
    const double expected = pi * window_form_factor(point, Vector3d::UnitX());
    const Spread found = spread(room, point, Vector3d::UnitX(), picture);
    std::printf("%g m from the middle: %.4f, exact %.4f, noise %.4f\n", y, found.mean, expected,
                found.deviation / expected);
    // Half of some 144 rays find the window, as on the wall, so that a look is off by
    // 1 / sqrt(144) = 0.08, and the mean of 64 looks by an eighth of that, twice which is allowed.
    EXPECT_NEAR(found.mean, expected, 2.0 / 8.0 * 0.08 * expected);
    EXPECT_LT(found.deviation, 0.08 * expected);
  }
}

TEST(SkyLight, PanePassesWhatItsOpticsSay) {
  const UnderSky bare{room_with_window()}, glazed{room_with_window(true)};
  const Vector3d point(-2.9, 0.0, 1.5);  // the window is nearly straight ahead: within 12 degrees
  const double without = spread(bare, point, Vector3d::UnitX(), -1).mean;
  const double with = spread(glazed, point, Vector3d::UnitX(), -1).mean;
  const double expected = (1.0 - pane_reflectance(1.0, 1.5)) * 0.9;
  // The rays are the same; within 12 degrees Fresnel's reflectance changes by less than 1e-4.
  EXPECT_NEAR(with / without, expected, 1e-4);
}

TEST(SkyLight, IsTheSameForAnyNumberOfThreads) {
  const auto found = [](int threads) {
    const ThreadLimit limit(threads);
    const UnderSky room{room_with_window()};
    return room.at({1.0, 0.2, 0}, Vector3d::UnitZ(), 4, 77);
  };
  EXPECT_EQ(found(1), found(3));
}

// Points far apart first, so that sites are found in another order than by find_all().
TEST(SkyLight, IsTheSameWhereSitesAreFoundOnDemand) {
  const UnderSky on_demand{room_with_window()};
  UnderSky at_once{room_with_window()};
  at_once.light.find_all();
  constexpr int count = 64;
  std::array<double, count> found{};
  parallel_for(count, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double x = 0.05 + 2.9 * ((i * 37) % count) / count;
      found[static_cast<std::size_t>(i)] =
          on_demand.at({x, 0.4, 0}, Vector3d::UnitZ(), 4, static_cast<std::uint64_t>(i));
    }
  });
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = 0.05 + 2.9 * ((i * 37) % count) / count;
    const double all = at_once.at({x, 0.4, 0}, Vector3d::UnitZ(), 4, static_cast<std::uint64_t>(i));
    EXPECT_EQ(found[static_cast<std::size_t>(i)], all) << i;
    sum += all;
  }
  EXPECT_GT(sum, 0.0);
}

// Beside the wall of a shed the site may have learnt from within it, where a slit in the roof is
// all that shows of the sky.
TEST(SkyLight, BesideAShedTheSkyIsNotWhatShowsWithinIt) {
  Scene scene{.sky = sky_of()};
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  const Loop wall{{1, -1, 0}, {1, 1, 0}, {1, 1, 1}, {1, -1, 1}};
  test::add_polygon(scene, "within", black, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  test::add_polygon(scene, "east", black, wall);
  test::add_polygon(scene, "west", black, {{-1, -1, 0}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, 0}});
  test::add_polygon(scene, "north", black, {{-1, 1, 0}, {-1, 1, 1}, {1, 1, 1}, {1, 1, 0}});
  test::add_polygon(scene, "south", black, {{-1, -1, 0}, {1, -1, 0}, {1, -1, 1}, {-1, -1, 1}});
  test::add_polygon(scene, "roof", black, {{-1, -1, 1}, {-1, 1, 1}, {0.8, 1, 1}, {0.8, -1, 1}});
  test::add_polygon(scene, "without", black, {{1, -7, 0}, {10, -7, 0}, {10, 7, 0}, {1, 7, 0}});
  const UnderSky shed{scene};
  for (const double x : {1.02, 1.04, 1.06}) {
    const Vector3d point(x, 0.1, 0.0);
    const double expected =
        pi * (1.0 - std::abs(point_to_polygon(point, Vector3d::UnitZ(), {wall})));
    const Spread found = spread(shed, point, Vector3d::UnitZ(), 6);
    std::printf("%g m from the wall: %.4f, exact %.4f, noise %.4f\n", x - 1.0, found.mean, expected,
                found.deviation / expected);
    // 128 rays, half of which meet the wall. Along the curve on which they are even its outline
    // lies in some 2 sqrt(128) steps, each off by 0.5 at most: 9 % of the open half; and an eighth
    // of that in 64 looks.
    EXPECT_LT(found.deviation, 0.05 * expected);
    EXPECT_NEAR(found.mean, expected, 2.0 / 8.0 * 0.05 * expected);
  }
}

// A map of radiance 0.1, and of 5000 in three pixels of 1.4 degrees that give nine tenths of the
// light.
Sky map_with_a_sun() {
  constexpr int width = 256, height = 128;
  BandArray pixels = BandArray::Constant(width * height, 3, 0.1f);
  for (int y = 30; y < 33; ++y) pixels.row(y * width + 140).setConstant(5000.0f);
  Sky sky = sky_of(SkyKind::map);
  sky.map = std::make_shared<EnvironmentMap>(width, height, pixels);
  sky.to_map << Vector3d::UnitX().transpose(), Vector3d::UnitZ().transpose(),
      -Vector3d::UnitY().transpose();
  return sky;
}

// A map with one bright place is as good as a sun there: sharp, and found wherever it is.
TEST(SkyLight, BrightPlaceOfAMapIsFound) {
  Scene scene = open_plane();
  scene.sky = map_with_a_sun();
  const UnderSky plane{scene};
  const double expected = static_cast<double>(diffuse_horizontal_irradiance(*scene.sky)[0]);
  // Three pixels of 1.4 degrees are drawn as cells of 0.7: their light is kept, but its cosine is
  // that of the cell, off by up to half of 0.7 degrees.
  EXPECT_NEAR(plane.at({0, 0, 0}, Vector3d::UnitZ(), 0), expected, 0.006 * expected);
}

// Wherever the shadow of a plate ends in a site, and whatever the site has found of that.
TEST(SkyLight, ShadowOfABrightPlaceIsFoundWithoutNoise) {
  Scene scene = open_plane();
  scene.sky = map_with_a_sun();
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  constexpr double height = 0.5;
  test::add_polygon(
      scene, "plate", black,
      {{-0.7, -0.7, height}, {0.7, -0.7, height}, {0.7, 0.7, height}, {-0.7, 0.7, height}});
  const UnderSky plane{scene};
  const double open = static_cast<double>(diffuse_horizontal_irradiance(*scene.sky)[0]);
  double squares = 0.0;
  int count = 0, in_shadow = 0;
  for (int i = 0; i < 40; ++i) {
    const Vector3d point{-1.9 + 0.097 * i, 0.1, 0.0};
    double truth = 0.0;
    constexpr int keys = 4;
    for (std::uint64_t key = 0; key < keys; ++key) {
      truth += static_cast<double>(plane.light
                                       .irradiance(plane.caster, {point, Vector3d::UnitZ(), 0},
                                                   100 + key, {.first = 1024, .most = 1024})
                                       .irradiance[1]) /
               keys;
    }
    const bool is_shadow = truth < 0.2 * open;
    in_shadow += is_shadow ? 1 : 0;
    if (!is_shadow && truth < 0.9 * open) continue;  // penumbra
    for (std::uint64_t key = 0; key < keys; ++key) {
      squares += std::pow(plane.at(point, Vector3d::UnitZ(), 0, key) / open - truth / open, 2);
      ++count;
    }
  }
  std::printf("%d points in the shadow, noise %.4f of the open sky\n", in_shadow,
              std::sqrt(squares / count));
  EXPECT_GT(in_shadow, 4);
  EXPECT_GT(count, 100);
  // The bright place is one direction; what is left is of the other twentieth of the light, which
  // eight of the rays go to: 0.05 * 0.5 / sqrt(8).
  EXPECT_LT(std::sqrt(squares / count), 0.009);
}

TEST(SkyLight, KnowsItsNoise) {
  // A wall beside the points hides a part of the dome. 400 estimates have a standard deviation that
  // is known to 1 / sqrt(800) = 3.5 %; three of that and 5 % for what the pairs themselves vary by
  // leave 0.85. Pairs of rays count the differences of their means as noise, at most as much again
  // as the variance: a factor of sqrt(2), or 1.7 with the same margins.
  Scene scene = open_plane();
  test::add_polygon(scene, "wall", 0, {{1, -2, 0}, {1, -2, 3}, {1, 2, 3}, {1, 2, 0}});
  const UnderSky plane{std::move(scene)};
  constexpr int count = 400;
  double sum = 0.0, squares = 0.0, noise = 0.0;
  for (int i = 0; i < count; ++i) {
    const SkyGlow glow = plane.light.irradiance(plane.caster, {{0.2, 0.3, 0}, Vector3d::UnitZ(), 0},
                                                static_cast<std::uint64_t>(i));
    const auto E = static_cast<double>(glow.irradiance[1]);
    sum += E / count;
    squares += E * E / count;
    noise += glow.noise * glow.noise / count;
  }
  const double deviation = std::sqrt(squares - sum * sum);
  EXPECT_GT(std::sqrt(noise), 0.85 * deviation);
  EXPECT_LT(std::sqrt(noise), 1.7 * deviation);
}

}  // namespace
}  // namespace lightwell::sky_light_test
