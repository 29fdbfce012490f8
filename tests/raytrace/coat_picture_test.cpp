// Pictures of coated surfaces, and the light that these give.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "radiosity/gather/final_gather.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solve.h"
#include "raytrace/shading/shade.h"
#include "scene/coat.h"
#include "scene/io/read_scene.h"
#include "scene/optics.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::coat_picture_test {
namespace {

constexpr double pi = std::numbers::pi;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

double radiance(const TracedScene& lit, const Ray& ray, std::uint64_t key = 1) {
  return static_cast<double>(RayTree(lit.scene, lit.caster, lit.direct_light, lit.solution, {})
                                 .trace(ray, key)
                                 .radiance[0]);
}

Material coat_of(float roughness) {
  Material material{.specular = Spectrum::Ones(1), .specular_roughness = roughness};
  material.reflectance = material.emission = Spectrum::Zero(1);
  material.coat = Coat{.index_of_refraction = 1.5f};
  return material;
}

// A white base under a coat of index 1.5.
Paint white_under_coat(float roughness) {
  const auto mirrored = static_cast<float>(CoatedBase(coat_of(roughness)).mean_mirrored());
  return {.reflectance = 1.0f - mirrored, .roughness = roughness, .coat = 1.5f};
}

class CoatInAFurnace : public testing::TestWithParam<float> {};

// In a world of radiance 1 a white coated surface is invisible. A smooth coat mirrors exactly what
// the base does not get. Spectra are floats, and a hit is known to 1e-7 of its distance. A rough
// coat mirrors Fresnel's share at each sampled microfacet, with a standard deviation of 0.2 at 80
// degrees and less elsewhere: 400 rays of at least 4 samples leave 0.2 / sqrt(1600) = 0.005, of
// which two are allowed.
TEST_P(CoatInAFurnace, WhiteIsInvisible) {
  TracedScene lit(SceneBuilder()
                      .box({.exitance = static_cast<float>(pi)}, {-3, -3, -3}, {3, 3, 3}, true)
                      .square(white_under_coat(GetParam()), {0, 0, 0}, up, 1.0)
                      .build());
  lit.set_indirect([](const Eigen::Vector3d&) { return static_cast<float>(pi); });
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    const double angle = degrees * pi / 180.0;
    const Eigen::Vector3d from(2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle));
    double sum = 0.0;
    constexpr int rays = 400;
    for (int i = 0; i < rays; ++i) {
      sum += radiance(lit, {.origin = from, .direction = -from.normalized()},
                      static_cast<std::uint64_t>(i)) /
             rays;
    }
    EXPECT_NEAR(sum, 1.0, GetParam() > 0.0f ? 1e-2 : 1e-5) << degrees;
  }
}

INSTANTIATE_TEST_SUITE_P(Coats, CoatInAFurnace, testing::Values(0.0f, 0.1f, 0.3f));

// Each ray shows the furnace through two white perforated sheets under smooth coats, so pixels may
// compare a few rays: light that passes straight on is left to no chance. Chance decides over light
// that coats mirror to and fro between the sheets. The second coat mirrors at most 0.3 F of a ray,
// with F = 0.09 at 60 degrees. Each coat after that mirrors 0.25 of this at most if it is chosen:
// 0.3 * 0.09 (0.25 + 0.25^2 + ...) in all.
TEST(Coat, ShowsWhatLiesBehindTwoSheetsByEachRay) {
  Paint sheet = white_under_coat(0.0f);
  sheet.transparent = 0.3f;
  sheet.reflectance -= sheet.transparent;
  TracedScene lit(SceneBuilder()
                      .box({.exitance = static_cast<float>(pi)}, {-3, -3, -3}, {3, 3, 3}, true)
                      .square(sheet, {0, 0, 0}, up, 1.0)
                      .square(sheet, {0, 0, -0.2}, up, 1.0)
                      .build());
  lit.set_indirect([](const Eigen::Vector3d&) { return static_cast<float>(pi); });
  constexpr double by_chance = 0.3 * 0.09 * 0.25 / (1.0 - 0.25);  // 0.009
  for (const double degrees : {0.0, 30.0, 60.0}) {
    const double angle = degrees * pi / 180.0;
    const Eigen::Vector3d from(2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle));
    for (std::uint64_t key = 0; key < 100; ++key) {
      const Ray ray{.origin = from, .direction = -from.normalized()};
      EXPECT_NEAR(radiance(lit, ray, key), 1.0, by_chance) << degrees;
    }
  }
}

