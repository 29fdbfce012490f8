#include "raytrace/caustics/caustic_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/visibility/point_form_factor.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::caustic_map_test {
namespace {

using Eigen::Vector3d;

const Paint white{.reflectance = 0.5f};

// Photons of equal power, spread evenly over the image of the unit square under `place`.
CausticPhotons spread(const ElementCaster& caster, int count,
                      const std::function<Vector3d(float, float)>& place, float power) {
  CausticPhotons photons;
  photons.power.setConstant(count, 3, power);
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4f u = sobol.point(i, 7);
    photons.position.push_back(place(u[0], u[1]));
    const Ray ray{.origin = photons.position.back() + Vector3d(0, 0, 0.1), .direction = {0, 0, -1}};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    photons.element.push_back(hit.element);
  }
  return photons;
}

double irradiance_at(const ElementCaster& caster, const CausticMap& map, double x, double y,
                     double besides = 0.0) {
  const Ray ray{.origin = {x, y, 0.1}, .direction = {0, 0, -1}};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  if (hit.element < 0) return 0.0;
  return static_cast<double>(
      map.irradiance({x, y, 0.0}, Vector3d::UnitZ(), hit.element, besides)[0]);
}

// Constant irradiance on a floor stays constant up to edges and corners.
TEST(CausticMap, EvenLightIsEvenUpToTheEdge) {
  const TracedScene lit(
      SceneBuilder().square(white, Vector3d::Zero(), Vector3d::UnitZ(), 1.0).build());
  constexpr int count = 1 << 15;
  const CausticPhotons photons = spread(
      lit.caster, count, [](float u, float v) { return Vector3d(2.0 * u - 1.0, 2.0 * v - 1.0, 0); },
      4.0f / count);
  const CausticMap map(lit.mesh, photons);
  // Independent photons would have a standard error of sqrt(4/3 / k) = 0.18 with k = 40, more at an
  // edge, where half of them count twice, and twice as much in a corner; that of stratified photons
  // is much smaller.
  EXPECT_NEAR(irradiance_at(lit.caster, map, 0.1, 0.2), 1.0, 0.08);
  EXPECT_NEAR(irradiance_at(lit.caster, map, 0.999, 0.2), 1.0, 0.12);
  EXPECT_NEAR(irradiance_at(lit.caster, map, 0.999, -0.999), 1.0, 0.16);
  double sum = 0.0;
  constexpr int along_edge = 200;
  for (int i = 0; i < along_edge; ++i) {
    sum += irradiance_at(lit.caster, map, -1.0 + 2.0 * (i + 0.5) / along_edge, 0.998) / along_edge;
  }
  EXPECT_NEAR(sum, 1.0, 0.02);
}

// A map without photons is dark, in as many bands as the mesh has.
TEST(CausticMap, WithoutPhotonsIsDark) {
  const TracedScene lit(
      SceneBuilder().square(white, Vector3d::Zero(), Vector3d::UnitZ(), 1.0).build());
  const Spectrum E = CausticMap(lit.mesh, {}).irradiance(Vector3d::Zero(), Vector3d::UnitZ(), 0);
  ASSERT_EQ(E.size(), 3);
  EXPECT_EQ(E.maxCoeff(), 0.0f);
}

// Integral over an L-shaped floor of 3 m^2, W, of irradiance at points of the floor, by a grid. The
// grid samples thousands of discs with a radius of about 6 steps: error 1e-3.
double integral_over_l(const std::function<double(double, double)>& irradiance) {
  constexpr int steps = 800;
  constexpr double step = 2.0 / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double x = (i + 0.5) * step, y = (j + 0.5) * step;
      if (x > 1.0 && y > 1.0) continue;
      sum += irradiance(x, y) * step * step;
    }
  }
  return sum;
}

// The integral of irradiance over an L-shaped floor is the power of the photons.
TEST(CausticMap, IrradianceAddsUpToThePowerOfThePhotons) {
  const TracedScene lit(
      SceneBuilder()
          .polygon(white, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}})
          .build());
  constexpr int count = 4096;
  for (const auto& place : std::vector<std::function<Vector3d(float, float)>>{
           [](float u, float v) { return Vector3d(0.9 + 0.1 * u, 0.9 + 0.1 * v, 0); },
           [](float u, float v) { return Vector3d(1.9 + 0.1 * u, 0.1 * v, 0); },
           [](float u, float v) { return Vector3d(0.2 + 0.1 * u, 1.0 + 0.1 * v, 0); }}) {
    const CausticPhotons photons = spread(lit.caster, count, place, 3.0f / count);
    // Discs at the inner corner lose no power, since the floor is one surface.
    const CausticMap map(lit.mesh, photons);
    EXPECT_NEAR(
        integral_over_l([&](double x, double y) { return irradiance_at(lit.caster, map, x, y); }),
        3.0, 0.01);
  }
}

