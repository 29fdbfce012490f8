#include "mesh/patches/element_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::element_quality_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

// Rounding of a few operations on numbers of order one.
constexpr double exact = 1e-12;

/// One element in one patch.
PatchMesh single_element(const std::vector<Vector3d>& corners) {
  PatchMesh mesh;
  mesh.corners = {{0, 1, 2, corners.size() == 4 ? 3 : -1}};
  mesh.patch = {0};
  mesh.facet = {0};
  mesh.first_element = {0, 1};
  mesh.is_back = {0};
  mesh.element_area = mesh.area = Eigen::ArrayXd::Constant(1, 1.0);
  build_topology(mesh, corners);
  return mesh;
}

TEST(ElementShape, ARectangleOfAByBHasTheAspectAPlusBOverTwoB) {
  for (const double a : {1.0, 3.0, 250.0}) {
    const Vector3d u(a * 0.6, a * 0.8, 0), v(-0.8, 0.6, 0), w(2, 3, 4);
    const ElementShape shape = element_shape(single_element({w, w + u, w + u + v, w + v}), 0);
    EXPECT_NEAR(shape.aspect_ratio, (a + 1.0) / 2.0, a * exact);
    EXPECT_NEAR(shape.least_angle_degrees, 90.0, 90.0 * exact);
  }
}

TEST(ElementShape, TrianglesHaveTheClosedForms) {
  const double height = std::sqrt(0.75);
  const ElementShape equal =
      element_shape(single_element({{0, 0, 1}, {1, 0, 1}, {0.5, height, 1}}), 0);
  EXPECT_NEAR(equal.aspect_ratio, 1.0, exact);
  EXPECT_NEAR(equal.least_angle_degrees, 60.0, 60.0 * exact);
  // A right triangle with legs of 1: sqrt(2) (2 + sqrt(2)) / (4 sqrt(3) / 2).
  const ElementShape half_square =
      element_shape(single_element({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 0);
  EXPECT_NEAR(half_square.aspect_ratio, (1.0 + std::sqrt(2.0)) / std::sqrt(3.0), exact);
  EXPECT_NEAR(half_square.least_angle_degrees, 45.0, 45.0 * exact);
}

TEST(ElementShape, AParallelogramsLeastAngleIsTheAcuteOne) {
  const double angle = std::numbers::pi / 12.0;
  const Vector3d u(2, 0, 0), v(std::cos(angle), std::sin(angle), 0);
  const ElementShape shape = element_shape(single_element({Vector3d::Zero(), u, u + v, v}), 0);
  EXPECT_NEAR(shape.least_angle_degrees, 15.0, 15.0 * exact);
  EXPECT_NEAR(shape.aspect_ratio, 2.0 * 6.0 / (4.0 * 2.0 * std::sin(angle)), 10.0 * exact);
}

TEST(ElementShape, WithoutAreaTheAspectIsInfiniteAndTheAngleZero) {
  const ElementShape shape = element_shape(single_element({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}), 0);
  EXPECT_TRUE(std::isinf(shape.aspect_ratio));
  EXPECT_EQ(shape.least_angle_degrees, 0.0);
}

TEST(ElementQuality, FrontsCoverTheSceneAndBacksAreNotCounted) {
  for (const int material : {0, 1}) {  // with both sides, and with the front alone
    Scene scene = empty_scene();
    add_polygon(scene, "holed", {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}},
                {{{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}}, material);
    add_sphere(scene, "ball", {{9, 9, 9}, 0.7}, material);
    const double area = 11.0 + 4.0 * std::numbers::pi * 0.49;
    EXPECT_NEAR(scene_area(scene), area, area * exact);
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
    const ElementQuality quality = element_quality(mesh);
    EXPECT_NEAR(quality.area, area, area * exact);
    const int sides = material == 0 ? 2 : 1;
    EXPECT_EQ(quality.elements * sides, mesh.element_count());
    EXPECT_EQ(quality.patches * sides, mesh.patch_count());
    EXPECT_DOUBLE_EQ(quality.least_angle_degrees, smallest_angle(mesh));
    EXPECT_EQ(mesh.element_area[quality.smallest], mesh.element_area.minCoeff());
    EXPECT_EQ(mesh.element_area[quality.largest], mesh.element_area.maxCoeff());
  }
}

TEST(ElementQuality, SharesCountNeedles) {
  Scene scene = empty_scene();
  const auto add_needle = [&scene](double z, double degrees) {
    add_polygon(scene, "needle",
                {{0, 0, z}, {1, 0, z}, {1, std::tan(degrees * std::numbers::pi / 180.0), z}}, {},
                1);
  };
  for (const double degrees : {5.0, 15.0, 15.5, 40.0}) add_needle(degrees, degrees);
  const ElementQuality quality =
      element_quality(build_patches(scene, {.max_patch_size = 10.0, .elements_per_patch_edge = 1}));
  ASSERT_EQ(quality.elements, 4);
  EXPECT_DOUBLE_EQ(quality.below_10_degrees, 0.25);
  EXPECT_DOUBLE_EQ(quality.below_20_degrees, 0.75);
  EXPECT_NEAR(quality.least_angle_degrees, 5.0, 5.0 * exact);
}

}  // namespace
}  // namespace lightwell::element_quality_test
