// Projections of cameras: places of the picture, rays and solid angles of pixels.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/cameras/lens_distortion.h"
#include "raytrace/cameras/pixel_solid_angle.h"
#include "scene/degree.h"
#include "scene/errors.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::projections_test {
namespace {

using std::numbers::pi;

// A camera that looks askew, so that no axis is favoured.
Camera askew(Projection projection, int width, int height) {
  Camera camera{.name = "askew",
                .position = {1, 2, 3},
                .direction = Eigen::Vector3d(1, 2, -0.5).normalized(),
                .fov_degrees = named(projection).usual,
                .width = width,
                .height = height,
                .projection = projection,
                .view_width = 3.0};
  camera.up = camera.direction.cross(Eigen::Vector3d::UnitX()).normalized();
  return camera;
}

double sum_of_solid_angles(const Camera& camera) {
  double sum = 0.0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) sum += pixel_solid_angle(camera, x, y);
  }
  return sum;
}

struct Case {
  std::string name;
  Camera camera;
};

std::vector<Case> all_cameras() {
  std::vector<Case> cases;
  for (const NamedProjection& kind : named_projections) {
    cases.push_back({std::string(kind.name),
                     with_projection(askew(Projection::perspective, 96, 96), kind.projection)});
  }
  Camera shifted = askew(Projection::perspective, 90, 60);
  shifted.shift = {0.3, -0.7};
  cases.push_back({"shift", shifted});
  Camera window = askew(Projection::equidistant, 80, 80);
  window.window = {.left = 0.25, .top = 0.1, .right = 0.75, .bottom = 0.4};
  set_picture_size(80, 80, window);
  cases.push_back({"window", window});
  Camera distorted = askew(Projection::perspective, 90, 60);
  distorted.fov_degrees = 80.0;
  distorted.distortion = {.k1 = -0.21, .k2 = 0.05, .k3 = -0.004, .p1 = 0.003, .p2 = -0.002};
  distorted.shift = {0.0, 0.1};
  cases.push_back({"distortion", distorted});
  Camera pincushion = distorted;
  pincushion.distortion = {.k1 = 0.3, .k2 = 0.1};
  cases.push_back({"pincushion", pincushion});
  Camera full = askew(Projection::equisolid, 90, 60);
  full.circle_degrees = 360.0;
  full.shift = {0.1, 0.2};
  full.near_distance = 0.4;
  cases.push_back({"full frame", full});
  return cases;
}

TEST(Projections, RaysLeadBackToTheirPicturePoint) {
  for (const auto& [name, camera] : all_cameras()) {
    const CameraRays rays(camera);
    int seen = 0;
    for (int i = 0; i < 400; ++i) {
      // Points of a lattice that meets neither seams nor edges.
      const double x = camera.width * (std::fmod(0.6180339887 * i, 1.0) * 0.98 + 0.01);
      const double y = camera.height * (std::fmod(0.7548776662 * i, 1.0) * 0.98 + 0.01);
      const int panel = rays.panel_at(x, y);
      const auto ray = rays.ray_at(x, y, panel);
      if (!ray) continue;
      ++seen;
      EXPECT_NEAR(ray->direction.norm(), 1.0, 1e-14);
      const auto back = rays.picture_point(ray->origin + 2.5 * ray->direction, panel);
      ASSERT_TRUE(back) << name << " at " << x << ", " << y;
      // Rounding of the place, 1e-15, and of the inverse of distortion, 1e-13, in pixels of at
      // least 0.01 of the plane's lengths; asin and acos near the edge of a fisheye's circle lose
      // half of the digits at most within a thousandth of the edge.
      EXPECT_LT((*back - Eigen::Vector2d(x, y)).norm(), 1e-8) << name << " at " << x << ", " << y;
    }
    EXPECT_GT(seen, 200) << name;
  }
}