// Independent photons, even on the left half of a floor that other light reaches, too: noise is
// that of the widest discs inside, and the edge is as sharp as by the narrowest ones.
TEST(CausticMap, SmoothLightHasLittleNoiseAndEdgesStaySharp) {
  const TracedScene lit(
      SceneBuilder().square(white, Vector3d::Zero(), Vector3d::UnitZ(), 1.0).build());
  constexpr int count = 1 << 17;
  std::mt19937 random(77);
  const auto uniform = [&] { return std::ldexp(double(random()), -32); };
  const CausticPhotons photons = spread(
      lit.caster, count,
      [&](float, float) {
        const double x = -uniform();
        return Vector3d(x, 2.0 * uniform() - 1.0, 0.0);
      },
      2.0f / count);
  const CausticMap map(lit.mesh, photons);
  const int k = CausticMap::neighbours(photons.count());
  // The area of a disc holds k of the photons, which lie on 2 m^2.
  const double r = std::sqrt(2.0 * k / (count * std::numbers::pi));
  double square = 0.0, inside = 0.0, outside = 0.0;
  constexpr double other = 3.0;  // W/m^2, thrice the light of the photons
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) {
    const double y = -0.9 + 1.8 * (i + 0.5) / n;
    square += std::pow(irradiance_at(lit.caster, map, -0.5, y, other) - 1.0, 2) / n;
    inside += irradiance_at(lit.caster, map, -2.0 * r, y, other) / n;
    outside += irradiance_at(lit.caster, map, 2.0 * r, y, other) / n;
  }
  const double narrow = std::sqrt(4.0 / 3.0 / k);
  std::printf("noise %.4f, of the narrowest discs %.4f; %.4f beside the edge, %.4f beyond\n",
              std::sqrt(square), narrow, inside, outside);
  // Clusters have 6 photons or more: noise of at most 1 / sqrt(6) of the narrowest discs'.
  EXPECT_LT(std::sqrt(square), narrow / std::sqrt(6.0));
  // The mean along the edge is off by one and a half standard deviations at most, from which on a
  // wider disc counts for nothing.
  EXPECT_NEAR(inside, 1.0, 1.5 * narrow);
  EXPECT_EQ(outside, 0.0);
  // The power of 2 W: the map may differ by one and a half standard deviations as far from the edge
  // as the widest discs reach, 7 r for an area of at most 48 times that of the narrowest ones.
  double power = 0.0;
  constexpr int steps = 200;
  for (int i = 0; i < steps * steps; ++i) {
    const double x = -1.0 + 2.0 * (i % steps + 0.5) / steps,
                 y = -1.0 + 2.0 * (i / steps + 0.5) / steps;
    power += irradiance_at(lit.caster, map, x, y, other) * 4.0 / (steps * steps);
  }
  std::printf("power %.4f of 2\n", power);
  EXPECT_NEAR(power, 2.0, 2.0 * 7.0 * r * 1.5 * narrow);
}

// A wall divides a floor: light in front of the wall stays off the floor behind for any disc
// radius.
TEST(CausticMap, NoLightPassesBeneathAWall) {
  const TracedScene lit(SceneBuilder()
                            .square(white, Vector3d::Zero(), Vector3d::UnitZ(), 1.0)
                            .polygon(white, {{0, -1, 0}, {0, 1, 0}, {0, 1, 1}, {0, -1, 1}})
                            .build());
  const CausticPhotons photons = spread(
      lit.caster, 64, [](float u, float v) { return Vector3d(-0.1 * u, v - 0.5, 0); }, 1.0f);
  const CausticMap map(lit.mesh, photons);
  EXPECT_GT(irradiance_at(lit.caster, map, -0.01, 0.1), 1.0);
  EXPECT_EQ(irradiance_at(lit.caster, map, 0.01, 0.1), 0.0);
}

