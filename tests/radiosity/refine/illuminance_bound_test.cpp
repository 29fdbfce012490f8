#include "radiosity/refine/illuminance_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::illuminance_bound_test {
namespace {

using namespace test;

// Caustics of a beam that lights a floor with 1 W/m2 at x > `edge`, as caustic_irradiance() leaves
// them: each vertex has the power of the elements around it over their area. Elements run along x.
BandArray caustics_of_beam(const PatchMesh& mesh, double edge) {
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(mesh.vertex_count()), area = power;
  for (int e = 0; e < mesh.element_count(); ++e) {
    double low = INFINITY, high = -INFINITY;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const double x = mesh.position(mesh.corners[e][c]).x();
      low = std::min(low, x);
      high = std::max(high, x);
    }
    const double lit = std::clamp((high - edge) / (high - low), 0.0, 1.0);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      power[mesh.corners[e][c]] += lit * mesh.element_area[e];
      area[mesh.corners[e][c]] += mesh.element_area[e];
    }
  }
  return (power / area).cast<float>().replicate(1, 3);
}

// RMS over the element in which a beam ends of what interpolation between its corners is off, W/m2.
double rms_error(double left, double right, double edge) {
  constexpr int steps = 10000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps, error = left + (right - left) * x - (x > edge ? 1.0 : 0.0);
    sum += error * error / steps;
  }
  return std::sqrt(sum);
}

// A floor of 8 m x 1 m in elements of 1 m, lit by a beam and nothing else, without noise.
TEST(IlluminanceErrors, HoldTheEdgeOfACaustic) {
  Scene scene;
  add_polygon(scene, "floor", add_material(scene, diffuse(scene.bands, 0.5f)),
              {{0, 0, 0}, {8, 0, 0}, {8, 1, 0}, {0, 1, 0}});
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 1});
  ASSERT_GE(mesh.element_count(), 8);
  const double lumens = luminous(scene.bands, constant_spectrum(scene.bands, 1.0f));
  for (const double within : {0.0, 0.25, 0.5, 0.75}) {
    RadiositySolution solution{.bands = scene.bands};
    solution.caustic_irradiance = caustics_of_beam(mesh, 4.0 + within);
    solution.indirect_irradiance = solution.caustic_irradiance;
    solution.direct_irradiance = 0.0f * solution.caustic_irradiance;
    solution.gather_noise = Eigen::ArrayXf::Zero(mesh.element_count());
    for (const bool refined : {false, true}) {
      if (refined) solution.interpolation_error = solution.gather_noise;
      const Eigen::ArrayXf error = illuminance_errors(mesh, solution);
      ASSERT_EQ(error.size(), mesh.element_count());
      // Vertices at x = 4 and 5 have the means of two elements each.
      const double at_edge = lumens * rms_error((1.0 - within) / 2, 1.0 - within / 2, within);
      // Sixteen roundings of floats. The integral is exact to 1e-9: the jump lies between two of
      // its steps, and the midpoint rule is off by h^2 / 24 of the slope of parabolas.
      const double roundings = std::ldexp(16.0, -24);
      EXPECT_GE(error.maxCoeff(), (1.0 - roundings) * at_edge) << within;
      if (within == 0.5) {
        EXPECT_NEAR(error.maxCoeff(), at_edge, roundings * at_edge) << "the largest error";
        if (refined) {
          EXPECT_NEAR(illuminance_bounds(mesh, solution).maxCoeff(), 2.0 * at_edge,
                      roundings * 2.0 * at_edge);
        }
      }
      EXPECT_EQ(error.minCoeff(), 0.0f) << "far from the edge caustics are even";
    }
  }
}

}  // namespace
}  // namespace lightwell::illuminance_bound_test
