// Light of surfaces that shine by a picture.
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/build_patches.h"
#include "mesh/patches/pictured_emission.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter_point.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solve.h"
#include "tests/pictures.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::emission_picture_test {
namespace {

using Eigen::Vector3d;

// 16-bit texels: a code is 65535 times the root of a share, rounded by 1/2 at most, so a share in
// [0,1] is off by root / 65535 at most. 0 and 1 are exact.
constexpr double texel_rounding = 1.0 / 65535.0;
// A value that a few floats make: each rounds by half of 2^-23.
constexpr double some_floats = 4 * 0x1p-24;
// EmissionTree leaves a rectangle whole that would move less than 0.6 % of the light.
constexpr double of_a_part = 6e-3;

const Eigen::Array3f red(1.0f, 0.0f, 0.0f), blue(0.0f, 0.0f, 1.0f);

// A square screen with u along x and v along y, and a far wall that keeps it a small part of the
// scene. The screen is surface 0 and faces +z.
Scene screen(const SurfaceTexture& picture, float factor = 1.0f) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "screen", black, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
  put_light(scene, 0, picture, factor);
  return scene;
}

struct Lit {
  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;

  explicit Lit(Scene of, double patch = 0.5)
      : scene(std::move(of)),
        mesh(build_patches(scene, {.max_patch_size = patch})),
        caster(mesh),
        light(scene, mesh) {}

  Spectrum irradiance(const Vector3d& at, const Vector3d& normal) const {
    return light.irradiance(caster, {.at = {at, normal, -1}, .key = 1});
  }
};

// F of an axis-parallel rectangle in the screen's plane.
double form_factor(const Vector3d& at, const Vector3d& normal, double x0, double x1, double y0,
                   double y1) {
  const Loop loop = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  return std::abs(point_to_polygon(at, normal, {&loop, 1}));
}

const std::vector<std::pair<Vector3d, Vector3d>>& receivers() {
  static const std::vector<std::pair<Vector3d, Vector3d>> at = {{{0.5, 0.5, 0.05}, {0, 0, -1}},
                                                                {{0.2, 0.7, 0.3}, {0, 0, -1}},
                                                                {{0.9, 0.1, 1.0}, {0, 0, -1}},
                                                                {{-0.5, 0.5, 0.4}, {1, 0, 0}},
                                                                {{0.3, 2.0, 3.0}, {0, -0.6, -0.8}}};
  return at;
}

// E = M F of either half.
TEST(EmissionPicture, OfTwoHalvesLightsAWallByTheirFormFactors) {
  constexpr float M = 3.0f;
  const Lit lit(screen(coloured_picture(2, 1, {red, blue}), M));
  ASSERT_EQ(lit.light.emitters().size(), 1u);
  for (const auto& [at, normal] : receivers()) {
    const Spectrum E = lit.irradiance(at, normal);
    const double left = M * form_factor(at, normal, 0.0, 0.5, 0.0, 1.0);
    const double right = M * form_factor(at, normal, 0.5, 1.0, 0.0, 1.0);
    const double tolerance = (of_a_part + texel_rounding) * (left + right);
    EXPECT_NEAR(E[0], left, tolerance);
    EXPECT_NEAR(E[2], right, tolerance);
    EXPECT_EQ(E[1], 0.0f);
  }
}

// A blocker that hides exactly the left half from a point: a share of the whole light would leave
// half of the red.
TEST(EmissionPicture, BehindABlockerIsTheLightOfTheVisiblePart) {
  constexpr float M = 3.0f;
  Scene scene = screen(coloured_picture(2, 1, {red, blue}), M);
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "blocker", black, {{-5, -5, 1}, {0.5, -5, 1}, {0.5, 5, 1}, {-5, 5, 1}});
  const Lit lit(std::move(scene));
  for (const double height : {2.0, 1.3}) {
    const Vector3d at(0.5, 0.4, height), normal(0, 0, -1);
    const Spectrum E = lit.irradiance(at, normal);
    const double right = M * form_factor(at, normal, 0.5, 1.0, 0.0, 1.0);
    // The halves send equal light, so a view that is not parted is off by a part of both.
    EXPECT_NEAR(E[2], right, 2.0 * (of_a_part + texel_rounding) * right);
    EXPECT_EQ(E[0], 0.0f);
  }
}

