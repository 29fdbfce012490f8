#include "radiosity/direct_light/cluster_members.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/direct_light/direct_light.h"
#include "tests/radiosity/lit_places.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/sample_mean.h"

namespace lightwell::cluster_members_test {
namespace {

using Eigen::Vector3d;

constexpr double chance = 0.25;

/// A luminous square, a luminous ball and a lamp with an opening, all above a point and near to it.
struct NearLights {
  Scene scene;
  PatchMesh mesh;

  NearLights() {
    const int bright = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 1.0f));
    test::add_polygon(scene, "square", bright, test::lamp_loop({0.3, 0.1, 0.5}, 0.2));
    scene.surfaces.push_back({.name = "ball",
                              .material = bright,
                              .shape = Sphere{.center = {-0.4, 0.2, 0.6}, .radius = 0.3}});
    scene.lamps.push_back({.name = "lamp",
                           .position = {0.1, -0.3, 0.4},
                           .intensity = constant_spectrum(scene.bands, 1.0f),
                           .opening = {.along_c0 = 0.3, .along_c90 = 0.2}});
    // Emitters of more than a quarter of all area would be left to hemispheres of rays.
    test::add_polygon(scene, "far", test::add_black(scene),
                      {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
    mesh = build_patches(scene, {.max_patch_size = 4.0});
  }
};

// Without occluders the mean over keys is the closed form over the chance.
TEST(ClusterMembers, GiveTheClosedFormInTheMean) {
  const NearLights near;
  const ElementCaster caster(near.mesh);
  const DirectLight direct(near.scene, near.mesh);
  const LightList lights{.emitters = direct.emitters(), .sources = direct.free_sources()};
  ASSERT_EQ(lights.count(), 3);
  const SurfacePoint at{
      .position = {0, 0, 0}, .normal = Vector3d(0.1, 0, 1).normalized(), .facet = -1};
  for (int light = 0; light < 3; ++light) {
    const LightSample drawn{.light = light, .chance = chance, .cluster = 0};
    std::vector<double> found;
    for (std::uint64_t key = 0; key < 4096; ++key) {
      const std::vector<MemberLight> members =
          member_lights({&drawn, 1}, lights, caster, at, key, {});
      ASSERT_EQ(members.size(), 1U);
      EXPECT_EQ(members[0].blocked, 0);
      found.push_back(members[0].F);
    }
    const double exact = lights.is_emitter(light)
                             ? direct.unoccluded_form_factor(lights.emitters[light], at)
                             : unoccluded_kernel(lights.source(light), at.position, at.normal);
    const test::SampleMean mean = test::mean_of(found);
    // Four standard errors; the sampled kernel of an opening is exact in the mean, its closed form
    // to 1e-4.
    EXPECT_NEAR(mean.value, exact / chance, 4.0 * mean.standard_error + 1e-4 * exact / chance)
        << light;
    // 4096 samples of kernels that differ by no more than their mean have a standard error of a
    // 64th at most, and most of these differ by less than half: a wrong factor of 4 % is seen.
    EXPECT_LT(4.0 * mean.standard_error, 0.04 * exact / chance) << light;
  }
}

TEST(ClusterMembers, AreThoseThatSendLightToThePoint) {
  const NearLights near;
  const ElementCaster caster(near.mesh);
  const DirectLight direct(near.scene, near.mesh);
  const LightList lights{.emitters = direct.emitters(), .sources = direct.free_sources()};
  const std::vector<LightSample> all{{.light = 0, .cluster = 0}, {.light = 1, .cluster = 0}};
  const auto count = [&](const SurfacePoint& at) {
    return member_lights(all, lights, caster, at, 1, {}).size();
  };
  EXPECT_EQ(count({.position = {0, 0, 0}, .normal = Vector3d::UnitZ(), .facet = -1}), 2U);
  // Below the horizon of the point.
  EXPECT_EQ(count({.position = {0, 0, 0}, .normal = -Vector3d::UnitZ(), .facet = -1}), 0U);
  // Behind the square, which shines down, and inside the ball.
  EXPECT_EQ(count({.position = {-0.4, 0.2, 0.6}, .normal = Vector3d::UnitZ(), .facet = -1}), 0U);
}

TEST(ClusterMembers, AreDrawnOnesAlone) {
  const NearLights near;
  const DirectLight direct(near.scene, near.mesh);
  const LightList lights{.emitters = direct.emitters(), .sources = direct.free_sources()};
  EXPECT_FALSE(is_member({.light = 0}, lights));
  EXPECT_TRUE(is_member({.light = 0, .cluster = 3}, lights));
}

}  // namespace
}  // namespace lightwell::cluster_members_test
