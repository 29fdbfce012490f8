// Light between places within one absorbing body, such as the walls of a pool.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/openings/find_openings.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/sample_mean.h"

namespace lightwell::absorbing_bodies_test {
namespace {

// Absorption of the bands r, g and b, 1/m: nothing, some, much.
const std::array<float, 3> absorption = {0.0f, 0.7f, 2.0f};

// Coloured water that neither bends nor mirrors light.
Material water(const Bands& bands) {
  Material material = test::diffuse(bands, 0.0f);
  Spectrum a(3);
  a << absorption[0], absorption[1], absorption[2];
  material.dielectric = Dielectric{
      .index_of_refraction = 1.0f, .tint = constant_spectrum(bands, 1.0f), .absorption = a};
  material.one_sided = false;
  return material;
}

// Half the width of the gap between the two bodies of water of a pool.
constexpr double gap = 1e-4;
constexpr double depth = 0.5;

// Parts water by a narrow gap between two surfaces, at the x of the middle between two corners.
void add_gap(Scene& scene, int water, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const double x = 0.5 * (low.x() + high.x());
  const auto at = [&](double side, double y, double z) {
    return Eigen::Vector3d(x + side * gap, y, z);
  };
  const double y0 = low.y(), y1 = high.y(), z0 = low.z(), z1 = high.z();
  // The water before the gap ends with a surface that faces +x, and that behind with one to -x.
  test::add_polygon(scene, "before the gap", water,
                    {at(-1, y0, z0), at(-1, y1, z0), at(-1, y1, z1), at(-1, y0, z1)});
  test::add_polygon(scene, "behind the gap", water,
                    {at(1, y0, z0), at(1, y0, z1), at(1, y1, z1), at(1, y1, z0)});
}

// The space over a floor, x and y in [0, 1], full of water up to z = depth, in two bodies that a
// narrow gap at x = 1/2 parts. The walls are `walls`. Light that crosses the gap meets surfaces of
// the water, and other light does not, but both are dimmed alike.
Scene pool(const Material& floor, const Material& ceiling, const Material& walls) {
  Scene scene;
  const int w = test::add_material(scene, water(scene.bands));
  const int at_sides = test::add_material(scene, walls);
  const int below = test::add_material(scene, floor), above = test::add_material(scene, ceiling);
  add_gap(scene, w, {0.5, 0, 0}, {0.5, 1, depth});
  test::add_box(scene, {0, 0, 0}, {1, 1, depth},
                {at_sides, at_sides, at_sides, at_sides, below, above}, true);
  return scene;
}

// 2 E_3(x): the share of even light that passes a layer of optical thickness x, by Simpson's rule.
double layer_passes(double x) {
  const auto f = [&](double u) { return u > 0.0 ? 2.0 * u * std::exp(-x / u) : 0.0; };
  constexpr int parts = 2000;
  double sum = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double low = double(i) / parts, high = double(i + 1) / parts;
    sum += (f(low) + 4.0 * f(0.5 * (low + high)) + f(high)) / (6.0 * parts);
  }
  return x > 0.0 ? sum : 1.0;
}

struct Slab {
  double floor = 0.0, ceiling = 0.0;  // B
};

// B_c = M + rho_c t B_f and B_f = rho_f t B_c, t = 2 E_3(a depth), of two endless planes.
Slab slab(double M, double rho_floor, double rho_ceiling, double a) {
  const double t = layer_passes(a * depth);
  const double ceiling = M / (1.0 - rho_floor * rho_ceiling * t * t);
  return {.floor = rho_floor * t * ceiling, .ceiling = ceiling};
}

std::vector<double> values_of(const Scene& scene, const PatchMesh& mesh, const std::string& name,
                              const std::function<double(int)>& value) {
  std::vector<double> values;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (scene.surfaces[static_cast<std::size_t>(mesh.surface[p])].name == name) {
      values.push_back(value(p));
    }
  }
  return values;
}

constexpr float rho_floor = 0.8f, rho_ceiling = 0.5f;

Scene slab_between_mirrors() {
  const Bands bands = rgb_bands();
  return pool(test::diffuse(bands, rho_floor), test::diffuse(bands, rho_ceiling, 1.0f),
              test::mirror(bands, 1.0f));
}

constexpr int rays_per_patch = 2048;

