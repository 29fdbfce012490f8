#include <gtest/gtest.h>

#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/form_factors.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::form_factors_test {
namespace {

struct Solved {
  PatchMesh mesh;
  std::unique_ptr<FormFactors> form_factors;
  FormFactorReport report;
};

Solved cast(const Scene& scene, const FormFactorOptions& options, double patch_size = 0.25) {
  Solved s;
  s.mesh = build_patches(scene, {.max_patch_size = patch_size, .elements_per_patch_edge = 1});
  const ElementCaster caster(s.mesh);
  const DirectLight direct_light(scene, s.mesh);
  s.form_factors = compute_form_factors({scene, caster, direct_light}, options, &s.report);
  return s;
}

double worst_closure(const Solved& s) {
  double worst = 0.0;
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    double sum = s.form_factors->escaped(i)[0] + s.form_factors->absorbed_by_specular(i)[0];
    for (const FormFactor& f : s.form_factors->row(i)) sum += f.value;
    const SpecularRow specular = s.form_factors->specular_row(i);
    for (std::size_t e = 0; e < specular.patch.size(); ++e) sum += specular.value(e, 0);
    if (sum > 0.0) worst = std::max(worst, std::abs(sum - 1.0));
  }
  return worst;
}

double form_factor(const Solved& s, int i, int j) {
  for (const FormFactor& f : s.form_factors->row(i)) {
    if (f.patch == j) return f.value;
  }
  return 0.0;
}

double worst_reciprocity(const Solved& s) {
  double worst = 0.0;
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    for (const FormFactor& f : s.form_factors->row(i)) {
      const double there = s.mesh.area[i] * f.value;
      const double back = s.mesh.area[f.patch] * form_factor(s, f.patch, i);
      worst = std::max(worst, std::abs(there - back) / std::max(there, back));
    }
  }
  return worst;
}

TEST(FormFactors, ClosedRoomClosesAndIsReciprocal) {
  const Solved s = cast(test::furnace(0.5f, 1.0f, true), {.rays_per_patch = 256});
  EXPECT_LT(worst_closure(s), 1e-6);                 // a few hundred float entries per row
  EXPECT_LT(worst_reciprocity(s), 1e-6);             // two float roundings
  EXPECT_GT(s.report.max_closure_correction, 1e-4);  // the raw estimate was noisy
}

TEST(FormFactors, CubeFacesSeeEachOtherAsTheClosedFormSays) {
  Scene scene;
  const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {m, m, m, m, m, m}, true);
  const int rays = 4096;
  const Solved s = cast(scene, {.rays_per_patch = rays});
  Eigen::ArrayXXd F = Eigen::ArrayXXd::Zero(6, 6);  // face to face, area-weighted
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    for (const FormFactor& f : s.form_factors->row(i)) {
      F(s.mesh.facet_of(i), s.mesh.facet_of(f.patch)) += s.mesh.area[i] * f.value;
    }
  }
  // 16 patches per face, rays from each end: 4 standard errors of a binomial share of 0.2, an upper
  // bound for stratified rays.
  const double se = std::sqrt(0.2 * 0.8 / (16.0 * rays));
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double exact = i == j           ? 0.0
                           : i / 2 == j / 2 ? 0.19982489569838738
                                            : 0.20004377607540316;
      EXPECT_NEAR(F(i, j), exact, 4 * se) << i << " to " << j;
    }
  }
}

