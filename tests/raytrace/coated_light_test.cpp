// Light that is not even on coated bases: a low sky, a bright wall beside, furnaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/sky/sky_light.h"
#include "raytrace/shading/shade.h"
#include "scene/coat.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::coated_light_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr float rho = 0.4f;
const Vector3d up = Vector3d::UnitZ();

CoatedBase base_of_coat(float roughness = 0.0f) {
  Material material{.specular = Spectrum::Ones(1), .specular_roughness = roughness};
  material.reflectance = material.emission = Spectrum::Zero(1);
  material.coat = Coat{.index_of_refraction = 1.5f};
  return CoatedBase(material);
}

// Light of a plate at the origin that faces up, from where `shines` is true by the direction, as
// its coated base takes the light and as it arrives: int g cos and int cos by the midpoint rule
// over 512 x 512 steps of azimuth and cosine.
struct Arriving {
  double at_base = 0.0, on_plate = 0.0;
  double gain() const { return at_base / on_plate; }
};
Arriving arriving(const std::function<bool(const Vector3d&)>& shines) {
  const CoatedBase base = base_of_coat();
  constexpr int steps = 512;
  Arriving sum;
  for (int i = 0; i < steps; ++i) {
    const double mu = (i + 0.5) / steps, sine = std::sqrt(1.0 - mu * mu);
    for (int j = 0; j < steps; ++j) {
      const double phi = 2.0 * pi * (j + 0.5) / steps;
      if (!shines({sine * std::cos(phi), sine * std::sin(phi), mu})) continue;
      const double part = 2.0 * pi * mu / (steps * steps);
      sum.at_base += base.factor(mu) * part;
      sum.on_plate += part;
    }
  }
  return sum;
}

// A coated plate of 0.1 m below a black roof, 1 m above, that leaves the lowest 22 degrees of an
// even sky open, and more at its corners.
constexpr double roof = 2.475;
struct LowSky {
  LowSky() : lit(scene(), 0.05) {}
  static Scene scene() {
    Scene built = SceneBuilder()
                      .square({.reflectance = rho, .coat = 1.5f}, {0, 0, 0}, up, 0.05)
                      .square({}, {0, 0, 1}, -up, roof)
                      .build();
    built.sky = test::even_sky(built.bands, 1.0f, 0.0f);
    return built;
  }
  // The square's sides are parallel to `a` and to the cross product of `a` with the vertical.
  static bool is_open(const Vector3d& direction) {
    const Vector3d a = up.unitOrthogonal(), b = up.cross(a);
    const Vector3d at = direction / direction.z();
    return std::max(std::abs(at.dot(a)), std::abs(at.dot(b))) > roof;
  }
  TracedScene lit;
};

// E at the base over E for shadow rays to the sky, as pictures and gathers ask for it. The factor
// deviates from its mean over the open sky by 0.2 at most: 64 looks of 64 rays and more leave
// 0.2 / sqrt(4096) = 0.003, of which four are allowed.
TEST(CoatedLight, OfALowSkyIsWeighedByItsAngle) {
  const LowSky under;
  const double expected = arriving(LowSky::is_open).gain();
  EXPECT_LT(expected, 0.85);  // what even light would be 1
  const CoatedBase base = base_of_coat();
  double plain = 0.0, at_base = 0.0, by_one_ray = 0.0;
  constexpr int keys = 64;
  for (int key = 0; key < keys; ++key) {
    LightQuery query{.at = {{0, 0, 0}, up, 0},
                     .key = static_cast<std::uint64_t>(key),
                     .shadows = {.min_rays = 16, .max_rays = 64}};
    const auto E = [&] {
      return double{under.lit.direct_light.irradiance(under.lit.caster, query)[1]};
    };
    plain += E();
    query.base = &base;
    at_base += E();
    query.shadows = {.min_rays = 1, .max_rays = 1};
    for (int i = 0; i < keys; ++i) {
      query.key = static_cast<std::uint64_t>(keys * key + i);
      by_one_ray += E() / keys;
    }
  }
  EXPECT_NEAR(at_base / plain, expected, 0.012);
  // One ray of 4096 finds sky or none: half of them leave 1 / sqrt(4096), of which four are
  // allowed.
  EXPECT_NEAR(by_one_ray / plain, expected, 4.0 / 64.0);
}