TEST(Projections, AWindowAndASizeShowTheSame) {
  for (const Projection projection : {Projection::perspective, Projection::stereographic,
                                      Projection::cylindrical, Projection::orthographic}) {
    Camera whole = askew(projection, 120, 80);
    if (projection != Projection::perspective) whole.shift = {0.1, -0.2};
    Camera part = whole;
    part.window = {.left = 0.25, .top = 0.5, .right = 0.6, .bottom = 0.75};
    set_picture_size(120, 80, part);
    ASSERT_EQ(part.width, 42);
    ASSERT_EQ(part.height, 20);
    const CameraRays of_whole(whole), of_part(part);
    const Ray a = of_whole.ray(30 + 7.25, 40 + 11.5), b = of_part.ray(7.25, 11.5);
    // Sums of lengths below ten have an error of 1e-15 each.
    EXPECT_LT((a.direction - b.direction).norm(), 1e-13);
    EXPECT_LT((a.origin - b.origin).norm(), 1e-13);
  }
}

TEST(Projections, WindowsDrawTheWholePictureOfAPart) {
  Camera part = askew(Projection::perspective, 512, 384);
  part.window = {.left = 0.25, .top = 0.5, .right = 0.75, .bottom = 0.75};
  set_picture_size(512, 384, part);
  const Camera shown = for_window(part);
  EXPECT_EQ(shown.width, 512);
  EXPECT_EQ(shown.height, 384);
  EXPECT_EQ(shown.window.right, 1.0);
  EXPECT_EQ(shown.fov_degrees, part.fov_degrees);
}

// A pixel at the rim of a fisheye that sees all around has its centre beyond the circle.
TEST(Projections, ConesAtTheRimOfAFisheyeAreFinite) {
  Camera camera = askew(Projection::equidistant, 31, 31);
  camera.fov_degrees = 360.0;
  const CameraRays rays(camera);
  for (int y = 0; y < 31; ++y) {
    for (int x = 0; x < 31; ++x) {
      EXPECT_TRUE(std::isfinite(rays.cone(x + 0.5, y + 0.5, 0).spread)) << x << ", " << y;
    }
  }
}

TEST(Projections, FisheyesFollowTheirFormula) {
  const auto expected = [](Projection projection, double theta) {
    if (projection == Projection::equidistant) return theta / (pi / 2);
    if (projection == Projection::equisolid) return std::sin(theta / 2) / std::sin(pi / 4);
    if (projection == Projection::hemispherical) return std::sin(theta);
    return std::tan(theta / 2);  // over tan 45 degrees
  };
  for (const Projection projection : {Projection::equidistant, Projection::equisolid,
                                      Projection::hemispherical, Projection::stereographic}) {
    const Camera camera = askew(projection, 100, 100);
    const CameraRays rays(camera);
    const Eigen::Vector3d right = camera.direction.cross(camera.up);
    for (const double theta : {0.0, 0.1, 0.7, 1.3}) {
      const Eigen::Vector3d way =
          std::cos(theta) * camera.direction + std::sin(theta) * (0.6 * right + 0.8 * camera.up);
      const auto at = rays.picture_point(camera.position + way);
      ASSERT_TRUE(at);
      const double radius = 50.0 * expected(projection, theta);
      // Pixels of 1/50 of the circle times rounding.
      EXPECT_NEAR(at->x(), 50 + 0.6 * radius, 1e-11);
      EXPECT_NEAR(at->y(), 50 - 0.8 * radius, 1e-11);
    }
    EXPECT_FALSE(rays.ray_at(1, 1)) << "a corner is outside of the circle";
  }
}

TEST(Projections, SolidAnglesOfAFisheyeAddUpToItsCap) {
  // The edges that two pixels share cancel, up to the rounding of 4 n^2 numbers below 1: 1e-12.
  for (const Projection projection : {Projection::equidistant, Projection::equisolid,
                                      Projection::hemispherical, Projection::stereographic}) {
    for (const int size : {60, 61}) {
      EXPECT_NEAR(sum_of_solid_angles(askew(projection, size, size)), 2 * pi, 1e-11);
    }
  }
  for (const double fov : {90.0, 250.0, 360.0}) {
    Camera camera = askew(Projection::equisolid, 50, 50);
    camera.fov_degrees = fov;
    EXPECT_NEAR(sum_of_solid_angles(camera), 2 * pi * (1 - std::cos(0.5 * fov * degree)), 1e-11);
  }
}

