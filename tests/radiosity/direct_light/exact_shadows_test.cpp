#include "radiosity/direct_light/exact_shadows.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/emitter.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::exact_shadows_test {
namespace {

using Eigen::Vector3d;

constexpr int plenty = 24;  // pieces in the way

struct Lit {
  explicit Lit(Scene given) : scene(std::move(given)) {}

  Scene scene;
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 1});
  ElementCaster caster{mesh};
  DirectLight light{scene, mesh};
  ExactShadows shadows{scene, mesh, light.emitters()};

  std::optional<double> share(const Vector3d& point, const Vector3d& normal, int facet = -1,
                              int most = plenty) const {
    return shadows.share(0, {point, normal, facet}, most);
  }

  // The share of the kernel cos cos / r^2, by rays to a grid of points; the lamp is a rectangle.
  double share_of_rays(const Vector3d& point, const Vector3d& normal, int side) const {
    const Emitter& lamp = light.emitters()[0];
    const Vector3d corner = lamp.loops[0][0], u = lamp.loops[0][1] - corner,
                   v = lamp.loops[0][3] - corner;
    double all = 0.0, seen = 0.0;
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const Vector3d to = corner + (i + 0.5) / side * u + (j + 0.5) / side * v - point;
        const double kernel = std::max(0.0, to.dot(normal)) * std::abs(to.dot(lamp.normal)) /
                              std::pow(to.squaredNorm(), 2);
        const Ray ray{.origin = point, .direction = to, .t_max = 1.0, .target_group = lamp.facet};
        std::uint8_t blocked = 0;
        caster.occluded({&ray, 1}, {&blocked, 1});
        all += kernel;
        seen += blocked != 0 ? 0.0 : kernel;
      }
    }
    return seen / all;
  }
};

// A room of 10 x 10 x 3 m, a lamp of 1 x 1 m that looks down from 2.9 m.
Scene room() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  test::add_box(scene, {0, 0, 0}, {10, 10, 3}, {grey, grey, grey, grey, grey, grey}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{4.5, 4.5, 2.9}, {4.5, 5.5, 2.9}, {5.5, 5.5, 2.9}, {5.5, 4.5, 2.9}});
  return scene;
}

Vector3d random_point(std::uint64_t key) {
  return {random_uniform(random_key(key, 0)), random_uniform(random_key(key, 1)),
          random_uniform(random_key(key, 2))};
}

TEST(ExactShadows, AreWhatManyRaysFind) {
  Scene scene = room();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Vector3d low = Vector3d(8.5, 8.5, 1.7).cwiseProduct(random_point(random_key(i, 1)));
    const Vector3d size = Vector3d::Constant(0.2) + random_point(random_key(i, 2));
    test::add_box(scene, low, low + size, {0, 0, 0, 0, 0, 0}, false);
  }
  const Lit lit(std::move(scene));
  int partly = 0, exact = 0;
  double worst = 0.0;
  for (std::uint64_t i = 0; i < 800; ++i) {
    const Vector3d at = Vector3d(0.1, 0.1, 0.1) +
                        Vector3d(9.8, 9.8, 1.2).cwiseProduct(random_point(random_key(i, 3)));
    Vector3d normal = (Vector3d(5, 5, 2.9) - at).normalized() +
                      0.9 * (2.0 * random_point(random_key(i, 4)) - Vector3d::Ones());
    normal.normalize();
    const Emitter& lamp = lit.light.emitters()[0];
    if (!(lit.light.unoccluded_form_factor(lamp, {at, normal}) > 1e-6)) continue;
    const auto share = lit.share(at, normal);
    if (!share) continue;
    ++exact;
    constexpr int side = 64;
    const double expected = lit.share_of_rays(at, normal, side);
    partly += *share > 0.0 && *share < 1.0 ? 1 : 0;
    worst = std::max(worst, std::abs(*share - expected));
    // A straight edge runs through 2 side of side^2 cells at most and leaves each off by half at
    // most: 1 / side if all are off one way, which those of several edges are not.
    EXPECT_NEAR(*share, expected, 1.0 / side) << at.transpose();
    // All rays or none: the same sum twice, or nothing.
    if (*share == 1.0 || *share == 0.0) {
      EXPECT_EQ(expected, *share) << at.transpose();
    }
  }
  std::printf("%d told, %d of them partly hidden; at worst off by %.1e of the rays\n", exact,
              partly, worst);
  EXPECT_GT(exact, 150);
  EXPECT_GT(partly, 50);
}