// A coated square, 2 m below a lamp of 5 W/sr that hangs 1 m beside its middle.
constexpr float rho = 0.4f;
struct LampOverCoat {
  LampOverCoat() : lit(with_lamp(), 0.25) {}
  static Scene with_lamp() {
    Scene scene =
        SceneBuilder().square({.reflectance = rho, .coat = 1.5f}, {0, 0, 0}, up, 1.0).build();
    scene.lamps = {{.name = "lamp", .position = at, .intensity = Spectrum::Constant(3, 5.0f)}};
    return scene;
  }
  // Irradiance and cosine of its angle at a point of the square.
  static std::pair<double, double> arriving(const Eigen::Vector3d& point) {
    const Eigen::Vector3d to = at - point;
    const double cosine = to.z() / to.norm();
    return {5.0 * cosine / to.squaredNorm(), cosine};
  }
  static inline const Eigen::Vector3d at{1, 0, 2};
  TracedScene lit;
};

// L = rho / pi g(in) g(out) E; the lamp has no size and is not mirrored. Some ten
// products of floats round by 6e-8 each, and an error of 1e-7 of the distance moves E by 1e-6.
TEST(Coat, TurnsLightByBothAngles) {
  const LampOverCoat over;
  const CoatedBase base(coat_of(0.0f));
  for (const double degrees : {0.0, 40.0, 75.0}) {
    const double angle = degrees * pi / 180.0;
    const Eigen::Vector3d point(0.2, 0.3, 0.0), back(0, std::sin(angle), std::cos(angle));
    const auto [E, cos_in] = LampOverCoat::arriving(point);
    const double exact = rho / pi * base.factor(cos_in) * base.factor(std::cos(angle)) * E;
    EXPECT_NEAR(radiance(over.lit, {.origin = point + back, .direction = -back}) / exact, 1.0, 1e-5)
        << degrees;
  }
}

// The mesh's radiosity of a base: rho g(in) E at its vertices. The points for g lie 2 % of the way
// to the centre of an element of 0.125 m inside: 2 mm, 8e-4 rad as the lamp sees them at 2.2 m.
// Below 55 degrees g changes by less than 0.3 per rad. Without g there is one product of floats.
TEST(Coat, GivesTheMeshMoreOfSteepLight) {
  const LampOverCoat over;
  const PatchMesh& mesh = over.lit.mesh;
  const CoatedBase base(coat_of(0.0f));
  BandArray E(mesh.vertex_count(), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    E.row(v).setConstant(static_cast<float>(LampOverCoat::arriving(mesh.position(v)).first));
  }
  const BandArray B = gatherable_radiosity(mesh, over.lit.direct_light, E, E);
  const BandArray even = gatherable_radiosity(mesh, over.lit.direct_light, E);
  int lit = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto expected = base.factor(LampOverCoat::arriving(mesh.position(v)).second);
    EXPECT_NEAR(even(v, 1) / (rho * E(v, 1)), 1.0, 1e-6);
    if (B(v, 1) == even(v, 1)) continue;  // the dark side
    EXPECT_NEAR(B(v, 1) / even(v, 1), expected, 3e-4);
    ++lit;
  }
  EXPECT_GE(2 * lit, mesh.vertex_count() - 2);
}

// Light that arrives by way of a coat: 1 - F(45 degrees) of a ray's light is left to the base, and
// the rest goes to the wall beside.
TEST(Coat, MirrorsFresnelsShareAlongPaths) {
  const TracedScene lit(
      SceneBuilder()
          .square({.reflectance = 0.5f, .coat = 1.5f}, {0, 0, 0}, up, 2.0)
          .square({.reflectance = 0.5f}, {3, 0, 2}, -Eigen::Vector3d::UnitX(), 2.0)
          .build());
  const LightPaths paths(lit.scene, lit.caster, 8);
  const Ray ray{.origin = {-1, 0, 2}, .direction = Eigen::Vector3d(1, 0, -1).normalized()};
  ElementHit hit;
  lit.caster.closest_hits({&ray, 1}, {&hit, 1});
  ASSERT_GE(hit.facet, 0);
  EXPECT_TRUE(paths.is_specular(hit.facet));
  EXPECT_TRUE(paths.is_mostly_diffuse(hit.facet));
  EXPECT_NEAR(paths.base_factor(ray, hit), CoatedBase(coat_of(0.0f)).factor(std::sqrt(0.5)),
              1e-12);  // doubles
  double arrived = 0.0;
  const PathLosses losses =
      paths.follow(ray, hit, 7, [&](const LightArrival& at) { arrived += at.throughput[0]; });
  // Fresnel at 45 degrees, index 1.5: the mean of 0.0920134 and its square. Spectra are floats.
  EXPECT_NEAR(arrived, 0.5 * (0.0920134 + 0.0920134 * 0.0920134), 1e-6);
  EXPECT_EQ(losses.escaped[0], 0.0f);
}

