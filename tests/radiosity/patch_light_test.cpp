#include "radiosity/patch_light.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
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
  // Rounding of factors and light in single precision.
  EXPECT_LT((radiosity - 1.0f).abs().maxCoeff(), 1e-5f);
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

}  // namespace
}  // namespace lightwell::patch_light_test
