// Form factors between cylinders, discs and cones against Howell's catalogue (Howell & Menguc 2011,
// "Radiative transfer configuration factor catalog").
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "scene/round_shape.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::round_form_factors_test {
namespace {

using std::numbers::pi;

Scene scene_of(const std::vector<RoundShape>& shapes) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  for (const RoundShape& shape : shapes) {
    scene.surfaces.push_back({.name = "shape", .material = grey});
    set_shape(scene.surfaces.back(), shape);
  }
  return scene;
}

Frustum disc(double z, double radius, bool faces_down = false) {
  return {.base = {0, 0, z},
          .height = 0.0,
          .base_radius = radius,
          .top_radius = 0.0,
          .inward = faces_down};
}

Frustum cylinder(double radius, double height, bool inward) {
  return {.height = height, .base_radius = radius, .top_radius = radius, .inward = inward};
}

/// Share of the light from the fronts of surface 0 that meets surface 1, by 2^17 rays of each
/// patch. Sobol's points in four dimensions have an error of some 1 / n^0.75 (measured) for such a
/// share.
double form_factor(const std::vector<RoundShape>& shapes) {
  const Scene scene = scene_of(shapes);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.7});
  const ElementCaster caster(mesh);
  constexpr int count = 1 << 17;
  static const SobolPoints sobol(count);
  double met = 0.0, sent = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.surface[p] != 0 || mesh.is_back[p] != 0) continue;
    const PatchSampler sampler(mesh, p);
    std::vector<char> meets(count, 0);
    parallel_for(count, 1024, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Eigen::Array4f u = sobol.point(i, static_cast<std::uint64_t>(p));
        const Ray ray = cosine_ray(mesh, sampler.point(u[0], u[1]), u[2], u[3]);
        ElementHit hit;
        caster.closest_elements({&ray, 1}, {&hit, 1});
        meets[static_cast<std::size_t>(i)] = hit.facet == 1 ? 1 : 0;
      }
    });
    met += mesh.area[p] * std::accumulate(meets.begin(), meets.end(), 0) / count;
    sent += mesh.area[p];
  }
  return met / sent;
}

// n^-0.75 of 2^17 rays. With 2^20 rays all are within 3e-5, most within 8e-6.
constexpr double many_rays = 0x1p-12 * 0.5946;  // 2^-12.75 = 1.45e-4

/// Catalogue, C-41.
double coaxial_discs(double r1, double r2, double h) {
  const double R1 = r1 / h, R2 = r2 / h, X = 1.0 + (1.0 + R2 * R2) / (R1 * R1);
  return 0.5 * (X - std::sqrt(X * X - 4.0 * (R2 / R1) * (R2 / R1)));
}

TEST(RoundFormFactors, OfCoaxialDiscs) {
  for (const double r2 : {0.4, 1.0, 1.7}) {
    EXPECT_NEAR(form_factor({disc(0, 1.0), disc(0.8, r2, true)}), coaxial_discs(1.0, r2, 0.8),
                many_rays)
        << r2;
  }
}

TEST(RoundFormFactors, OfADiscToARing) {
  Frustum ring = disc(0.8, 1.7, true);
  ring.top_radius = 0.4;
  EXPECT_NEAR(form_factor({disc(0, 1.0), ring}),
              coaxial_discs(1.0, 1.7, 0.8) - coaxial_discs(1.0, 0.4, 0.8), many_rays);
}

/// Catalogue, C-79: what leaves the inside for the base is 1/2 of what the other end does not get.
TEST(RoundFormFactors, OfTheInsideOfACylinderToItsBase) {
  for (const double height : {0.5, 2.0}) {
    const double base_to_side = 1.0 - coaxial_discs(1.0, 1.0, height);
    EXPECT_NEAR(form_factor({cylinder(1.0, height, true), disc(0, 1.0)}),
                base_to_side / (2.0 * height), many_rays)
        << height;
  }
}

/// Catalogue, C-92 and C-93: from the outer of two cylinders to the inner one.
TEST(RoundFormFactors, OfCoaxialCylinders) {
  for (const double height : {1.0, 3.0}) {
    const double R = 2.0, H = height, A = H * H + R * R - 1.0, B = H * H - R * R + 1.0;
    const double outer_to_inner =
        (1.0 - (std::acos(B / A) -
                (std::sqrt((A + 2.0) * (A + 2.0) - 4.0 * R * R) * std::acos(B / (R * A)) +
                 B * std::asin(1.0 / R) - 0.5 * pi * A) /
                    (2.0 * H)) /
                   pi) /
        R;
    EXPECT_NEAR(form_factor({cylinder(2.0, height, true), cylinder(1.0, height, false)}),
                outer_to_inner, many_rays)
        << height;
  }
}

/// A cone's inside sees of its base what the areas say: F = A_base / A_cone, as the base sees the
/// cone alone.
TEST(RoundFormFactors, OfTheInsideOfAConeToItsBase) {
  const Frustum cone{.height = 1.0, .base_radius = 0.75, .top_radius = 0.0, .inward = true};
  EXPECT_NEAR(form_factor({cone, disc(0, 0.75)}), 0.75 / 1.25, many_rays);
}

/// A room with a cylinder on its floor, a cone and a ring, where all emit 1 and give back half of
/// what arrives: B = 2 everywhere, however coarse the mesh.
TEST(RoundFormFactors, AFurnaceIsEven) {
  Scene scene;
  Material shining = test::diffuse(scene.bands, 0.5f, 1.0f);
  shining.emits_both_sides = true;
  shining.one_sided = false;
  const int grey = test::add_material(scene, shining);
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, {grey, grey, grey, grey, grey, grey}, true);
  const auto add = [&](const Frustum& frustum) {
    scene.surfaces.push_back({.name = "shape", .material = grey, .shape = frustum});
  };
  add({.base = {1, 1, 0}, .height = 1.5, .base_radius = 0.3, .top_radius = 0.3});
  add({.base = {1, 1, 1.5}, .height = 0.0, .base_radius = 0.3, .top_radius = 0.0});
  add({.base = {3, 2, 0.5}, .height = 1.0, .base_radius = 0.5, .top_radius = 0.0});
  add({.base = {2, 3, 2}, .height = 0.0, .base_radius = 0.6, .top_radius = 0.2});
  SolveOptions options;
  options.mesh.max_patch_size = 0.6;
  options.form_factors.rays_per_patch = 1024;
  options.error_points = 16;
  const SolvedScene room = solve_scene(scene, options);
  constexpr float converged = 2e-3f;  // of the light
  for (int p = 0; p < room.mesh.patch_count(); ++p) {
    const bool is_outside = room.mesh.surface[p] < 6 && room.mesh.is_back[p] != 0;
    if (is_outside) continue;
    EXPECT_NEAR(room.solution.patch_radiosity(p, 1), 2.0f, converged) << p;
  }
}

}  // namespace
}  // namespace lightwell::round_form_factors_test