// Power that the square below the lamp absorbs in three bands, W, of a share `mirrored` by the
// cosine: the midpoint rule of 40 x 40.
double absorbed_below_lamp(const std::function<double(double)>& mirrored) {
  double sum = 0.0;
  constexpr int steps = 40;
  for (int i = 0; i < steps * steps; ++i) {
    const Eigen::Vector3d point(2.0 * (i % steps + 0.5) / steps - 1.0,
                                2.0 * (i / steps + 0.5) / steps - 1.0, 0.0);
    const auto [E, cosine] = LampOverCoat::arriving(point);
    sum += 3.0 * (1.0 - mirrored(cosine)) * E * 4.0 / (steps * steps);
  }
  return sum;
}

// A black square under a coat, in the open, 2 m below a lamp that hangs 1 m beside its middle. The
// coat mirrors F(theta) of the light, and the base absorbs the rest: int (1 - F) E dA. The square
// fills 0.72 sr, so 60000 of the lamp's million rays meet it: 0.4 % if they were not stratified.
TEST(Coat, BlackBasesAbsorbWhatTheirCoatDoesNotMirror) {
  Scene scene = LampOverCoat::with_lamp();
  scene.materials[0].reflectance.setZero();
  const double expected =
      absorbed_below_lamp([](double cosine) { return fresnel_reflectance(cosine, 1.5); });
  for (const bool shoots : {false, true}) {
    SolveOptions options{.gather = {.rays = 64}, .refine = {.tolerance = 0.0}};
    options.caustic_rays = 1 << 14;
    if (shoots) options.progressive = ProgressiveOptions{};
    const EnergyBalance energy = solve_scene(scene, options).solution.energy;
    EXPECT_NEAR(energy.absorbed / expected, 1.0, 0.01) << shoots;
  }
}

// The same square as a dim metal: it absorbs what its angle does not mirror.
TEST(Metal, AbsorbsWhatItDoesNotMirror) {
  Scene scene = LampOverCoat::with_lamp();
  Material& metal = scene.materials[0];
  metal.reflectance.setZero();
  metal.coat.reset();
  metal.metal = Conductor{.eta = Spectrum::Constant(3, 2.0f), .k = Spectrum::Constant(3, 1.0f)};
  const double expected = absorbed_below_lamp(
      [&](double cosine) { return double{reflectance_at(*metal.metal, cosine)[0]}; });
  SolveOptions options{.gather = {.rays = 64}, .refine = {.tolerance = 0.0}};
  options.caustic_rays = 1 << 14;
  const EnergyBalance energy = solve_scene(scene, options).solution.energy;
  EXPECT_NEAR(energy.absorbed / expected, 1.0, 0.01);
}