TEST(Projections, SolidAnglesOfPanoramasAndCubesAddUpToTheSphere) {
  // Sums of n^2 numbers of rounding 1e-16 times their size.
  EXPECT_NEAR(sum_of_solid_angles(askew(Projection::equirectangular, 128, 64)), 4 * pi, 1e-11);
  EXPECT_NEAR(sum_of_solid_angles(askew(Projection::stereo_panorama, 64, 64)), 8 * pi, 1e-11);
  EXPECT_NEAR(sum_of_solid_angles(askew(Projection::cube_map, 48, 32)), 4 * pi, 1e-11);
  // A cylinder of 360 degrees is 2 tan e high in units in which it is 2 pi wide.
  Camera cylinder = askew(Projection::cylindrical, 120, 40);
  cylinder.fov_degrees = 360.0;
  EXPECT_NEAR(sum_of_solid_angles(cylinder), 4 * pi * std::sin(std::atan(pi / 3)), 1e-11);
}

TEST(Projections, SolidAnglesOfAPerspectiveAddUpToItsPyramid) {
  Camera camera = askew(Projection::perspective, 60, 30);
  camera.fov_degrees = 90.0;
  // 4 atan(a b / sqrt(1 + a^2 + b^2)) of the half width a = 1 and the half height b = 1/2.
  EXPECT_NEAR(sum_of_solid_angles(camera), 4 * std::atan(0.5 / std::sqrt(2.25)), 1e-12);
  EXPECT_EQ(sum_of_solid_angles(askew(Projection::orthographic, 8, 8)), 0.0);
}

TEST(Projections, SolidAnglesAreThoseOfTheDensity) {
  // The density at a pixel's centre times its area: the second derivative over a pixel of edge h
  // is an error of about h^2 / 24 times a curvature of the density below 4, relative to a density
  // of at least 0.1 within the picture's inner half.
  for (const NamedProjection& kind : named_projections) {
    if (kind.projection == Projection::orthographic) continue;
    const Camera camera =
        with_projection(askew(Projection::perspective, 240, 240), kind.projection);
    const PicturePlane plane(camera);
    const int x = camera.width / 2 + 31, y = camera.height / 2 - 17;
    const double density =
        plane.solid_angle_density(plane.place(x + 0.5, y + 0.5, plane.panel_at(x + 0.5, y + 0.5)));
    const double h = plane.pixel();
    EXPECT_NEAR(pixel_solid_angle(camera, x, y) / (h * h), density, 4 * h * h) << kind.name;
  }
}

TEST(Projections, OrthographicRaysAreParallelAndItsPictureHasItsSize) {
  Camera camera = askew(Projection::orthographic, 60, 40);
  camera.near_distance = 0.5;
  const CameraRays rays(camera);
  const Ray left = rays.ray(0, 20), right = rays.ray(60, 20), top = rays.ray(30, 0);
  EXPECT_LT((left.direction - camera.direction).norm(), 1e-15);
  EXPECT_NEAR((right.origin - left.origin).norm(), 3.0, 1e-14);
  EXPECT_NEAR((top.origin - rays.ray(30, 40).origin).norm(), 2.0, 1e-14);
  EXPECT_NEAR((top.origin - camera.position).dot(camera.direction), 0.5, 1e-14);
  EXPECT_GT((right.origin - left.origin).dot(camera.direction.cross(camera.up)), 0.0);
  const PixelCone cone = rays.cone(30, 20, 0);
  EXPECT_DOUBLE_EQ(cone.start, 3.0 / 60);
  EXPECT_EQ(cone.spread, 0.0);
}

TEST(Projections, AShiftKeepsVerticalsParallel) {
  // A level camera: the top and the foot of a post are above each other however far it is shifted.
  Camera camera{.position = {0, 1, 0}, .fov_degrees = 70.0, .width = 300, .height = 300};
  for (const double shift : {0.0, 0.4, 2.0}) {
    camera.shift = {0.0, shift};
    const CameraRays rays(camera);
    const auto foot = rays.picture_point({1.3, 0, 5}), top = rays.picture_point({1.3, 9, 5});
    ASSERT_TRUE(foot && top);
    // Places of pixels have an error of 1e-13 of a picture of 300.
    EXPECT_NEAR(foot->x(), top->x(), 1e-11);
    // Upwards: what is shown moves down by the share of the picture's height.
    EXPECT_NEAR(rays.picture_point({0, 1, 5})->y(), 150 + 300 * shift, 1e-11);
  }
}

