// Points that send on light, as free sources.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/sampling.h"

namespace lightwell::virtual_light_test {
namespace {

using Eigen::Vector3d;

FreeSource light_at(const Vector3d& position, const Vector3d& normal, double most) {
  return {.light = constant_spectrum(rgb_bands(), 2.0f),
          .shape = VirtualLight{.position = position, .normal = normal, .facet = 7, .most = most}};
}

constexpr double unlimited = std::numeric_limits<double>::infinity();

TEST(VirtualLight, GivesWhatASmallLambertianSquareOfItsFluxGives) {
  const Vector3d at(0.3, -0.2, 1.0), normal = -Vector3d::UnitZ();
  constexpr double h = 0.5e-3;  // half a side, m
  const Loop square{at + Vector3d(-h, -h, 0), at + Vector3d(-h, h, 0), at + Vector3d(h, h, 0),
                    at + Vector3d(h, -h, 0)};
  const FreeSource light = light_at(at, normal, unlimited);
  for (const Vector3d& n : {Vector3d(0, 0, 1), Vector3d(0.6, 0, 0.8), Vector3d(0.48, -0.6, 0.64)}) {
    const double of_square = point_to_polygon({0, 0, 0}, n, square) / (4.0 * h * h);
    // The square is seen from a thousand times its side: (side / distance)^2 = 1e-6, and the closed
    // form loses as much to cancellation at 1e-7 of the hemisphere.
    EXPECT_NEAR(unoccluded_kernel(light, {0, 0, 0}, n) / of_square, 1.0, 1e-5);
  }
}

TEST(VirtualLight, GivesNothingBehindAndNoMoreThanItsLimit) {
  const FreeSource light = light_at({0, 0, 1}, -Vector3d::UnitZ(), 0.25);
  EXPECT_EQ(unoccluded_kernel(light, {0, 0, 2}, Vector3d::UnitZ()), 0.0);   // behind the light
  EXPECT_EQ(unoccluded_kernel(light, {0, 0, 0}, -Vector3d::UnitZ()), 0.0);  // below the horizon
  EXPECT_EQ(unoccluded_kernel(light, {0, 0, 0.999}, Vector3d::UnitZ()), 0.25 / std::numbers::pi);
}

TEST(VirtualLight, IsSampledAsItsKernelSays) {
  const FreeSource light = light_at({0.1, 0.2, 1}, Vector3d(0.6, 0, -0.8), unlimited);
  const Vector3d point(0.5, 0.1, 0), normal(0, 0.6, 0.8);
  const double kernel = unoccluded_kernel(light, point, normal);
  ASSERT_GT(kernel, 0.0);
  const SourceSample seen = sample_source(light, point, 0.5, 0.5);
  // Two ways to the same quotient of two dot products, of which each term is below the sum's
  // twofold, and a power of the distance: fewer than 32 roundings of both together.
  EXPECT_NEAR(seen.irradiance * seen.direction.dot(normal), kernel, 32.0 * 0x1p-53 * kernel);
  const ShadowSample shadow = shadow_sample(light, {point, normal, 3}, 0.5, 0.5);
  EXPECT_EQ(shadow.weight, kernel);
  EXPECT_EQ(shadow.ray.target_group, 7);
  EXPECT_TRUE(has_sharp_shadows(light));
  EXPECT_FALSE(light.is_distant());
}

TEST(VirtualLight, SendsRaysByTheCosine) {
  const Vector3d normal(0.6, 0, -0.8);
  const FreeSource light = light_at({0.1, 0.2, 1}, normal, unlimited);
  EXPECT_EQ(total_weight(light), 1.0);
  constexpr int count = 4096;
  const SobolPoints sobol(count);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const SourceRay ray = source_ray(light, sobol.point(i, 1));
    EXPECT_EQ(ray.weight, 1.0);
    sum += ray.ray.direction.dot(normal) / count;
  }
  // The mean cosine is 2/3, with a standard deviation of sqrt(1/18): four standard errors of
  // independent directions, which stratified ones stay below.
  EXPECT_NEAR(sum, 2.0 / 3.0, 4.0 * std::sqrt(1.0 / 18.0 / count));
}

}  // namespace
}  // namespace lightwell::virtual_light_test