// Pictures with texels finer than a wall is far away, against the sum over all texels.
TEST(EmissionPicture, OfManyTexelsIsTheSumOfTheirFormFactors) {
  constexpr int across = 64;
  std::vector<Eigen::Array3f> texels;
  for (int i = 0; i < across * across; ++i) {
    const float x = static_cast<float>(i % across) / across,
                y = static_cast<float>(i / across) / across;
    const auto noise =
        static_cast<float>(random_uniform(random_key(static_cast<std::uint64_t>(i))));
    texels.emplace_back(x * noise, 0.5f + 0.5f * std::sin(9.0f * x * y), noise * noise);
  }
  const Lit lit(screen(coloured_picture(across, across, texels)));
  for (const auto& [at, normal] : receivers()) {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int i = 0; i < across * across; ++i) {
      const double x = static_cast<double>(i % across) / across,
                   y = static_cast<double>(i / across) / across;
      sum += form_factor(at, normal, x, x + 1.0 / across, y, y + 1.0 / across) *
             texels[static_cast<std::size_t>(i)].cast<double>();
    }
    const Eigen::Array3d off = (lit.irradiance(at, normal).cast<double>() - sum) / sum.sum();
    std::printf("at height %.2f: off by %.1e %.1e %.1e of the light\n", at.z(), off[0], off[1],
                off[2]);
    // The bound of a rectangle is that of a picture and a kernel that vary together. Here they do
    // not, and errors of either sign add up to less than one bound.
    EXPECT_LT(off.abs().maxCoeff(), of_a_part);
  }
}

// From 50 widths away, F varies over the screen by the square of half a diagonal over the distance.
TEST(EmissionPicture, FromAfarIsTheLightOfItsMean) {
  const std::vector<Eigen::Array3f> texels = {red, blue, Eigen::Array3f(0.3f, 0.8f, 0.1f), red};
  const Lit pictured(screen(coloured_picture(2, 2, texels)));
  const Vector3d at(0.5, 0.5, 50.0), normal(0, 0, -1);
  const double F = form_factor(at, normal, 0.0, 1.0, 0.0, 1.0);
  const Eigen::Array3f mean = 0.25f * (texels[0] + texels[1] + texels[2] + texels[3]);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(pictured.irradiance(at, normal)[k], mean[k] * F,
                (2.0 * 0.5 / 2500.0 + of_a_part) * mean.sum() * F);
  }
}

// Elements are an eighth wide, a texel each.
TEST(EmissionPicture, PatchesSendThePowerOfTheirTexels) {
  constexpr int across = 8;
  constexpr float M = 5.0f;
  std::vector<Eigen::Array3f> texels;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < across * across; ++i) {
    texels.emplace_back(0.01f * static_cast<float>(i), 0.5f, i % 3 == 0 ? 1.0f : 0.0f);
    sum += texels.back().cast<double>();
  }
  const Scene scene = screen(coloured_picture(across, across, texels), M);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 0.25, .elements_per_patch_edge = 2});
  const PicturedEmission emission(mesh);
  Eigen::Array3d power = Eigen::Array3d::Zero();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (mesh.surface[p] != 0) continue;
    ASSERT_TRUE(emission.shines(p));
    const Vector3d at = element_center(mesh, e).position;
    const int texel =
        across * static_cast<int>(across * at.y()) + static_cast<int>(across * at.x());
    const Spectrum wanted = M * texels[static_cast<std::size_t>(texel)];
    // A texel, times a factor of the facet that is 1 but for the texels' and the floats' rounding.
    constexpr double tolerance = 2.0 * (texel_rounding + some_floats) * M;
    EXPECT_LT((emission.of_element(e) - wanted).abs().maxCoeff(), tolerance);
    EXPECT_LT((emission_at(mesh, e, at) - wanted).abs().maxCoeff(), tolerance);
    power += mesh.element_area[e] * mesh.emission.row(p).transpose().cast<double>();
  }
  const Eigen::Array3d wanted = M * sum / (across * across);
  EXPECT_LT((power - wanted).abs().maxCoeff(), (texel_rounding + some_floats) * M);
}

