#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/patch_light.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::gather_shares_test {
namespace {

// A room without light whose first wall is a tinted mirror, with a plate 5 mm above the floor.
Scene dark_room() {
  Scene scene = test::room_with_mirror(0.7f);
  for (Material& material : scene.materials) {
    material.emission.setZero();
    if (material.specular.size() > 1 && material.specular[1] > 0.0f) material.specular[1] = 0.3f;
  }
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.4f));
  test::add_box(scene, {0.3, 0.3, 0.005}, {0.7, 0.7, 0.03}, {grey, grey, grey, grey, grey, grey},
                false);
  return scene;
}

}  // namespace

// Shares of vertices, times their radiosities, are what a gather with these radiosities finds: on a
// wall, in free space, and in the gap under the plate, whose rays go on. Radiosities differ by a
// factor of two, so that no patch is bright. Sums of 256 rays in other orders: 256 x 6e-8.
TEST(GatherShares, TimesRadiosityAreTheGather) {
  const Scene scene = dark_room();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const LitScene lit{scene, caster, direct_light};
  constexpr Eigen::Index bands = 3;
  BandArray B(mesh.vertex_count(), bands);
  for (Eigen::Index v = 0; v < B.rows(); ++v) {
    for (Eigen::Index k = 0; k < bands; ++k) {
      B(v, k) = 1.0f + static_cast<float>((v * 5 + k * 3) % 11) / 11.0f;
    }
  }
  std::vector<GatherPoint> points = {{.position = {0.5, 0.5, 0.8}, .normal = {0, 0, 1}}};
  for (const GatherPoint& at : vertex_gather_points(mesh)) points.push_back(at);
  const GatherOptions options{.rays = 256};
  const BandArray shares = gather_shares(lit, points, options),
                  gathered = gather_indirect(lit, B, points, options).indirect;
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    for (Eigen::Index k = 0; k < bands; ++k) {
      double sum = 0.0;
      for (Eigen::Index v = 0; v < B.rows(); ++v) {
        sum += double{shares(i, v * bands + k)} * double{B(v, k)};
      }
      ASSERT_NEAR(sum, double{gathered(i, k)}, 2e-5) << "point " << i << ", band " << k;
    }
  }
}

TEST(GatherShares, OfPatchesAreThoseOfTheirVertices) {
  const PatchMesh mesh = build_patches(dark_room(), {.max_patch_size = 0.5});
  BandArray B(mesh.patch_count(), 1), of_vertices(mesh.vertex_count(), 1);
  for (Eigen::Index p = 0; p < B.rows(); ++p) B(p, 0) = static_cast<float>(1 + p % 5);
  for (Eigen::Index v = 0; v < of_vertices.rows(); ++v) {
    of_vertices(v, 0) = static_cast<float>(1 + v % 7);
  }
  const double by_vertices = (of_vertices * to_vertices(mesh, B)).cast<double>().sum(),
               by_patches = (shares_of_patches(mesh, of_vertices) * B).cast<double>().sum();
  EXPECT_NEAR(by_patches, by_vertices, 1e-5 * by_vertices) << "sums of some hundred floats";
}

TEST(GatherShares, OfASceneWithLightsAreRefused) {
  Scene scene = dark_room();
  scene.lamps.push_back({.name = "lamp",
                         .position = {0.5, 0.5, 0.5},
                         .intensity = constant_spectrum(scene.bands, 1)});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const std::vector<GatherPoint> points(1);
  EXPECT_THROW(gather_shares({scene, caster, direct_light}, points, {.rays = 16}),
               std::invalid_argument);
}

}  // namespace lightwell::gather_shares_test
