#include "raytrace/camera_ray.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

#include "scene/errors.h"

namespace lightwell {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

TEST(CameraRays, WorldXIsOnTheLeftWhenLookingAlongZWithYUp) {
  const CameraRays rays({.width = 4, .height = 2});
  EXPECT_GT(rays.ray(0, 1).direction.x(), 0.0);
  EXPECT_LT(rays.ray(4, 1).direction.x(), 0.0);
  EXPECT_GT(rays.ray(2, 0).direction.y(), 0.0);  // row 0 is the top
  EXPECT_LT(rays.ray(2, 2).direction.y(), 0.0);
}

TEST(CameraRays, CentreOfThePictureIsTheViewDirection) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -0.5).normalized();
  const Eigen::Vector3d up = direction.cross(Eigen::Vector3d::UnitX()).normalized();
  const CameraRays rays(
      {.position = {5, 6, 7}, .direction = direction, .up = up, .width = 64, .height = 48});
  const Ray ray = rays.ray(32, 24);
  EXPECT_LT((ray.direction - direction).norm(), 1e-14);
  EXPECT_EQ(ray.origin, Eigen::Vector3d(5, 6, 7));
}

TEST(CameraRays, HorizontalEdgesSpanTheFieldOfView) {
  for (const double fov : {5.0, 39.307652, 90.0, 150.0}) {
    const CameraRays rays({.fov_degrees = fov, .width = 320, .height = 200});
    EXPECT_NEAR(degrees_between(rays.ray(0, 100).direction, rays.ray(320, 100).direction), fov,
                1e-10);
  }
}

TEST(CameraRays, PixelCentresAreEvenlySpacedOnThePlane) {
  // At distance 1 pixel centre i lies at tan(fov/2) (1 - (2 i + 1) / n).
  const CameraRays rays({.fov_degrees = 90.0, .width = 5, .height = 3});
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 3; ++y) {
      const Eigen::Vector3d d = rays.ray(x + 0.5, y + 0.5).direction;
      EXPECT_NEAR(d.x() / d.z(), 1.0 - (2 * x + 1) / 5.0, 1e-14);
      EXPECT_NEAR(d.y() / d.z(), (1.0 - (2 * y + 1) / 3.0) * 3.0 / 5.0, 1e-14);  // square pixels
    }
  }
}

TEST(CameraRays, ImpossibleCamerasAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CameraRays({.width = 0}), InputError);
  EXPECT_THROW(CameraRays({.height = -1}), InputError);
  EXPECT_THROW(CameraRays({.width = 100000, .height = 100000}), InputError);
  EXPECT_THROW(CameraRays({.fov_degrees = 180.0}), InputError);
  EXPECT_THROW(CameraRays({.fov_degrees = nan}), InputError);
  EXPECT_THROW(CameraRays({.position = {0, nan, 0}}), InputError);
  EXPECT_THROW(CameraRays({.direction = {0, 0, 2}}), InputError);
  EXPECT_THROW(CameraRays({.direction = {0, 0.6, 0.8}}), InputError);  // not at right angles to up
}

}  // namespace
}  // namespace lightwell