// A lamp over a mirror: the ceiling receives the light that the mirror image of the lamp would send
// through a window in place of the mirror.
class MirroredLamp {
 public:
  static constexpr float M = 10.0f, rho = 0.8f;
  TracedScene lit{SceneBuilder()
                      .square({.exitance = M, .one_sided = true}, {0, 0, 1}, {0, 0, -1}, 0.1)
                      .square({.specular = rho, .one_sided = true}, {0, 0, 0}, {0, 0, 1}, 0.5)
                      .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 2}, {0, 0, -1}, 4.0)
                      .build()};

  MirroredLamp() { lit.solution.caustic_irradiance = lit.solution.indirect_irradiance; }

  // Irradiance by the mirrored lamp, at a point for which neither the mirror's rim nor the lamp
  // hides the image.
  static double irradiance(double x, double y) {
    const Loop lamp{{-0.1, -0.1, -1}, {0.1, -0.1, -1}, {0.1, 0.1, -1}, {-0.1, 0.1, -1}};
    return double{rho * M} *
           std::abs(point_to_polygon({x, y, 2}, {0, 0, -1}, std::vector<Loop>{lamp}));
  }

  // RMS relative error over 150 points, and the number of neighbours in a disc.
  std::pair<double, int> error(int photon_count) const {
    const CausticPhotons photons =
        shoot_photons({lit.scene, lit.caster, lit.direct_light}, photon_count, 4);
    const CausticMap map(lit.mesh, photons);
    double square = 0.0;
    int n = 0;
    for (int i = 0; i < 15; ++i) {
      for (int j = 0; j < 10; ++j, ++n) {
        const double x = 0.62 + 0.02 * i, y = -0.2 + 0.04 * j;
        const Ray ray{.origin = {x, y, 1.5}, .direction = {0, 0, 1}};
        ElementHit hit;
        lit.caster.closest_hits({&ray, 1}, {&hit, 1});
        const double E =
            static_cast<double>(map.irradiance({x, y, 2.0}, -Vector3d::UnitZ(), hit.element)[0]);
        square += std::pow(E / irradiance(x, y) - 1.0, 2);
      }
    }
    return {std::sqrt(square / n), CausticMap::neighbours(photons.count())};
  }
};

// The standard error by k neighbours among independent photons is sqrt(4/3 / k), and k grows as
// N^(2/3). The light is smooth, so the bias of discs is smaller.
TEST(CausticMap, LightOffAMirrorIsThatOfTheMirroredLamp) {
  const MirroredLamp mirrored;
  double last = 1.0;
  for (const int count : {1 << 15, 1 << 18, 1 << 21}) {
    const auto [error, k] = mirrored.error(count);
    std::printf("%8d photons, k = %3d: relative RMS error %.4f\n", count, k, error);
    // Discs overlap, so 150 points count as a few dozen independent ones: the RMS has a standard
    // error of some 15 %, of which two are allowed.
    EXPECT_LT(error, 1.3 * std::sqrt(4.0 / 3.0 / k));
    EXPECT_LT(error, 0.7 * last);
    last = error;
  }
}

// The 96 bands that a scene may have, each with the same light.
TEST(CausticMap, HasTheBandsOfThePhotons) {
  const TracedScene lit(
      SceneBuilder().square(white, Vector3d::Zero(), Vector3d::UnitZ(), 1.0).build());
  CausticPhotons photons = spread(
      lit.caster, 1 << 15,
      [](float u, float v) { return Vector3d(2.0 * u - 1.0, 2.0 * v - 1.0, 0); }, 1.0f);
  photons.power.setConstant(photons.power.rows(), max_bands, 1.0f);
  const Spectrum E =
      CausticMap(lit.mesh, photons).irradiance({0.1, 0.2, 0.0}, Vector3d::UnitZ(), 0);
  ASSERT_EQ(E.size(), max_bands);
  EXPECT_GT(E[0], 0.0f);
  EXPECT_TRUE((E == E[0]).all());
}

TEST(CausticMap, PicturesShowIt) {
  const MirroredLamp mirrored;
  const Camera camera = camera_towards({0.75, 0.1, 1.0}, {0.75, 0.1, 2.0}, 10.0, 8);
  for (const Pass pass : {Pass::direct, Pass::gather}) {
    const Image seen = mirrored.lit.render(camera, {.pass = pass, .gather_rays = 16});
    const double L = 0.5 * MirroredLamp::irradiance(0.75, 0.1) / std::numbers::pi;
    EXPECT_NEAR(seen.radiance.col(0).cast<double>().mean(), L, 0.03 * L);
  }
  // Without photons caustics are those of the solution, which has none here.
  const Image without = mirrored.lit.render(camera, {.photons = 0});
  EXPECT_EQ(without.radiance.maxCoeff(), 0.0f);
}

TEST(CausticMap, PicturesHaveTheSameBitsOnAnyNumberOfThreads) {
  const MirroredLamp mirrored;
  const Camera camera = camera_towards({0.75, 0.1, 1.0}, {0.75, 0.1, 2.0}, 40.0, 16);
  Image one, five;
  {
    const ThreadLimit limit(1);
    one = mirrored.lit.render(camera, {.photons = 1 << 14});
  }
  {
    const ThreadLimit limit(5);
    five = mirrored.lit.render(camera, {.photons = 1 << 14});
  }
  EXPECT_TRUE((one.radiance == five.radiance).all());
}

}  // namespace
}  // namespace lightwell::caustic_map_test
