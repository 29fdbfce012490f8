#include "design/places/kernel_slope.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "radiosity/emitters/free_source.h"

namespace lightwell::kernel_slope_test {
namespace {

const SurfacePoint receiver{.position = {0.3, -0.2, 0.1},
                            .normal = Eigen::Vector3d(0.2, 0.1, 1.0).normalized()};

/// A web that is linear in gamma and in C, with other values in every direction.
IntensityShape web() {
  Eigen::ArrayXXd values(4, 4);
  values << 100, 80, 40, 0, 100, 90, 60, 10, 100, 60, 30, 5, 100, 70, 50, 20;
  return std::make_shared<const PhotometricWeb>(std::vector<double>{0, 90, 180, 270},
                                                std::vector<double>{0, 30, 60, 90}, values);
}

Lamp lamp_of(const IntensityShape& shape) {
  return {.position = {1.1, 0.7, 2.4},
          .axes = lamp_axes({0.1, -0.2, -1.0}, {1.0, 0.3, 0.0}),
          .intensity = Spectrum::Ones(3),
          .shape = shape};
}

double kernel(Lamp lamp, const Eigen::Vector3d& position) {
  lamp.position = position;
  return unoccluded_kernel(FreeSource{.light = lamp.intensity, .shape = LampLight{.lamp = lamp}},
                           receiver.position, receiver.normal);
}

class KernelSlopes : public testing::TestWithParam<IntensityShape> {};

/// The derivative of K = S cos / r^2 by the place of the lamp, beside central differences. K
/// changes over about 1 m, so that a step h of 1e-4 m leaves h^2 / 6 of a third derivative, 1e-8 of
/// K for each metre; rounding leaves 1e-16 / h = 1e-12. That of the intensity has 1e-8, see
/// kernel_slope.cpp.
TEST_P(KernelSlopes, AreThoseOfCentralDifferences) {
  const Lamp lamp = lamp_of(GetParam());
  const KernelSlope slope = kernel_slope(lamp, lamp.position, receiver);
  // Some 15 operations on each side, rounded by 2^-53 each; the cube of the distance triples them.
  constexpr double roundings = 2 * 15 * 3;
  EXPECT_NEAR(slope.kernel, kernel(lamp, lamp.position), roundings * 0x1p-53 * slope.kernel);
  ASSERT_GT(slope.kernel, 0.0);
  constexpr double h = 1e-4;
  const double largest = slope.gradient.cwiseAbs().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
    const double difference =
        (kernel(lamp, lamp.position + step) - kernel(lamp, lamp.position - step)) / (2.0 * h);
    // Both parts above, times K over the largest derivative: half of the distance of 2.5 m at most.
    constexpr double error = (1e-8 + 1e-8) * 0.5 * 2.5;
    EXPECT_NEAR(slope.gradient[axis], difference, error * largest) << "axis " << axis;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, KernelSlopes,
                         testing::Values(IntensityShape(EvenIntensity{}),
                                         IntensityShape(SpotCone{.inner = 0.1, .outer = 1.2}),
                                         web()));

/// Above the receiver, at height h, K = S / h^2 and dK/dh = -2 S / h^3; sideways K does not change.
TEST(KernelSlope, IsTheInverseSquareLawAbove) {
  constexpr double h = 2.5;
  const SurfacePoint floor{.position = {0, 0, 0}, .normal = Eigen::Vector3d::UnitZ()};
  const Lamp lamp{.intensity = Spectrum::Ones(1)};
  const KernelSlope slope = kernel_slope(lamp, {0, 0, h}, floor);
  EXPECT_DOUBLE_EQ(slope.kernel, 1.0 / (h * h));
  // Eight operations on the larger of the two terms, 3 / h^3.
  constexpr double rounding = 8.0 * 0x1p-53 * 3.0 / (h * h * h);
  EXPECT_NEAR(slope.gradient.z(), -2.0 / (h * h * h), rounding);
  EXPECT_DOUBLE_EQ(slope.gradient.x(), 0.0);
  EXPECT_DOUBLE_EQ(slope.gradient.y(), 0.0);
}

TEST(KernelSlope, IsZeroBehindTheReceiver) {
  const SurfacePoint floor{.position = {0, 0, 0}, .normal = Eigen::Vector3d::UnitZ()};
  const KernelSlope slope = kernel_slope({.intensity = Spectrum::Ones(1)}, {0.1, 0, -1}, floor);
  EXPECT_EQ(slope.kernel, 0.0);
  EXPECT_TRUE(slope.gradient.isZero(0.0));
}

}  // namespace
}  // namespace lightwell::kernel_slope_test
