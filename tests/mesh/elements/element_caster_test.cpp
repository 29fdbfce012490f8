#include "mesh/elements/element_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
#include "scene/sampling.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::element_caster_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

Vector3d random_direction(std::uint64_t key) {
  const double z = 2 * random_uniform(random_key(key, 1)) - 1;
  const double phi = 2 * std::numbers::pi * random_uniform(random_key(key, 2));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

BandArray positions_as_values(const PatchMesh& mesh) {
  BandArray values(mesh.vertex_count(), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    values.row(v) = mesh.position(v).cast<float>().transpose().array();
  }
  return values;
}

Scene cornell_with_oblique_facets() {
  Scene scene = cornell_box();
  Loop kite{{0.1, 0, 0.1}, {0.25, 0, 0.15}, {0.3, 0, 0.3}, {0.1, 0, 0.2}};
  for (Vector3d& p : kite) p.y() = 0.3 + 0.1 * p.x() + 0.2 * p.z();
  add_polygon(scene, "kite", kite);
  return scene;
}

TEST(ElementCaster, LinearFunctionIsReproducedWhereARayHits) {
  const Scene scene = cornell_with_oblique_facets();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.07});
  const ElementCaster caster(mesh);
  const BandArray values = positions_as_values(mesh);
  std::vector<Ray> rays(20000);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].origin = {0.05 + 0.4 * random_uniform(random_key(i, 5)), 0.45, 0.1};
    rays[i].direction = random_direction(i);
  }
  std::vector<ElementHit> hits(rays.size());
  caster.closest_hits(rays, hits);
  int count = 0, from_back = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ElementHit& hit = hits[i];
    if (hit.facet < 0) continue;  // the box is open at the front
    ASSERT_GE(hit.element, 0);
    EXPECT_NEAR(hit.weights.sum(), 1.0f, 1e-5f);
    EXPECT_GE(hit.weights.minCoeff(), -1e-5f);
    const PatchPoint center = element_center(mesh, hit.element);
    EXPECT_LT(center.normal.dot(rays[i].direction), 0.0) << "the element must face the ray";
    const Vector3d x = rays[i].origin + hit.t * rays[i].direction;
    const Spectrum value = interpolate(mesh, values, hit);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(value[c], x[c], 1e-5);  // float hits in a 0.5 m box
    ++count;
    from_back += hit.from_back ? 1 : 0;
  }
  EXPECT_GT(count, 10000);
  EXPECT_GT(from_back, 0);
}

TEST(ElementCaster, EveryElementIsFoundFromItsOwnSide) {
  Scene scene = cornell_with_oblique_facets();
  add_sphere(scene, "ball", {.center = {0.3, 0.48, 0.1}, .radius = 0.03});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.05});
  const ElementCaster caster(mesh);
  std::vector<Ray> rays;
  constexpr double away = 1e-3;  // nothing in the scene is that close to anything else
  for (int e = 0; e < mesh.element_count(); ++e) {
    const PatchPoint center = element_center(mesh, e);
    rays.push_back({.origin = center.position + away * center.normal, .direction = -center.normal});
  }
  std::vector<ElementHit> hits(rays.size());
  caster.closest_hits(rays, hits);
  for (int e = 0; e < mesh.element_count(); ++e) {
    ASSERT_EQ(hits[e].element, e);
    EXPECT_EQ(hits[e].facet, mesh.facet[e]);
    EXPECT_EQ(hits[e].from_back, mesh.is_back[mesh.patch[e]] != 0);
    EXPECT_NEAR(hits[e].t, away, 1e-6);
    const int n = mesh.corner_count(e);
    if (!mesh.round_grids.empty() && mesh.facet[e] == mesh.round_grids[0].facet) {
      continue;
    }
    // At the mean of the corners, all weights are equal in a parallelogram or triangle; in any
    // element the weighted mean of the corners is the centre.
    Vector3d x = Vector3d::Zero();
    for (int i = 0; i < n; ++i) x += double(hits[e].weights[i]) * mesh.position(mesh.corners[e][i]);
    EXPECT_NEAR((x - element_center(mesh, e).position).norm(), 0.0, 1e-6);
  }
}