SolveOptions slab_options(FormFactorMethod method) {
  SolveOptions options;
  options.mesh.max_patch_size = 0.25;
  options.mesh.max_element_size = 0.25;
  options.refine.tolerance = 0.0;  // nothing is split: all patches of a plane have one closed form
  options.form_factors.method = method;
  options.form_factors.rays_per_patch = rays_per_patch;
  options.form_factors.hemicube_resolution = 128;
  options.gather.rays = 512;
  return options;
}

// All patches of a plane have one closed form. Their values are off by the noise of independent
// rows, and the mean by four of its standard errors at most; the gap lets 2e-4 m of a way of half a
// metre at least pass undimmed, which is a share of 2 a gap / cos, below 1e-3 in the mean.
// `tells`: the share of the closed form that the error must be below, for the test to tell a dimmed
// slab from another: without dimming, floors are brighter by half and more, so that each share
// below a half tells. Rows of 2048 rays are well below 5 %, gathers of 512 rays below 10 %, and
// shots of some hundred rays at a patch below 30 %.
void expect_mean(const std::vector<double>& values, double expected, double tells,
                 const std::string& what) {
  const auto [mean, standard_error] = test::mean_of(values);
  constexpr double of_gap = 1e-3;
  EXPECT_NEAR(mean, expected, 4.0 * standard_error + of_gap * expected) << what;
  EXPECT_LT(4.0 * standard_error, tells * expected) << what << " tells too little";
}

// Energy is two sums of floats, of what is left of a row's rays and of what is not. Each sum is off
// by a rounding per ray.
void expect_balance(const EnergyBalance& e) {
  EXPECT_NEAR((e.absorbed + e.escaped + e.unshot) / e.emitted, 1.0,
              std::ldexp(2.0 * rays_per_patch, -24));
}

class AbsorbingSlab : public testing::TestWithParam<FormFactorMethod> {};

TEST_P(AbsorbingSlab, HasTheRadiosityOfItsEquations) {
  const Scene scene = slab_between_mirrors();
  const SolvedScene solved = solve_scene(scene, slab_options(GetParam()));
  const BandArray& B = solved.solution.patch_radiosity;
  for (int band = 0; band < 3; ++band) {
    const Slab expected = slab(1.0, rho_floor, rho_ceiling, absorption[band]);
    const auto of_patch = [&](int p) { return double{B(p, band)}; };
    expect_mean(values_of(scene, solved.mesh, "z0", of_patch), expected.floor, 0.05, "floor");
    expect_mean(values_of(scene, solved.mesh, "z1", of_patch), expected.ceiling, 0.05, "ceiling");
  }
  expect_balance(solved.solution.energy);
}

INSTANTIATE_TEST_SUITE_P(ByMethod, AbsorbingSlab,
                         testing::Values(FormFactorMethod::automatic, FormFactorMethod::ray_cast,
                                         FormFactorMethod::hemicube, FormFactorMethod::analytic));

TEST(AbsorbingSlabByShots, HasTheRadiosityOfItsEquations) {
  const Scene scene = slab_between_mirrors();
  SolveOptions options = slab_options(FormFactorMethod::automatic);
  // Light left unshot is a thousandth, far below the noise of the shots, some percent.
  options.progressive = ProgressiveOptions{.tolerance = 1e-3};
  const SolvedScene solved = solve_scene(scene, options);
  for (int band = 0; band < 3; ++band) {
    const Slab expected = slab(1.0, rho_floor, rho_ceiling, absorption[band]);
    expect_mean(values_of(scene, solved.mesh, "z0",
                          [&](int p) { return double{solved.solution.patch_radiosity(p, band)}; }),
                expected.floor, 0.3, "floor");
  }
}

TEST(AbsorbingSlab, IsGatheredAtVertices) {
  const Scene scene = slab_between_mirrors();
  const SolvedScene solved = solve_scene(scene, slab_options(FormFactorMethod::automatic));
  const BandArray E = solved.solution.irradiance();
  const std::vector<int> patch = vertex_patches(solved.mesh);
  for (int band = 0; band < 3; ++band) {
    const Slab expected = slab(1.0, rho_floor, rho_ceiling, absorption[band]);
    std::vector<double> values;
    for (int v = 0; v < solved.mesh.vertex_count(); ++v) {
      const int surface = solved.mesh.surface[patch[static_cast<std::size_t>(v)]];
      if (scene.surfaces[static_cast<std::size_t>(surface)].name == "z0") {
        values.push_back(double{E(v, band)});
      }
    }
    expect_mean(values, expected.floor / double{rho_floor}, 0.1, "floor");
  }
}