// Radiance of the plate straight from above in a picture, over that by the known irradiance: the
// noise is that of the light itself, 1 / sqrt(64 * 64) of rays of which half find sky, of which
// four are allowed.
TEST(CoatedLight, OfALowSkyShowsInPictures) {
  const LowSky under;
  const Arriving sky = arriving(LowSky::is_open);
  const RayTree tree(under.lit.scene, under.lit.caster, under.lit.direct_light, under.lit.solution,
                     {.pass = Pass::direct});
  double sum = 0.0;
  constexpr int keys = 64;
  for (int key = 0; key < keys; ++key) {
    const Ray ray{.origin = {0.01, 0.02, 0.5}, .direction = -up};
    sum += double{tree.trace(ray, static_cast<std::uint64_t>(key)).radiance[1]} / keys;
  }
  const double expected = rho / pi * base_of_coat().factor(1.0) * sky.at_base;
  EXPECT_NEAR(sum / expected, 1.0, 4.0 / 64.0);
}

// The gain that sites of the sky know, for the mesh's radiosity rho gain E. Two rays through
// each of the 64 cells that the roof cuts leave 0.35 / 8 of their light, half of all, whose factor
// differs from the mean by 0.1: 0.2 %. Four points of a cell of 5.6 degrees and 32 steps of the
// cosine are midpoint rules; at the horizon, where the factor rises by 0.06 per degree, a step of
// 1.8 degrees holds 1 / 140 of the light: 0.1 %.
TEST(CoatedLight, OfALowSkyIsInTheRadiosityOfTheMesh) {
  const LowSky under;
  const double expected = arriving(LowSky::is_open).gain();
  const PatchMesh& mesh = under.lit.mesh;
  const BandArray E = BandArray::Ones(mesh.vertex_count(), 3);
  const BandArray B = gatherable_radiosity(mesh, under.lit.direct_light, E, E);
  int seen = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.position(v).z() > 0.5 || B(v, 0) == rho) continue;  // the roof, the dark side
    EXPECT_NEAR(B(v, 0) / rho, expected, 0.01);
    ++seen;
  }
  EXPECT_GE(seen, 4);
}

// The table of an open place under an even sky: the two midpoint rules above, over all the sky.
TEST(CoatedLight, OfAnOpenSkyIsEven) {
  Scene scene =
      SceneBuilder().square({.reflectance = rho, .coat = 1.5f}, {0, 0, 0}, up, 1.0).build();
  scene.sky = test::even_sky(scene.bands, 1.0f, 0.0f);
  const TracedScene lit(scene);
  const CoatedBase base = base_of_coat();
  EXPECT_NEAR(lit.direct_light.base_gain({{0.1, 0.2, 0}, up, 0}, base), 1.0, 1e-3);
}

// A sun that a roof hides from the plate says nothing of the plate's light.
TEST(CoatedLight, OfASkyIsNotThatOfAHiddenSun) {
  Scene scene = LowSky::scene();
  scene.sky->sun = Sun{.direction = Vector3d(0.1, 0.0, 1.0).normalized(),
                       .irradiance = constant_spectrum(scene.bands, 1000.0f)};
  const TracedScene lit(scene, 0.05);
  const CoatedBase base = base_of_coat();
  // The bound of the mesh's radiosity above, by the same cells.
  EXPECT_NEAR(lit.direct_light.base_gain({{0, 0, 0}, up, 0}, base),
              arriving(LowSky::is_open).gain(), 0.01);
}

// A coated plate of 0.1 m beside a wall of radiosity 1 that stands at its edge of 1 m length.
struct BesideAWall {
  BesideAWall() : lit(scene(), 0.02) {
    lit.set_indirect([](const Vector3d& at) { return is_on_wall(at) ? 2.0f : 1.0f; });
  }
  static bool is_on_wall(const Vector3d& at) { return at.x() > 0.5; }
  static Scene scene() {
    return SceneBuilder()
        .square({.reflectance = rho, .coat = 1.5f}, {0, 0, 0}, up, 0.05)
        .square({.reflectance = 0.5f}, {1, 0, 0.25}, -Vector3d::UnitX(), 0.25)
        .build();
  }
  static bool meets_wall(const Vector3d& direction) {
    if (!(direction.x() > 0.0)) return false;
    const Vector3d at = direction / direction.x();
    return at.z() < 0.5 && std::abs(at.y()) < 0.25;
  }
  TracedScene lit;
};