// A black lacquer under a ceiling that is bright in one corner, which a few percent of the lobe's
// directions meet. Directions that miss the corner by chance must not end the search for it: means
// of few and of many directions differ by no more than their noise, of which four standard errors
// are allowed.
TEST(Coat, MeansDoNotDependOnTheNumberOfDirections) {
  Scene scene = SceneBuilder()
                    .square({.coat = 1.5f}, {0, 0, 0}, up, 2.0)
                    .square({.reflectance = 0.9f}, {0, 0, 2}, -up, 2.0)
                    .build();
  scene.materials[0].specular_roughness = 0.3f;
  TracedScene lit(std::move(scene));
  lit.set_indirect([](const Eigen::Vector3d& at) {
    return at.z() > 1.0 && at.x() > 0.7 && at.y() > 0.7 ? 100.0f : 1.0f;
  });
  struct Mean {
    double value = 0.0, square = 0.0;
    int count = 0;
    double variance() const { return (square / count - std::pow(value / count, 2)) / count; }
  };
  const auto mean_of = [&](int directions) {
    RenderOptions options;
    options.glossy_rays = directions;
    const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
    Mean mean;
    for (mean.count = 0; mean.count < 4000; ++mean.count) {
      const Ray ray{.origin = {-1.0, 0.0, 1.0},
                    .direction = Eigen::Vector3d(1, 0, -1).normalized()};
      const auto key = static_cast<std::uint64_t>(mean.count);
      const auto L = static_cast<double>(tree.trace(ray, key).radiance[0]);
      mean.value += L;
      mean.square += L * L;
    }
    return mean;
  };
  const Mean few = mean_of(1), many = mean_of(32);
  const double a = few.value / few.count, b = many.value / many.count;
  const double noise = std::sqrt(few.variance() + many.variance());
  std::printf("few directions %.5f, many %.5f, standard error %.5f\n", a, b, noise);
  EXPECT_NEAR(a, b, 4.0 * noise);
  // A search that ends early was off by 6 % and more in a room, which four standard errors show.
  EXPECT_LT(4.0 * noise, 0.06 * b);
}

// A black lacquer below a lamp, whose highlight a thin pane in between dims by what both of its
// faces mirror: 2 R / (1 + R) = 0.077 at normal incidence of index 1.5. The lobe of alpha 0.1 meets
// the lamp by chance behind the pane; 400 rays of 4 directions and more leave 3 % of noise.
TEST(Coat, ShowsLampsBehindPanesToo) {
  const auto highlight = [](bool has_pane) {
    SceneBuilder builder;
    builder.square({.coat = 1.5f}, {0, 0, 0}, up, 1.0)
        .square({.exitance = static_cast<float>(pi)}, {0, 0, 2}, -up, 0.5);
    if (has_pane) {
      builder.square({.index_of_refraction = 1.5f, .thin = true}, {0, 0, 1}, up, 2.0);
    }
    Scene scene = builder.build();
    scene.materials[0].specular_roughness = 0.1f;
    const TracedScene lit(std::move(scene));
    double sum = 0.0;
    constexpr int rays = 400;
    for (int i = 0; i < rays; ++i) {
      const Ray ray{.origin = {0.1, 0.0, 0.5}, .direction = -up};
      sum += radiance(lit, ray, static_cast<std::uint64_t>(i)) / rays;
    }
    return sum;
  };
  const double bare = highlight(false), behind = highlight(true);
  EXPECT_GT(bare, 0.02);
  EXPECT_NEAR(behind / bare, 1.0 - 0.077, 0.1);
}

// Against a path tracer: squares of 8 x 8 pixels, whose own error is 0.3 %. The solution is
// accurate to 0.5 % of the mean irradiance, and dim squares have half of that light.
TEST(Coat, LooksAsInAPathTracersPicture) {
  const std::filesystem::path folder = LIGHTWELL_TEST_DATA "/raytrace/plastics";
  const Scene scene = read_scene(folder / "room.xml");
  const SolvedScene solved = solve_scene(scene, {});
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  const Image image =
      render(scene, caster, direct_light, solved.solution, scene.cameras.at(0), RenderOptions{});
  const auto stored = nlohmann::json::parse(std::ifstream(folder / "blocks.json"));
  const int rows = stored.at("rows"), columns = stored.at("columns");
  ASSERT_EQ(image.width, 8 * columns);
  double square = 0.0, bias = 0.0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      double found = 0.0, expected = 0.0;
      for (int p = 0; p < 64; ++p) {
        found += image.radiance.row((8 * r + p / 8) * image.width + 8 * c + p % 8).sum() / 64.0;
      }
      for (const double L : stored.at("radiance").at(r).at(c)) expected += L;
      const double error = found / expected - 1.0;
      square += error * error / (rows * columns);
      bias += error / (rows * columns);
    }
  }
  std::cout << "RMS " << 100.0 * std::sqrt(square) << " %, mean " << 100.0 * bias << " %\n";
  EXPECT_LT(std::sqrt(square), 0.02);
  EXPECT_NEAR(bias, 0.0, 0.01);
}

}  // namespace
}  // namespace lightwell::coat_picture_test
