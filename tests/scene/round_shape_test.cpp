#include "scene/round_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/errors.h"

namespace lightwell::round_shape_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A few products and roots of doubles, as a share of the result.
constexpr double rounding = 16 * 0x1p-53;  // 1.8e-15

// Sixteen roundings of coordinates below 4 m.
constexpr double place_rounding = 16 * 0x1p-53 * 4.0;  // 7.1e-15 m

Frustum turned_cone() {
  return {.base = {1, 2, 3},
          .axis = Vector3d(1, -2, 2) / 3.0,
          .height = 0.8,
          .base_radius = 0.5,
          .top_radius = 0.2};
}

Vector3d point_on(const Frustum& f, double phi, double along) {
  const LongitudeFrame frame = longitudes(f);
  return f.base + along * f.height * f.axis +
         radius_at(f, along) * (std::cos(phi) * frame.zero + std::sin(phi) * frame.quarter);
}

TEST(RoundShape, AreasAreThoseOfTheBook) {
  EXPECT_NEAR(area(Sphere{.radius = 2.0}), 16.0 * pi, 16.0 * pi * rounding);
  const double cylinder = area(Frustum{.height = 3.0, .base_radius = 0.5, .top_radius = 0.5});
  EXPECT_NEAR(cylinder, 3.0 * pi, 3.0 * pi * rounding);
  const double cone = area(Frustum{.height = 4.0, .base_radius = 3.0, .top_radius = 0.0});
  EXPECT_NEAR(cone, 15.0 * pi, 15.0 * pi * rounding);
  const double ring = area(Frustum{.height = 0.0, .base_radius = 2.0, .top_radius = 1.0});
  EXPECT_NEAR(ring, 3.0 * pi, 3.0 * pi * rounding);
}

TEST(RoundShape, ReachIsThatOfItsFarthestPoint) {
  for (const bool flat : {false, true}) {
    Frustum f = turned_cone();
    if (flat) f.height = 0.0;
    for (const Vector3d& way : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0.6, 0, -0.8)}) {
      double farthest = -1e9;
      constexpr int steps = 3600;
      for (int i = 0; i < steps; ++i) {
        for (const double along : {0.0, 1.0}) {
          farthest = std::max(farthest, way.dot(point_on(f, 2.0 * pi * i / steps, along)));
        }
      }
      // Half a step of 1.7e-3 rad lies below the top of a circle by r (1 - cos), 1.9e-7.
      const double below_top = f.base_radius * (1.0 - std::cos(pi / steps));
      EXPECT_NEAR(reach(f, way), farthest, below_top + place_rounding);
    }
  }
}

TEST(RoundShape, NearestPointLiesAlongTheNormal) {
  Frustum f = turned_cone();
  for (const bool inward : {false, true}) {
    f.inward = inward;
    for (double phi = 0.1; phi < 6.0; phi += 0.7) {
      for (const double along : {0.0, 0.3, 1.0}) {
        const Vector3d on = point_on(f, phi, along), normal = front_normal(f, on);
        EXPECT_NEAR(normal.norm(), 1.0, rounding);
        for (const double off : {-0.05, 0.05}) {
          EXPECT_NEAR((nearest_on(f, on + off * normal) - on).norm(), 0.0, place_rounding);
        }
        // The front is away from the axis unless turned inward.
        const Vector3d from_axis = (on - f.base) - (on - f.base).dot(f.axis) * f.axis;
        EXPECT_EQ(normal.dot(from_axis) > 0.0, !inward);
      }
    }
  }
}

TEST(RoundShape, ARingFacesAlongItsAxisFromItsOuterCircle) {
  Frustum ring{.height = 0.0, .base_radius = 1.0, .top_radius = 0.3};
  EXPECT_EQ(front_normal(ring, {0.5, 0, 0}), Vector3d::UnitZ());
  ring.inward = true;
  EXPECT_EQ(front_normal(ring, {0.5, 0, 0}), -Vector3d::UnitZ());
}

TEST(RoundShape, FrustumsWithoutAreaAreRefused) {
  Scene scene;
  scene.materials.push_back({.reflectance = Spectrum::Zero(3),
                             .specular = Spectrum::Zero(3),
                             .emission = Spectrum::Zero(3)});
  const auto with = [&](const Frustum& frustum) {
    scene.surfaces = {{.name = "leg", .shape = frustum}};
    validate(scene);
  };
  EXPECT_NO_THROW(with({}));
  EXPECT_NO_THROW(with({.height = 0.0, .base_radius = 1.0, .top_radius = 0.0}));
  EXPECT_THROW(with({.height = 0.0}), InputError);
  EXPECT_THROW(with({.base_radius = 0.0, .top_radius = 0.0}), InputError);
  EXPECT_THROW(with({.base_radius = -1.0}), InputError);
  EXPECT_THROW(with({.height = std::nan("")}), InputError);
  EXPECT_THROW(with({.axis = {0, 0, 2}}), InputError);
}

}  // namespace
}  // namespace lightwell::round_shape_test