// A half plane at height h hides what is beyond its edge.
TEST(ExactShadows, OfAStraightEdgeAreTheFormFactorOfWhatItLeaves) {
  Scene scene = room();
  test::add_polygon(scene, "shelf", 0, {{0, 0, 1}, {5, 0, 1}, {5, 10, 1}, {0, 10, 1}});
  const Lit lit(std::move(scene));
  const Vector3d up = Vector3d::UnitZ();
  for (const double x : {4.3, 4.7, 4.9, 5.1, 5.3}) {
    const Vector3d at(x, 5.2, 0.0);
    // The edge's shadow on the lamp's plane.
    const double cut = std::clamp(x + 2.9 * (5.0 - x), 4.5, 5.5);
    const auto lamp_from = [&](double low) {
      const std::vector<Vector3d> part{
          {low, 4.5, 2.9}, {low, 5.5, 2.9}, {5.5, 5.5, 2.9}, {5.5, 4.5, 2.9}};
      return low < 5.5 ? point_to_polygon(at, up, part) : 0.0;
    };
    const auto share = lit.share(at, up, 4);
    ASSERT_TRUE(share);
    // The precision of point_to_polygon.
    EXPECT_NEAR(*share, lamp_from(cut) / lamp_from(4.5), 1e-12) << x;
  }
}

TEST(ExactShadows, KeepOffWhatTheyCannotTell) {
  const Vector3d up = Vector3d::UnitZ(), floor(5.3, 4.8, 0.0);
  const auto with = [&](auto&& add) {
    Scene scene = room();
    add(scene);
    return Lit(std::move(scene)).share(floor, up, 4);
  };
  const auto square = [&](Scene& scene, int material, double z) {
    test::add_polygon(scene, "square", material,
                      {{5.21, 4.03, z}, {6.07, 4.03, z}, {6.07, 6.11, z}, {5.21, 6.11, z}});
  };
  EXPECT_EQ(with([](Scene&) {}), 1.0);
  const auto partly = with([&](Scene& scene) { square(scene, 0, 1.0); });
  ASSERT_TRUE(partly);
  EXPECT_GT(*partly, 0.0);
  EXPECT_LT(*partly, 1.0);

  const auto ball_at = [](const Vector3d& at) {
    return [at](Scene& scene) {
      scene.surfaces.push_back({.name = "ball", .material = 0, .shape = Sphere{at, 0.2}});
    };
  };
  EXPECT_FALSE(with(ball_at({5.1, 5.0, 1.5})));
  EXPECT_EQ(with(ball_at({8, 8, 1.5})), 1.0);

  Material pane = test::clear_glass(room().bands);
  pane.dielectric->thin = true;
  EXPECT_FALSE(with([&](Scene& scene) { square(scene, test::add_material(scene, pane), 1.0); }));

  // Under a rug, and a lamp behind a picture on it.
  EXPECT_FALSE(with([&](Scene& scene) { square(scene, 0, 0.0); }));
  EXPECT_FALSE(with([&](Scene& scene) { square(scene, 0, 2.9); }));
  // More than may be.
  EXPECT_FALSE(with([&](Scene& scene) {
    for (int i = 0; i <= plenty; ++i) square(scene, 0, 1.0 + 0.01 * i);
  }));
}

TEST(ExactShadows, AreCastFromBothSidesOfALampThatGlowsThere) {
  Scene scene = room();
  scene.materials[1].emits_both_sides = true;
  test::add_polygon(scene, "over it", 0, {{5, 4, 2.95}, {6, 4, 2.95}, {6, 6, 2.95}, {5, 6, 2.95}});
  const Lit lit(std::move(scene));
  const Vector3d down = -Vector3d::UnitZ();
  EXPECT_EQ(lit.share({4.6, 5.0, 2.94}, down), 1.0);
  // Right over its edge and the middle of the lamp, of which it hides just the half; to what
  // point_to_polygon is good for.
  const auto share = lit.share({5.0, 5.0, 3.0}, down, 5);
  ASSERT_TRUE(share);
  EXPECT_NEAR(*share, 0.5, 1e-12);
}

}  // namespace
}  // namespace lightwell::exact_shadows_test