// Texels are finer than the points of an element, and no edge of an element is an edge of a texel.
TEST(EmissionPicture, PatchesOfAnySizeSendTheIntegral) {
  constexpr int across = 100;
  std::vector<Eigen::Array3f> texels;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < across * across; ++i) {
    const auto noise =
        static_cast<float>(random_uniform(random_key(static_cast<std::uint64_t>(i))));
    texels.emplace_back(noise < 0.1f ? 1.0f : 0.0f, noise, i % across < across / 2 ? 0.0f : noise);
    sum += texels.back().cast<double>();
  }
  const Scene scene = screen(coloured_picture(across, across, texels));
  for (const double size : {1.0, 0.3, 0.07}) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    Eigen::Array3d power = Eigen::Array3d::Zero();
    for (int p = 0; p < mesh.patch_count(); ++p) {
      power += mesh.area[p] * mesh.emission.row(p).transpose().cast<double>();
    }
    // Cells of the picture are a texel each.
    EXPECT_LT((power - sum / (across * across)).abs().maxCoeff(), texel_rounding + some_floats)
        << size;
  }
}

// Two by two texels over four periods are four by four texels over one.
TEST(EmissionPicture, LightDependsOnTheRadianceAndNotOnItsTiles) {
  const std::array<Eigen::Array3f, 4> tile = {red, blue, Eigen::Array3f(0.2f, 0.9f, 0.4f), blue};
  std::vector<Eigen::Array3f> all;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) all.push_back(tile[static_cast<std::size_t>(2 * (y % 2) + x % 2)]);
  }
  Scene tiled = screen(coloured_picture(2, 2, {tile.begin(), tile.end()}));
  UvMap& uv = std::get<PolygonMesh>(tiled.surfaces[0].shape).uv_maps[0];
  uv.gradient *= 2.0;
  uv.offset = Eigen::Vector2d(2.0, -4.0);  // whole periods
  const Scene whole = screen(coloured_picture(4, 4, all));
  EXPECT_NE(scene_hash(tiled), scene_hash(whole));
  const Lit one(std::move(tiled)), other(whole);
  for (const auto& [at, normal] : receivers()) {
    const Spectrum E = one.irradiance(at, normal), wanted = other.irradiance(at, normal);
    // The cells and the closed forms are the same; floats round each band, and double precision
    // the corners of cells.
    EXPECT_LT((E - wanted).abs().maxCoeff(), some_floats * wanted.sum());
  }
}