// point_on_element() ignores what lies in front and casts no ray.
TEST(ElementCaster, PlaceOnAnElementIsWhereARayMeetsIt) {
  Scene scene = cornell_with_oblique_facets();
  add_sphere(scene, "ball", {.center = {0.3, 0.48, 0.1}, .radius = 0.03});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.05});
  const ElementCaster caster(mesh);
  const BandArray values = positions_as_values(mesh);
  constexpr double away = 1e-3;  // nothing in the scene is that close to anything else
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const PatchSampler sampler(mesh, p);
    for (std::uint64_t i = 0; i < 4; ++i) {
      const PatchPoint point = sampler.point(random_uniform(random_key(p, 2 * i)),
                                             random_uniform(random_key(p, 2 * i + 1)));
      const Ray ray{.origin = point.position + away * point.normal, .direction = -point.normal};
      ElementHit met;
      caster.closest_hits({&ray, 1}, {&met, 1});
      const ElementHit place = point_on_element(mesh, point);
      ASSERT_EQ(place.element, met.element);
      EXPECT_EQ(place.facet, met.facet);
      EXPECT_EQ(place.from_back, met.from_back);
      const Spectrum value = interpolate(mesh, values, place);
      // A hit is known to 6e-8 (float) of 0.5 m; the weights and their sum add as much again.
      EXPECT_LT((value - interpolate(mesh, values, met)).abs().maxCoeff(), 1.5e-7f);
      EXPECT_NEAR(place.weights.sum(), 1.0f, 1.2e-7f);  // four roundings of up to 3e-8
    }
  }
}

TEST(ElementCaster, BackOfAOneSidedSurfaceIsBlackButBlocks) {
  Scene scene = empty_scene();
  add_polygon(scene, "plate", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, 1);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const Ray up{.origin = {0.4, 0.3, -1}, .direction = {0, 0, 1}};
  ElementHit hit;
  caster.closest_hits({&up, 1}, {&hit, 1});
  EXPECT_EQ(hit.facet, 0);
  EXPECT_EQ(hit.element, -1);
  EXPECT_TRUE(hit.from_back);
  EXPECT_NEAR(hit.t, 1.0, 1e-6);
  EXPECT_EQ(interpolate(mesh, positions_as_values(mesh), hit).maxCoeff(), 0.0f);
  std::uint8_t blocked = 0;
  caster.occluded({&up, 1}, {&blocked, 1});
  EXPECT_EQ(blocked, 1);
  Ray towards = up;
  towards.target_group = 0;
  caster.occluded({&towards, 1}, {&blocked, 1});
  EXPECT_EQ(blocked, 0);
}

TEST(ElementCaster, RayLeavesItsOwnFacetAndMissesOpenSpace) {
  Scene scene = empty_scene();
  add_polygon(scene, "plate", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const Ray ray{.origin = {0.4, 0.3, 0}, .direction = {0, 1e-3, -1}, .origin_group = 0};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  EXPECT_EQ(hit.facet, -1);
  EXPECT_EQ(hit.element, -1);
}

TEST(ElementCaster, SphereIsMetExactlyFromOutsideAndInside) {
  Scene scene = empty_scene();
  const Sphere ball{.center = {0.2, -0.3, 0.5}, .radius = 0.8};
  add_sphere(scene, "ball", ball);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const BandArray values = positions_as_values(mesh);
  const double cell = std::numbers::pi * ball.radius / mesh.round_grids.front().rings;
  for (int i = 0; i < 4000; ++i) {
    const bool inside = i % 2 == 1;
    const Vector3d d = random_direction(static_cast<std::uint64_t>(i));
    const Ray ray = inside ? Ray{.origin = ball.center, .direction = d}
                           : Ray{.origin = ball.center + 3 * d, .direction = -d};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    ASSERT_EQ(hit.facet, 0);
    ASSERT_EQ(hit.from_back, inside);
    ASSERT_EQ(mesh.is_back[mesh.patch[hit.element]] != 0, inside);
    const Vector3d x = ray.origin + hit.t * ray.direction;
    EXPECT_NEAR((x - ball.center).norm(), ball.radius, 1e-12);
    EXPECT_NEAR(hit.weights.sum(), 1.0f, 1e-5f);
    // Interpolating chords of cells of angle a leaves the sphere by at most r (a^2/8 + a^2/8).
    const Spectrum value = interpolate(mesh, values, hit);
    const Vector3d y(value[0], value[1], value[2]);
    EXPECT_LT((x - y).norm(), cell * cell / ball.radius / 4 * 1.1 + 1e-6);
  }
}

}  // namespace
}  // namespace lightwell::element_caster_test