// The inside of a ball of triangles, in patches of many facets that see themselves. On a sphere
// F_ij = A_j / A.
TEST(FormFactors, PatchesOfManyFacetsSeeThemselvesAndTheRoomCloses) {
  Scene scene;
  const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 0.0f));
  scene.materials[m].one_sided = true;
  PolygonMesh ball;
  constexpr int n = 32, rings = n / 2;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < n; ++i) {
      const double theta = M_PI * j / rings, phi = 2.0 * M_PI * i / n;
      ball.vertices.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
      const int right = (i + 1) % n;
      if (j > 0 && j < rings) {
        ball.facets.push_back({.boundary = {j * n + i, j * n + right, (j + 1) * n + i}});
      }
      if (j + 1 < rings) {
        ball.facets.push_back({.boundary = {j * n + right, (j + 1) * n + right, (j + 1) * n + i}});
      }
    }
  }
  scene.surfaces.push_back({.name = "ball", .material = m, .shape = ball});
  constexpr int rays = 4096;
  for (const auto method : {FormFactorMethod::ray_cast, FormFactorMethod::automatic,
                            FormFactorMethod::analytic, FormFactorMethod::hemicube}) {
    const Solved s = cast(scene, {.method = method, .rays_per_patch = rays}, 0.8);
    ASSERT_LT(s.mesh.patch_count(), 100);
    EXPECT_LT(worst_closure(s), 1e-5);
    EXPECT_LT(worst_reciprocity(s), 1e-5);
    const double A = s.mesh.area.sum();
    for (int i = 0; i < s.mesh.patch_count(); ++i) {
      if (s.mesh.facet_of(i) >= 0) continue;
      const Eigen::Vector3d here = element_center(s.mesh, s.mesh.first_element[i]).position;
      // A facet does not see itself; the rest of the patch has the form factor of a sphere.
      EXPECT_GT(form_factor(s, i, i), 0.0);
      EXPECT_LT(form_factor(s, i, i), 2.0 * s.mesh.area[i] / A);
      double far = 0.0, far_area = 0.0;
      for (int j = 0; j < s.mesh.patch_count(); ++j) {
        const Eigen::Vector3d there = element_center(s.mesh, s.mesh.first_element[j]).position;
        if (here.dot(there) > 0.0) continue;
        far += form_factor(s, i, j);
        far_area += s.mesh.area[j];
      }
      // 4 standard errors of a share of a half, and 2 % for facets that lie inside of the sphere
      // by 1 - cos(pi / 16).
      const double error = 4.0 * 0.5 / std::sqrt(1.0 * rays) + 0.02;
      EXPECT_NEAR(far, far_area / A, error) << "patch " << i;
    }
  }
}

TEST(FormFactors, OpenTopLetsOutWhatTheClosedFormSays) {
  Scene scene;
  const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {m, m, m, m, m, m}, true);
  scene.surfaces.pop_back();  // z1
  const Solved s = cast(scene, {.rays_per_patch = 4096});
  double floor_escapes = 0.0;
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    if (s.mesh.facet_of(i) == 4) floor_escapes += s.mesh.area[i] * s.form_factors->escaped(i)[0];
  }
  const double se = std::sqrt(0.2 * 0.8 / (16.0 * 4096));
  EXPECT_NEAR(floor_escapes, 0.19982489569838738, 4 * se);
  EXPECT_LT(worst_closure(s), 1e-6);
}

// A small lamp under the ceiling: its entries come from the closed form, and its own row closes,
// too.
TEST(FormFactors, SmallEmitterIsExactAndCloses) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.6f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 10.0f));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, true);
  const Loop points = {{0.45, 0.45, 0.9}, {0.45, 0.55, 0.9}, {0.55, 0.55, 0.9}, {0.55, 0.45, 0.9}};
  test::add_polygon(scene, "lamp", lamp, points);
  const Solved s = cast(scene, {.rays_per_patch = 256}, 0.1);
  EXPECT_LT(worst_closure(s), 2e-6);
  EXPECT_LT(worst_reciprocity(s), 1e-6);

  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    if (s.mesh.facet_of(i) != 4) continue;  // floor: nothing between it and the lamp
    double F = 0.0;
    for (const FormFactor& f : s.form_factors->row(i)) {
      if (s.mesh.surface[f.patch] == 6) F += f.value;
    }
    const PatchPoint center = element_center(s.mesh, s.mesh.first_element[i]);
    const double exact = std::abs(point_to_polygon(center.position, center.normal, {&points, 1}));
    // 16 points of a patch against its centre (curvature over a tenth of the room, below 1 %), and
    // the lamp's row closed by one factor (16 points a receiver, below 1 %).
    EXPECT_NEAR(F / exact, 1.0, 0.02);
  }
}

