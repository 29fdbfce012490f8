// Rays at moving surfaces give the hits of a mesh that was made at their place.
#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "scene/place_at_rest.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::moving_caster_test {
namespace {

using Eigen::Vector3d;

Scene scene_with_motions() {
  Scene scene = test::empty_scene();
  test::add_box(scene, "room", {-3, -3, -3}, {3, 3, 3});
  test::add_box(scene, "block", {-1, -1, -1}, {0, 0.5, 0.2});
  test::add_box(scene, "bar", {0.2, -2, 0.4}, {0.6, 2, 0.6});
  test::add_sphere(scene, "ball", {.center = {1.2, 0.4, -0.8}, .radius = 0.6});
  scene.motions = {
      {.pivot = {0.3, 0, 0},
       .axis = Vector3d(1, 2, 2) / 3.0,
       .keys = {{.time = 0.0}, {.time = 1.0, .degrees = 200.0, .translation = {0.3, -0.4, 0.5}}}},
      {.keys = {{.time = 0.0}, {.time = 2.0, .translation = {-1, 1, 0.5}}}}};
  scene.surfaces[1].motion = 0;
  scene.surfaces[2].motion = 1;
  scene.surfaces[3].motion = 0;
  return scene;
}

TEST(MovingCaster, MeetsWhatACasterOfTheMovedMeshDoes) {
  Scene rest = scene_with_motions();
  place_at_rest(rest, 0.25);
  const PatchMesh mesh = build_patches(rest, {.max_patch_size = 0.7});
  const ElementCaster moving(mesh, rest);
  test::Numbers numbers(7);
  for (const double time : {0.0, 0.25, 0.6, 1.0}) {
    Scene moved = scene_with_motions();
    place_at_rest(moved, time);
    const PatchMesh moved_mesh = build_patches(moved, {.max_patch_size = 0.7});
    const ElementCaster expected(moved_mesh), found = moving.at(time);
    std::vector<Ray> rays;
    for (int i = 0; i < 3000; ++i) {
      const auto in_room = [&] {
        return Vector3d(numbers.between(-2.9, 2.9), numbers.between(-2.9, 2.9),
                        numbers.between(-2.9, 2.9));
      };
      const Vector3d from = in_room();
      rays.push_back({.origin = from, .direction = in_room() - from});
    }
    std::vector<ElementHit> want(rays.size()), got(rays.size());
    expected.closest_hits(rays, want);
    found.closest_hits(rays, got);
    int same = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      same += got[i].facet == want[i].facet && std::abs(got[i].t - want[i].t) < 1e-4 &&
              got[i].from_back == want[i].from_back;
      if (i % 7 == 0) rays[i].target_group = want[i].facet;  // the target does not block itself
      rays[i].t_max = i % 2 == 0 ? 1.0 : 0.3;
    }
    EXPECT_GE(same, 2990) << "but where a ray grazes an edge";
    std::vector<std::uint8_t> want_blocked(rays.size()), got_blocked(rays.size());
    expected.occluded(rays, want_blocked);
    found.occluded(rays, got_blocked);
    int differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differ += want_blocked[i] != got_blocked[i];
    EXPECT_LE(differ, 6);
  }
}

TEST(MovingCaster, RaysLeaveTheFacetTheyStartOn) {
  Scene scene = scene_with_motions();
  place_at_rest(scene, 0.25);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.7});
  const ElementCaster caster = ElementCaster(mesh, scene).at(0.9);
  test::Numbers numbers(3);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d d(numbers.between(-1, 1), numbers.between(-1, 1), numbers.between(-1, 1));
    Ray ray{.origin = {0, 0, 2.9}, .direction = d};
    ElementHit first, next;
    caster.closest_hits({&ray, 1}, {&first, 1});
    ASSERT_GE(first.facet, 0);
    ray.origin += first.t * ray.direction;
    ray.origin_group = first.facet;
    caster.closest_hits({&ray, 1}, {&next, 1});
    const bool is_ball = scene_facets(scene)[static_cast<std::size_t>(first.facet)].surface == 3;
    if (!is_ball) {
      EXPECT_NE(next.facet, first.facet);
    }
  }
}

TEST(MovingCaster, KnowsWhereWhatMovesIs) {
  Scene scene = scene_with_motions();
  place_at_rest(scene, 0.25);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.7});
  const ElementCaster caster = ElementCaster(mesh, scene).at(1.0);
  EXPECT_EQ(ElementCaster(mesh).pose_of(8), nullptr);
  EXPECT_EQ(caster.pose_of(0), nullptr) << "a wall";
  ASSERT_NE(caster.pose_of(8), nullptr);
  EXPECT_TRUE(caster.pose_of(8)->isApprox(scene.motions[0].at(1.0)));
}

}  // namespace
}  // namespace lightwell::moving_caster_test