TEST(Projections, CubeFacesMeetAtTheirEdges) {
  // To the right of the face ahead is the right one; above it the one above, upright.
  const Camera camera{.width = 48, .height = 32, .projection = Projection::cube_map};
  const CameraRays rays(camera);
  const auto direction = [&](double x, double y) { return rays.ray_at(x, y)->direction; };
  EXPECT_LT((direction(24, 8) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((direction(40, 8) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);  // right of +z is -x
  EXPECT_LT((direction(8, 8) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((direction(8, 24) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((direction(24, 24) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((direction(40, 24) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);
  const auto same = [&](double x, double y, int panel, double u, double v, int other) {
    EXPECT_LT((rays.ray_at(x, y, panel)->direction - rays.ray_at(u, v, other)->direction).norm(),
              1e-14);
  };
  same(32, 5, 1, 32, 5, 2);    // ahead and right
  same(16, 5, 0, 16, 5, 1);    // left and ahead
  same(20, 0, 1, 20, 32, 4);   // ahead and above
  same(20, 16, 1, 36, 16, 5);  // ahead and below
  same(48, 5, 2, 0, 21, 3);    // right and behind
}

TEST(Projections, EyesOfAStereoPanoramaAreBesideTheRay) {
  Camera camera = askew(Projection::stereo_panorama, 64, 64);
  camera.eye_separation = 0.1;
  const CameraRays rays(camera);
  for (const double x : {3.0, 20.0, 50.0}) {
    const Ray left = rays.ray(x, 20), right = rays.ray(x, 52);
    EXPECT_LT((left.direction - right.direction).norm(), 1e-15);
    const Eigen::Vector3d apart = right.origin - left.origin;
    EXPECT_NEAR(apart.norm(), 0.1, 1e-15);
    EXPECT_NEAR(apart.dot(left.direction), 0.0, 1e-15);
    EXPECT_NEAR(apart.dot(camera.up), 0.0, 1e-15);
    // The right eye is to the right: right is direction x up.
    EXPECT_GT(apart.dot(left.direction.cross(camera.up)), 0.0);
  }
}

TEST(Projections, NearAndFarCutRays) {
  Camera camera = askew(Projection::perspective, 10, 10);
  camera.near_distance = 2.0;
  camera.far_distance = 5.0;
  const Ray corner = CameraRays(camera).ray(0, 0);
  EXPECT_NEAR((corner.origin - camera.position).dot(camera.direction), 2.0, 1e-14);
  const Eigen::Vector3d end = corner.origin + corner.t_max * corner.direction;
  EXPECT_NEAR((end - camera.position).dot(camera.direction), 5.0, 1e-14);
  camera.projection = Projection::equidistant;
  const Ray ray = CameraRays(camera).ray(2, 3);
  EXPECT_NEAR((ray.origin - camera.position).norm(), 2.0, 1e-14);
  EXPECT_NEAR(ray.t_max, 3.0, 1e-14);
}

TEST(LensDistortion, InverseFindsThePointWhereverTheLensShowsOne) {
  const std::vector<LensDistortion> lenses = {
      {.k1 = -0.3},
      {.k1 = 0.5, .k2 = 0.2},
      {.k1 = -1.0, .k2 = 0.9},
      {.k1 = -0.2, .k2 = 0.05, .k3 = -0.01, .p1 = 0.01, .p2 = -0.02},
      {.p1 = 0.05, .p2 = 0.02}};
  for (const LensDistortion& lens : lenses) {
    const double fold = fold_radius(lens);
    const double far_out = std::min(0.98 * fold, 2.0);
    for (int i = 0; i < 200; ++i) {
      const double r = far_out * (i + 1) / 200.0, angle = 2.4 * i;
      const Eigen::Vector2d p(r * std::cos(angle), r * std::sin(angle));
      if (!(distortion_slope(lens, p).determinant() > 0.05)) continue;
      const auto back = undistorted(lens, distorted(lens, p), fold);
      ASSERT_TRUE(back) << "k1 " << lens.k1 << " at " << p.transpose();
      // The miss of 1e-13 (1 + |q|) over the least slope, about 0.02 in any direction.
      EXPECT_LT((*back - p).norm(), 2e-11) << "k1 " << lens.k1 << " at " << p.transpose();
    }
  }
}

TEST(LensDistortion, SlopeIsTheDerivative) {
  const LensDistortion lens{.k1 = -0.2, .k2 = 0.07, .k3 = -0.02, .p1 = 0.03, .p2 = -0.04};
  const Eigen::Vector2d p(0.6, -0.4);
  constexpr double h = 1e-5;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector2d slope = (distorted(lens, p + step) - distorted(lens, p - step)) / (2 * h);
    // Central differences: h^2 times a third derivative of about 1, and rounding 1e-16 / h.
    EXPECT_LT((slope - distortion_slope(lens, p).col(axis)).norm(), 1e-9);
  }
}

TEST(LensDistortion, BeyondTheFoldNothingIsShown) {
  // r (1 - 0.3 r^2) rises up to r = 1 / sqrt(0.9), where it is 2/3 r.
  const LensDistortion lens{.k1 = -0.3};
  const double fold = 1.0 / std::sqrt(0.9);
  EXPECT_NEAR(fold_radius(lens), fold, 1e-12);
  EXPECT_TRUE(undistorted(lens, {0.66 * fold, 0.0}, fold));
  EXPECT_FALSE(undistorted(lens, {0.67 * fold, 0.0}, fold));
  EXPECT_EQ(fold_radius({.k1 = 0.1}), std::numeric_limits<double>::infinity());
  Camera camera{.fov_degrees = 100.0, .width = 20, .height = 20, .distortion = lens};
  const CameraRays rays(camera);
  EXPECT_TRUE(rays.ray_at(10, 10));
  EXPECT_FALSE(rays.ray_at(0, 0));  // at tan 50 degrees sqrt 2 = 1.69
  EXPECT_FALSE(rays.picture_point({5, 0, 1}));
}

TEST(Projections, ImpossibleOnesAreRefused) {
  const auto refused = [](Camera camera, const std::string& why) {
    const std::string what = message_of<InputError>([&] { CameraRays rays(camera); });
    EXPECT_TRUE(says(what, why)) << what;
  };
  Camera camera{.name = "x"};
  camera.fov_degrees = 360.0;
  refused(camera, "a field of view of 360 degrees; it must lie between 0 and 180");
  camera.projection = Projection::hemispherical;
  refused(camera, "shows angles above 0 and up to 180");
  camera.projection = Projection::equirectangular;
  refused(camera, "there are 180; give at most 512 x 256");
  camera.projection = Projection::cube_map;
  refused(camera, "give 510 x 340");
  camera = {.name = "x", .projection = Projection::orthographic, .view_width = 0.0};
  refused(camera, "a view 0 m wide");
  camera = {.name = "x", .projection = Projection::stereo_panorama};
  camera.height = 255;
  refused(camera, "an even number");
  camera = {.name = "x", .lens_radius = 0.1, .projection = Projection::equidistant};
  refused(camera, "only perspective cameras have a lens");
  camera = {.name = "x", .projection = Projection::equidistant, .distortion = {.k1 = 0.1}};
  refused(camera, "only perspective cameras have one");
  camera = {.name = "x", .distortion = {.k1 = std::numeric_limits<double>::quiet_NaN()}};
  refused(camera, "a coefficient of distortion of nan");
  camera = {.name = "x", .near_distance = 2.0, .far_distance = 1.0};
  refused(camera, "the end must lie behind the beginning");
  camera = {.name = "x", .window = {.left = 0.5, .right = 0.5}};
  refused(camera, "in rising order");
  camera = {.name = "x", .circle_degrees = 90.0};
  refused(camera, "only fisheyes have one");
  camera = {.name = "x", .projection = Projection::cube_map, .shift = {0.1, 0.0}};
  camera.width = 48;
  camera.height = 32;
  refused(camera, "turn the camera instead");
}

}  // namespace
}  // namespace lightwell::projections_test