// Opposite a perfect mirror a patch sees the room's image: every ray returns.
TEST(FormFactors, PerfectMirrorPassesEverythingOn) {
  const Scene scene = test::room_with_mirror(1.0f);
  const Solved s = cast(scene, {.rays_per_patch = 1024});
  EXPECT_LT(worst_closure(s), 1e-5);
  // Face x1 sees x0 with F = 0.19982..., all of which returns; the image of x1 itself is the
  // opposed unit square at distance 2: F = 0.06858959... (parallel unit squares, closed form).
  double back = 0.0, area = 0.0;
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    if (s.mesh.facet_of(i) != 1) continue;
    area += s.mesh.area[i];
    const SpecularRow row = s.form_factors->specular_row(i);
    for (std::size_t e = 0; e < row.patch.size(); ++e) {
      if (s.mesh.facet_of(row.patch[e]) == 1) back += s.mesh.area[i] * row.value(e, 0);
    }
  }
  const auto parallel_squares = [](double distance) {
    const double x = 1.0 / distance, q = std::sqrt(1.0 + x * x);
    return 2.0 / (M_PI * x * x) *
           (std::log(q * q / std::sqrt(1.0 + 2.0 * x * x)) + 2.0 * x * q * std::atan(x / q) -
            2.0 * x * std::atan(x));
  };
  const double exact = parallel_squares(2.0);
  EXPECT_NEAR(back / area, exact, 4 * std::sqrt(exact * (1 - exact) / (16.0 * 1024)));
}

// Walls of four patches of 0.25 m^2 each, and a block of 5 cm, whose faces have a hundredth of that
// area: 512 rays, and a sixteenth of them.
TEST(FormFactors, SmallPatchesMayCastFewerRays) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const std::array all{grey, grey, grey, grey, grey, grey};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, all, true);
  test::add_box(scene, {0.5, 0.5, 0.5}, {0.55, 0.55, 0.55}, all, false);
  const Solved s = cast(
      scene,
      {.method = FormFactorMethod::ray_cast, .rays_per_patch = 512, .has_rays_by_area = true}, 0.5);
  for (int i = 0; i < s.mesh.patch_count(); ++i) {
    const float rays = s.mesh.area[i] > 0.1 ? 512.0f : 32.0f;
    EXPECT_EQ(s.report.count_error[static_cast<std::size_t>(i)], 0.5f / std::sqrt(rays));
  }
  // Balancing ends within 1e-8, and floats round a row, whose sum is 1, by 2^-24 of it at most.
  EXPECT_LT(worst_closure(s), 1e-8 + 0x1p-24);
  // F_ij and F_ji are floats, each off by 2^-24 of itself at most.
  EXPECT_LE(worst_reciprocity(s), 0x1p-23);
}

// Rows of few rays have contradictory targets; no factor may grow without bound.
TEST(FormFactors, FewRaysAmongMirrorsStayFiniteShares) {
  int m = 0;
  Scene scene = test::room_with_mirror(0.9f, &m);
  test::add_box(scene, {0.3, 0.3, 0.3}, {0.31, 0.7, 0.7}, {m, m, m, m, m, m}, false);
  for (const int rays : {1, 2, 8}) {
    const Solved s = cast(scene, {.rays_per_patch = rays});
    for (int i = 0; i < s.mesh.patch_count(); ++i) {
      const SpecularRow row = s.form_factors->specular_row(i);
      if (row.patch.empty()) continue;
      ASSERT_TRUE(row.value.allFinite()) << "patch " << i;
      ASSERT_GE(row.value.minCoeff(), 0.0f) << "patch " << i;
      // Balancing may at most double the measured share of both ends, which is at most 1.
      ASSERT_LE(row.value.maxCoeff(), 2.0f) << "patch " << i;
      ASSERT_GE(s.form_factors->absorbed_by_specular(i).minCoeff(), 0.0f) << "patch " << i;
      ASSERT_GE(s.form_factors->escaped(i).minCoeff(), 0.0f) << "patch " << i;
    }
  }
}

}  // namespace
}  // namespace lightwell::form_factors_test