// The inside of a ball full of water. A ray at the angle theta to the normal runs 2 R cos theta to
// the other side, wherever it begins, so that
//
//     E = T B,   T = 2 int exp(-x u) u du = 2 (1 - (1 + x) exp(-x)) / x^2,   x = 2 a R
//
// over u in (0, 1), and B = M + rho E = M / (1 - rho T) all over.
TEST(AbsorbingFurnace, HasTheRadiosityOfItsClosedForm) {
  constexpr double radius = 0.5;
  constexpr float rho = 0.8f;
  Scene scene;
  const int w = test::add_material(scene, water(scene.bands));
  Material wall = test::diffuse(scene.bands, rho, 1.0f);
  wall.one_sided = false;
  wall.emits_both_sides = true;
  add_gap(scene, w, {-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
  scene.surfaces.push_back({.name = "ball",
                            .material = test::add_material(scene, wall),
                            .shape = Sphere{{0, 0, 0}, radius}});
  const SolvedScene solved = solve_scene(scene, slab_options(FormFactorMethod::automatic));
  const PatchMesh& mesh = solved.mesh;
  for (int band = 0; band < 3; ++band) {
    const double x = 2.0 * double{absorption[band]} * radius;
    const double T = x > 0.0 ? 2.0 * (1.0 - (1.0 + x) * std::exp(-x)) / (x * x) : 1.0;
    std::vector<double> inside;
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (mesh.reflectance(p, 0) > 0.0f && mesh.is_back[p] != 0) {
        inside.push_back(double{solved.solution.patch_radiosity(p, band)});
      }
    }
    expect_mean(inside, 1.0 / (1.0 - double{rho} * T), 0.05, "inside of the ball");
  }
  expect_balance(solved.solution.energy);
}

// Rays aimed at the slits behind a sheet make the weights of a row's rays add up to 1 in the mean
// alone. Rows within water keep their light all the same.
TEST(AbsorbingSlit, IsBalanced) {
  const Bands bands = rgb_bands();
  const Material wall = test::diffuse(bands, 0.6f);
  Scene scene = pool(wall, wall, wall);
  const int shining = test::add_material(scene, test::diffuse(bands, 0.0f, 1.0f));
  test::add_polygon(scene, "lamp", shining,
                    {{0.01, 0.2, 0.1}, {0.01, 0.8, 0.1}, {0.01, 0.8, 0.4}, {0.01, 0.2, 0.4}});
  ASSERT_FALSE(find_openings(scene).empty());
  const SolvedScene solved = solve_scene(scene, slab_options(FormFactorMethod::automatic));
  expect_balance(solved.solution.energy);
}

// A lamp within water over the floor of a wide pool.
Scene pool_with_lamp() {
  const Bands bands = rgb_bands();
  Scene scene =
      pool(test::diffuse(bands, 0.0f), test::diffuse(bands, 0.0f), test::mirror(bands, 1.0f));
  Lamp lamp;
  lamp.name = "lamp";
  lamp.position = {0.25, 0.5, 0.4};
  lamp.intensity = constant_spectrum(bands, 1.0f);
  scene.lamps.push_back(lamp);
  return scene;
}

TEST(LampWithinWater, LightsAPointByItsDistance) {
  const Scene scene = pool_with_lamp();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  constexpr int floor_facet = 6;
  const Eigen::Vector3d at(0.1, 0.3, 0.0), to = scene.lamps[0].position - at;
  const Spectrum E = light.irradiance(
      caster, {.at = {.position = at, .normal = Eigen::Vector3d::UnitZ(), .facet = floor_facet}});
  for (int band = 0; band < 3; ++band) {
    const double r = to.norm();
    const double expected = to.z() / (r * r * r) * std::exp(-double{absorption[band]} * r);
    // Distance, kernel, exponential and light: a rounding or two of floats each, doubled; and the
    // lamp's clearance from the way.
    const double clearance = 1e-3;
    EXPECT_NEAR(E[band], expected,
                expected * (std::ldexp(16.0, -24) + double{absorption[band]} * clearance));
  }
}

// Light of a lamp that sends one unit per steradian, between mirrors: the floor gets 2 pi E_2(a h),
// where E_2(x) = int exp(-x / u) du over u in (0, 1).
TEST(LampWithinWater, SendsItsFluxThroughTheWater) {
  const Scene scene = pool_with_lamp();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const LightPaths paths(scene, caster, 8);
  constexpr int rays = 1 << 16;
  const FreeLight found = cast_free_light(scene, caster, paths, light, rays, {});
  const double h = scene.lamps[0].position.z();
  for (int band = 0; band < 3; ++band) {
    double E2 = 0.0, squares = 0.0;
    constexpr int parts = 100000;
    for (int i = 0; i < parts; ++i) {
      const double left = std::exp(-double{absorption[band]} * h * parts / (i + 0.5));
      E2 += left / parts;
      squares += left * left / parts;
    }
    double power = 0.0;
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (scene.surfaces[static_cast<std::size_t>(mesh.surface[p])].name == "z0") {
        power += mesh.area[p] * double{found.irradiance(p, band)};
      }
    }
    // Half of the rays go down, with the variance of what is left of each and of their number.
    const double mean = 0.5 * E2, variance = 0.5 * squares - mean * mean;
    const double all = 4.0 * std::numbers::pi;
    // Ways of rays to the lamp's clearance, 1 mm, and across the gap are not dimmed.
    const double undimmed = double{absorption[band]} * 2e-3 * 4.0;
    EXPECT_NEAR(power, all * mean, all * (4.0 * std::sqrt(variance / rays) + mean * undimmed));
    const double arriving = (found.irradiance.col(band).cast<double>() * mesh.area).sum();
    // A patch adds up some 1400 floats of rays, whose roundings of 2^-24 walk at random: sqrt(1400)
    // of them are 2e-6, and four times that are allowed for chance.
    EXPECT_NEAR((arriving + found.absorbed[band] + found.escaped[band]) / found.emitted[band], 1.0,
                4.0 * std::ldexp(std::sqrt(1400.0), -24));
  }
}

