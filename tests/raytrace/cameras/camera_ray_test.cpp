#include "raytrace/cameras/camera_ray.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

#include "scene/errors.h"

namespace lightwell::camera_ray_test {
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

TEST(CameraRays, RaysOfALensMeetWhereItIsFocused) {
  const Camera camera{.position = {1, 2, 3},
                      .fov_degrees = 60.0,
                      .width = 40,
                      .height = 30,
                      .lens_radius = 0.05,
                      .focus_distance = 2.5};
  const CameraRays rays(camera);
  for (const double x : {0.0, 11.5, 40.0}) {
    const Ray through_centre = rays.ray(x, 7);
    const Eigen::Vector3d sharp =
        camera.position + through_centre.direction * (2.5 / through_centre.direction.z());
    for (const double u : {0.1, 0.5, 0.93}) {
      const Ray ray = rays.ray(x, 7, u, 0.3);
      const Eigen::Vector3d at = ray.origin + ray.direction * (2.5 / ray.direction.z());
      EXPECT_LT((at - sharp).norm(), 1e-12);
      EXPECT_LE((ray.origin - camera.position).norm(), 0.05 + 1e-12);
      EXPECT_NEAR(ray.origin.z(), 3.0, 1e-12);
    }
  }
}

// A regular polygon of n sides in the unit circle has, about an axis in its plane, a second moment
// over its area of (1 + 2 cos^2(pi/n)) / 12; the disk has 1/4.
TEST(CameraRays, ALensIsEvenlyCoveredWhateverItsBlades) {
  constexpr int steps = 64;
  for (const int blades : {0, 3, 5, 8}) {
    const CameraRays rays({.lens_radius = 1.0, .blades = blades});
    Eigen::Vector2d mean = Eigen::Vector2d::Zero(), square = mean;
    for (int i = 0; i < steps * steps; ++i) {
      const double u = (i % steps + 0.5) / steps, v = (i / steps + 0.5) / steps;
      const Eigen::Vector2d p = rays.ray(1, 1, u, v).origin.head<2>();
      mean += p / (steps * steps);
      square += p.cwiseAbs2() / (steps * steps);
      EXPECT_LE(p.norm(), 1.0 + 1e-6);
    }
    const double c = blades > 0 ? std::cos(std::numbers::pi / blades) : 1.0;
    // The midpoint rule has an error of about a step squared for functions this smooth; if the
    // number of blades does not divide that of steps, a step of a blade's share is added.
    EXPECT_LT(mean.norm(), 1.0 / steps) << blades;
    EXPECT_NEAR(square.x(), (1 + 2 * c * c) / 12, 1.0 / steps) << blades;
    EXPECT_NEAR(square.y(), (1 + 2 * c * c) / 12, 1.0 / steps) << blades;
  }
}

TEST(CameraRays, ImpossibleLensesAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CameraRays({.lens_radius = -0.1}), InputError);
  EXPECT_THROW(CameraRays({.lens_radius = nan}), InputError);
  EXPECT_THROW(CameraRays({.lens_radius = 0.1, .focus_distance = 0.0}), InputError);
  EXPECT_THROW(CameraRays({.lens_radius = 0.1, .focus_distance = nan}), InputError);
  EXPECT_THROW(CameraRays({.lens_radius = 0.1, .blades = 2}), InputError);
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
}  // namespace lightwell::camera_ray_test