// A polygon that is not convex and whose coordinates are turned against its edges.
TEST(EmissionPicture, OfATurnedLayoutOnAnLKeepsItsPower) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "L", black,
                    {{0, 0, 0}, {1, 0, 0}, {1, 0.4, 0}, {0.3, 0.4, 0}, {0.3, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
  SurfaceTexture even = coloured_picture(3, 2, std::vector<Eigen::Array3f>(6, {0.5f, 0.25f, 1.0f}));
  put_light(scene, 0, even);
  auto& uv = std::get<PolygonMesh>(scene.surfaces[0].shape).uv_maps[0];
  uv.gradient << 2.0, 1.1, 0.0, -0.7, 1.9, 0.0;
  const Lit lit(std::move(scene));
  const EmissionTree& tree = *lit.light.emitters().at(0).picture;
  EXPECT_EQ(tree.leaf_count(), 1);  // an even picture is not parted
  const Vector3d at(0.4, 0.5, 0.2), normal(0, 0, -1);
  const double F = form_factor(at, normal, 0, 1, 0, 0.4) + form_factor(at, normal, 0, 0.3, 0.4, 1);
  // Texels of 1 are exact; the code of 0.25 is rounded.
  EXPECT_NEAR(lit.irradiance(at, normal)[2], F, some_floats * F);
  EXPECT_NEAR(lit.irradiance(at, normal)[1], 0.25 * F, (texel_rounding + some_floats) * F);
}

// A channel at twice the light, in one band alone, scales the picture.
TEST(EmissionPicture, IsScaledWithTheEmissionOfItsPatches) {
  Lit lit(screen(coloured_picture(2, 1, {red, blue})));
  const Vector3d at(0.2, 0.7, 0.3), normal(0, 0, -1);
  const Spectrum before = lit.irradiance(at, normal);
  lit.mesh.emission.col(0) *= 2.0f;
  lit.mesh.emission.col(2) *= 0.5f;
  const DirectLight relit(lit.scene, lit.mesh, {}, &lit.light);
  const Spectrum after = relit.irradiance(lit.caster, {.at = {at, normal, -1}, .key = 1});
  // The factor of the facet is a quotient of floats, the light its product.
  EXPECT_NEAR(after[0], 2.0f * before[0], some_floats * 2.0f * before[0]);
  EXPECT_NEAR(after[2], 0.5f * before[2], some_floats * 0.5f * before[2]);
  const Emitter& emitter = relit.emitters()[0];
  EXPECT_NEAR(exitance_at(emitter, {0.25, 0.5, 0.0})[0], 2.0f, some_floats * 2.0f);
}

// A wall close to the screen reflects in its patches the light of the half that each is near.
TEST(EmissionPicture, PatchesReflectTheColourOfThePartThatTheySee) {
  constexpr float rho = 0.5f;
  Scene scene = screen(coloured_picture(2, 1, {red, blue}));
  const int grey = test::add_material(scene, test::diffuse(scene.bands, rho));
  constexpr double distance = 0.3, patch = 0.0625;
  test::add_polygon(scene, "wall", grey,
                    {{0, 0, distance}, {0, 1, distance}, {1, 1, distance}, {1, 0, distance}});
  SolveOptions options;
  options.mesh.max_patch_size = patch;
  options.form_factors.rays_per_patch = 256;
  options.gather.rays = 64;
  options.error_points = 16;
  const SolvedScene solved = solve_scene(scene, options);
  const PatchMesh& mesh = solved.mesh;
  int walls = 0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.surface[p] != 2) continue;
    ++walls;
    Eigen::Array3d E = Eigen::Array3d::Zero();
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const PatchPoint at = element_center(mesh, e);
      const double share = mesh.element_area[e] / mesh.area[p];
      E[0] += share * form_factor(at.position, at.normal, 0.0, 0.5, 0.0, 1.0);
      E[2] += share * form_factor(at.position, at.normal, 0.5, 1.0, 0.0, 1.0);
    }
    const Spectrum B = solved.solution.patch_radiosity.row(p).transpose();
    // The screen and the far wall are black, so light is reflected once. The midpoint rule over a
    // patch of the size h of the screen is off by h^2 / 24 times the kernel's second derivatives:
    // d^2 / (d^2 + x^2)^2 has 4 / d^2 of itself at most, in x and in y. A patch of the wall is
    // summed over finer points, with less than a quarter of that.
    constexpr double h_over_d = patch / distance;
    constexpr double tolerance = 1.25 * 2.0 * 4.0 / 24.0 * h_over_d * h_over_d;
    EXPECT_NEAR(B[0], rho * E[0], tolerance * rho * E.sum());
    EXPECT_NEAR(B[2], rho * E[2], tolerance * rho * E.sum());
  }
  EXPECT_GT(walls, 8);
  const EnergyBalance balance = solved.solution.energy;
  // Half a square metre of red and of blue, in texels of 1, which are exact.
  EXPECT_NEAR(balance.emitted, 1.0, some_floats);
  EXPECT_NEAR((balance.absorbed + balance.escaped) / balance.emitted, 1.0, some_floats);
}

}  // namespace
}  // namespace lightwell::emission_picture_test
