#include "radiosity/gather/gap_light.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/gather/final_gather.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::gap_light_test {
namespace {

using Eigen::Vector3d;

constexpr double width = 0.2, length = 4.0;
constexpr float B0 = 3.0f, rho = 0.5f;
constexpr int desk = 6;  // facet, after the six walls

// Two plates that face each other across `gap`, in the middle of a wide room whose walls emit B0.
// The light of the plates' vertices is that of plates in the open, as coarse meshes have it.
struct Plates {
  explicit Plates(double gap)
      : scene(room(gap)),
        mesh(build_patches(scene, {.max_patch_size = 2.0})),
        caster(mesh),
        light(scene, mesh),
        radiosity(gatherable_radiosity(
            mesh, light, BandArray::Constant(mesh.vertex_count(), scene.bands.count(), B0))) {}

  static Scene room(double gap) {
    Scene scene;
    const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.0f, B0));
    const int plate = test::add_material(scene, test::diffuse(scene.bands, rho));
    test::add_box(scene, {-10, -10, -10}, {10, 10, 10}, {wall, wall, wall, wall, wall, wall}, true);
    const double w = width, l = 0.5 * length;
    test::add_polygon(scene, "desk", plate, {{0, -l, 0}, {w, -l, 0}, {w, l, 0}, {0, l, 0}});
    test::add_polygon(scene, "foot", plate, {{0, -l, gap}, {0, l, gap}, {w, l, gap}, {w, -l, gap}});
    return scene;
  }

  double gathered(double x, int rays, std::uint64_t replica = 0) const {
    const std::vector<GatherPoint> points = {{.position = {x, 0.0, 0.0}, .facet = desk}};
    const GatherOptions options{.rays = rays, .replica = replica, .aims_out_of_gaps = true};
    return gather_irradiance({scene, caster, light}, radiosity, points, options).indirect(0, 0);
  }

  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  BandArray radiosity;
};

// Irradiance at x between two infinitely long plates in a room of radiosity B0: by symmetry both
// plates have the same,
//     E(x) = B0 (1 - F(x)) + rho int K(x, y) E(y) dy,   K = g^2 / (2 ((x - y)^2 + g^2)^(3/2)),
// with F = int K dy in closed form. The unknowns stand in the midpoints of equal cells; K is
// integrated over each cell in closed form.
double between_long_plates(double x, double gap) {
  constexpr int n = 800;
  const double h = width / n;
  const auto reached = [&](double from, double to) {  // int K up to `to`
    return 0.5 * (to - from) / std::hypot(to - from, gap);
  };
  const auto covered = [&](double from) { return reached(from, width) - reached(from, 0.0); };
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd b(n);
  for (int i = 0; i < n; ++i) {
    const double xi = (i + 0.5) * h;
    b[i] = B0 * (1.0 - covered(xi));
    for (int j = 0; j < n; ++j) {
      A(i, j) -= static_cast<double>(rho) * (reached(xi, (j + 1) * h) - reached(xi, j * h));
    }
  }
  const Eigen::VectorXd E = A.partialPivLu().solve(b);
  double sum = B0 * (1.0 - covered(x));
  for (int j = 0; j < n; ++j) {
    sum += static_cast<double>(rho) * E[j] * (reached(x, (j + 1) * h) - reached(x, j * h));
  }
  return sum;
}

TEST(GapLight, BetweenLongPlatesIsThatOfTheIntegralEquation) {
  for (const double gap : {0.002, 0.01}) {
    const Plates plates(gap);
    for (const double depth : {0.5, 1.0, 2.0, 5.0}) {
      const double x = depth * gap, expected = between_long_plates(x, gap);
      constexpr int rays = 1 << 14;
      // Paths bring B0 or nothing: four standard errors. 1 % for the plates' finite length.
      const double p = expected / B0;
      const double noise = 4.0 * B0 * std::sqrt(p * (1.0 - p) / rays);
      EXPECT_NEAR(plates.gathered(x, rays), expected, noise + 0.01 * expected)
          << "gap " << gap << ", depth " << x;
    }
  }
}

// Deep in a gap one cosine-distributed ray in thousands gets out.
TEST(GapLight, DeepInAGapIsKnownByAFewHundredRays) {
  for (const double gap : {0.001, 0.004}) {
    const Plates plates(gap);
    const double x = 0.4 * width, expected = between_long_plates(x, gap);
    constexpr int rays = 512, replicas = 64;
    Eigen::ArrayXd found(replicas);
    for (int i = 0; i < replicas; ++i) {
      found[i] = plates.gathered(x, rays, static_cast<std::uint64_t>(i));
    }
    const double deviation = std::sqrt((found - found.mean()).square().sum() / (replicas - 1));
    // Cosine-distributed rays alone bring B0 or nothing and deviate by 0.5 at least, as a share.
    ASSERT_GT(std::sqrt(B0 / (rays * expected)), 0.5);
    // A fifth of a place's own light is what gathers at points promise in gaps.
    EXPECT_LT(deviation, 0.2 * expected) << "gap " << gap;
    // Four standard errors; 1 % for the plates' finite length.
    EXPECT_NEAR(found.mean(), expected, 4.0 * deviation / std::sqrt(replicas) + 0.01 * expected)
        << "gap " << gap;
  }
}

TEST(GapLight, IsNotLookedForBetweenPlatesFarApart) {
  // Elements of 0.2 x 1 m have a size of 0.447 m, a fifth of which is 0.089 m.
  const Plates plates(0.1);
  const Ray ray{.origin = {0.1, 0.0, 0.0}, .direction = {0.0, 0.0, 1.0}, .origin_group = desk};
  ElementHit hit;
  plates.caster.closest_hits({&ray, 1}, {&hit, 1});
  ASSERT_GE(hit.element, 0);
  const LightPaths paths(plates.scene, plates.caster, 8);
  const GapLight gaps({plates.scene, plates.caster, plates.light}, plates.radiosity, paths);
  EXPECT_NEAR(std::sqrt(plates.mesh.element_area[hit.element]), 0.447, 0.001);
  EXPECT_FALSE(gaps.is_gap(Vector3d::UnitZ(), ray, hit));
  // Seen from nearer it would be a gap; walls that stand on the plate never are.
  const Ray near{.origin = {0.1, 0.0, 0.05}, .direction = {0.0, 0.0, 1.0}};
  plates.caster.closest_hits({&near, 1}, {&hit, 1});
  EXPECT_TRUE(gaps.is_gap(Vector3d::UnitZ(), near, hit));
  EXPECT_FALSE(gaps.is_gap(Vector3d::UnitX(), near, hit));
}

}  // namespace
}  // namespace lightwell::gap_light_test
