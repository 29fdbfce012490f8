#include "radiosity/patch_light.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::patch_light_test {
namespace {

// Two sheets of 40 x 40 patches with light on both sides, a metre apart: neighbourhoods of 800.
struct Sheets {
  static Scene sheets() {
    Scene scene;
    Material grey = test::diffuse(scene.bands, 0.5f);
    grey.one_sided = false;
    const int both_sides = test::add_material(scene, grey);
    test::add_polygon(scene, "low", both_sides, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    test::add_polygon(scene, "high", both_sides, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    return scene;
  }

  // Light at a vertex of a patch as interpolation finds it, where 1 is right.
  double found(int patch) const {
    return mesh.surface[patch] == 0 && mesh.is_back[patch] == 0 ? 0.9 : 1.0;
  }

  Scene scene = sheets();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.025});
  DirectLight direct_light{scene, mesh};
};

// A factor and the light are off by a rounding each; the factor at a vertex is a mean of up to four
// patches, with a rounding for each sum and for the product. Twice that is allowed.
constexpr float rounding = 2.0f * 8.0f * 0x1p-24f;

TEST(KeepPower, RestoresWhatIsLostWhereItIsLost) {
  const Sheets sheets;
  const PatchMesh& mesh = sheets.mesh;
  ASSERT_EQ(mesh.patch_count(), 6400);
  const std::vector<int> patch = vertex_patches(mesh);
  const Eigen::Index bands = sheets.scene.bands.count();
  BandArray radiosity(mesh.vertex_count(), bands);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    radiosity.row(v).setConstant(static_cast<float>(sheets.found(patch[v])));
  }
  const BandArray right = BandArray::Ones(mesh.patch_count(), bands);
  keep_power(mesh, sheets.direct_light, right, radiosity);
  EXPECT_LT((radiosity - 1.0f).abs().maxCoeff(), rounding);
}

// The light of one channel may be lost between vertices where that of another is not.
TEST(KeepPower, RestoresEachChannelByItself) {
  const Sheets sheets;
  const PatchMesh& mesh = sheets.mesh;
  const Eigen::Index bands = sheets.scene.bands.count();
  const std::vector<int> patch = vertex_patches(mesh);
  EmitterChannels channels{.names = {"sun", "lamp"}};
  channels.of_surface.assign(sheets.scene.surfaces.size(), -1);
  const DirectLight direct_light(sheets.scene, mesh, channels);
  BandArray radiosity = BandArray::Ones(mesh.vertex_count(), 2 * bands);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    radiosity.row(v).head(bands).setConstant(static_cast<float>(sheets.found(patch[v])));
  }
  keep_power(mesh, direct_light, BandArray::Ones(mesh.patch_count(), 2 * bands), radiosity);
  EXPECT_LT((radiosity - 1.0f).abs().maxCoeff(), rounding);
}

// A patch that errs alone, among 800, moves all of them by an 800th of its error.
TEST(KeepPower, TrustsNoPatchAlone) {
  const Sheets sheets;
  const PatchMesh& mesh = sheets.mesh;
  const Eigen::Index bands = sheets.scene.bands.count();
  BandArray radiosity = BandArray::Ones(mesh.vertex_count(), bands);
  BandArray balanced = BandArray::Ones(mesh.patch_count(), bands);
  constexpr float error = 0.2f;
  balanced.row(0) += error;
  keep_power(mesh, sheets.direct_light, balanced, radiosity);
  EXPECT_NEAR(radiosity.maxCoeff(), 1.0f + error / 800.0f, 1e-5f);
  EXPECT_NEAR(radiosity.minCoeff(), 1.0f, 1e-5f);
}

constexpr double rho = 0.5;
// Tolerance of refinement: the pool's half of the flux, lost or counted twice, is 25 times that.
constexpr double tolerance = 0.02;

// Mean irradiance of a closed cube of 1 m, reflectance rho, with a lamp of 4 pi W under its
// ceiling, interpolated between vertices.
double mean_irradiance(double below_ceiling, double x, double y) {
  Scene scene;
  std::array<int, 6> grey;
  grey.fill(test::add_material(scene, test::diffuse(scene.bands, static_cast<float>(rho))));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, grey, true);
  scene.lamps.push_back({.name = "bulb",
                         .position = {x, y, 1.0 - below_ceiling},
                         .axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
                         .intensity = constant_spectrum(scene.bands, 1.0f)});
  SolveOptions options;
  options.mesh.max_patch_size = 0.25;
  options.refine.tolerance = tolerance;
  options.gather.rays = 256;
  const SolvedScene solved = solve_scene(scene, options);
  const BandArray E = solved.solution.irradiance();
  double area = 0.0;
  for (int p = 0; p < solved.mesh.patch_count(); ++p) area += solved.mesh.area[p];
  return patch_integral(solved.mesh, E).col(0).sum() / area;
}

// In a closed room of one reflectance all light is absorbed: A (1 - rho) E = flux, wherever the
// light falls. The lamp's pool on the ceiling is at least twice narrower than an element; 1e-7 m
// are within the rounding of rays. The mean of an error is no more than its root mean square, the
// tolerance of refinement, and the share rho of the light carries the error on.
TEST(SpreadPools, KeepsTheFluxOfLampsThatTouchSurfaces) {
  constexpr double E = 4.0 * std::numbers::pi / (6.0 * (1.0 - rho));
  for (const double below : {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    for (const double off : {0.0, 0.07}) {
      SCOPED_TRACE(testing::Message() << below << " m under the ceiling, " << off);
      EXPECT_NEAR(mean_irradiance(below, 0.5 + off, 0.5 + off), E, (1.0 + rho) * tolerance * E);
    }
  }
}

}  // namespace
}  // namespace lightwell::patch_light_test