// A square lamp under water, by quadrature of cos cos / (pi r^2) exp(-a r).
TEST(EmitterWithinWater, LightsAPointByTheDistanceOfItsParts) {
  const Bands bands = rgb_bands();
  Scene scene =
      pool(test::diffuse(bands, 0.0f), test::diffuse(bands, 0.0f), test::diffuse(bands, 0.0f));
  const int shining = test::add_material(scene, test::diffuse(bands, 0.0f, 1.0f));
  constexpr double low = 0.1, side = 0.3, height = 0.3;
  test::add_polygon(scene, "lamp", shining,
                    {{low, low, height},
                     {low, low + side, height},
                     {low + side, low + side, height},
                     {low + side, low, height}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const Eigen::Vector3d at(0.2, 0.2, 0.0);
  constexpr int floor_facet = 6, rays = 4096;
  const Spectrum E = light.irradiance(
      caster, {.at = {.position = at, .normal = Eigen::Vector3d::UnitZ(), .facet = floor_facet},
               .shadows = {.min_rays = rays, .max_rays = rays}});
  for (int band = 0; band < 3; ++band) {
    double expected = 0.0, square = 0.0, whole = 0.0;
    constexpr int parts = 400;
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < parts; ++j) {
        const Eigen::Vector3d to(low + side * (i + 0.5) / parts - at.x(),
                                 low + side * (j + 0.5) / parts - at.y(), height);
        const double r = to.norm();
        const double F =
            height * height / (std::numbers::pi * std::pow(r, 4.0)) * side * side / (parts * parts);
        const double left = std::exp(-double{absorption[band]} * r);
        whole += F;
        expected += F * left;
        square += F * left * left;
      }
    }
    // Shadow rays are no worse than independent ones, of which a mean of exp(-a r) has this error.
    const double mean = expected / whole;
    const double deviation = std::sqrt(std::max(0.0, square / whole - mean * mean) / rays);
    // The midpoint rule is off by less than 1 / parts^2 of the sum, and floats by some roundings.
    const double exact = expected * (1.0 / (parts * parts) + std::ldexp(64.0, -24));
    EXPECT_NEAR(E[band], expected, 4.0 * deviation * whole + exact);
  }
}

}  // namespace
}  // namespace lightwell::absorbing_bodies_test