// Gains at the vertices of the plate from 64 rays of each of its elements, 25 on a side. The wall
// takes 4 % of the rays, and the factor varies by 0.15 over the wall: 0.15 / sqrt(64) is left. The
// set of 64 cosines knows the factor's mean to 0.5 %.
TEST(CoatedLight, OfAWallIsWeighedByItsAngle) {
  const BesideAWall beside;
  const Arriving wall = arriving(BesideAWall::meets_wall);
  EXPECT_LT(wall.gain(), 0.85);
  const PatchMesh& mesh = beside.lit.mesh;
  const LitScene lit{beside.lit.scene, beside.lit.caster, beside.lit.direct_light};
  const BandArray even = gatherable_radiosity(mesh, beside.lit.direct_light, beside.lit.solution);
  const BandArray gains = indirect_base_gains(lit, even, 64);
  ASSERT_EQ(gains.rows(), mesh.vertex_count());
  double sum = 0.0;
  int seen = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (BesideAWall::is_on_wall(mesh.position(v))) {
      EXPECT_EQ(gains(v, 0), 1.0f);
    } else if (gains(v, 0) != 1.0f) {
      sum += double{gains(v, 0)};
      ++seen;
    }
  }
  ASSERT_GE(seen, 16);
  EXPECT_NEAR(sum / seen, wall.gain(), 0.02);
}

// Gathers read rho gain E at the plate, whose E is 1 and all indirect, and the wall's light without
// a gain. Two products of floats round by 2^-24 each, and the sum 1 + (gain - 1) by as much.
TEST(CoatedLight, OfAWallIsInTheRadiosityOfTheMesh) {
  const BesideAWall beside;
  const PatchMesh& mesh = beside.lit.mesh;
  const LitScene lit{beside.lit.scene, beside.lit.caster, beside.lit.direct_light};
  const BandArray even = gatherable_radiosity(mesh, beside.lit.direct_light, beside.lit.solution);
  const BandArray gains = indirect_base_gains(lit, even, 32);
  const BandArray B = gatherable_radiosity(lit, beside.lit.solution);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_NEAR(B(v, 0) / even(v, 0), gains(v, 0), std::ldexp(4.0, -24)) << v;
  }
}

// Pictures of the plate, of 64 places all over it: with the mesh's light, E = 1 times the gain, and
// gathered, where E is what the wall gives. 64 looks of 256 rays, of which 4 % meet the wall, leave
// 1 / sqrt(655), of which two are allowed. The gains of the elements seen have 64 rays each, of
// which 4 % meet the wall, so 64 elements leave 0.15 / sqrt(164), of which two are allowed.
TEST(CoatedLight, OfAWallShowsInPictures) {
  const BesideAWall beside;
  const Arriving wall = arriving(BesideAWall::meets_wall);
  const auto radiance = [&](Pass pass) {
    const RayTree tree(beside.lit.scene, beside.lit.caster, beside.lit.direct_light,
                       beside.lit.solution, {.pass = pass, .gather_rays = 256});
    double sum = 0.0;
    constexpr int keys = 64;
    for (int key = 0; key < keys; ++key) {
      constexpr int across = 8;
      const double x = (key % across + 0.5) / across - 0.5, y = (key / across + 0.5) / across - 0.5;
      const Ray ray{.origin = {0.1 * x, 0.1 * y, 0.5}, .direction = -up};
      sum += double{tree.trace(ray, static_cast<std::uint64_t>(key)).radiance[1]} / keys;
    }
    return sum;
  };
  const double of_unit = rho / pi * base_of_coat().factor(1.0);
  for (const Pass pass : {Pass::interpolate, Pass::direct, Pass::automatic}) {
    EXPECT_NEAR(radiance(pass) / of_unit, wall.gain(), 2.0 * 0.15 / std::sqrt(164.0));
  }
  EXPECT_NEAR(radiance(Pass::gather) / of_unit / (wall.at_base / pi), 1.0, 0.08);
}

// In a closed furnace all rays find the same light, and the gain is 1 to rounding: 32 sums of
// floats.
TEST(CoatedLight, OfAFurnaceIsEven) {
  TracedScene lit(SceneBuilder()
                      .box({.reflectance = 0.5f}, {-1, -1, -1}, {1, 1, 1}, true)
                      .square({.reflectance = rho, .coat = 1.5f}, {0, 0, -0.5}, up, 0.5)
                      .build());
  lit.set_indirect([](const Vector3d& at) { return at.cwiseAbs().maxCoeff() > 0.9 ? 2.0f : 1.0f; });
  const LitScene scene{lit.scene, lit.caster, lit.direct_light};
  const BandArray B = gatherable_radiosity(lit.mesh, lit.direct_light, lit.solution);
  const BandArray gains = indirect_base_gains(scene, B, 32);
  ASSERT_EQ(gains.rows(), lit.mesh.vertex_count());
  EXPECT_NEAR(double{gains.minCoeff()}, 1.0, 32.0 * std::ldexp(1.0, -24));
  EXPECT_NEAR(double{gains.maxCoeff()}, 1.0, 32.0 * std::ldexp(1.0, -24));
}

}  // namespace
}  // namespace lightwell::coated_light_test
