#include "standards/road/road_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/standards/road/road_of_lamps.h"

namespace lightwell::road_light_test {
namespace {

using Eigen::Vector3d;

// The one luminaire at x = 0, y = 0.
RoadLight one_lamp(const Road& road) {
  return {road, -1.0, 1.0};
}

constexpr double rounding = 1e-12;

/// L = I r / H^2 with entries of R3, I = 1000 cd, H = 8 m: light from beyond the point (beta 0, tan
/// 2), from behind the eye (beta 180, tan 2), from the side (beta 90, tan 1).
TEST(RoadLight, OfALampIsIntensityTimesTheEntryOverTheSquareOfItsHeight) {
  const Road road = road_of_even_lamps();
  const RoadLight light = one_lamp(road);
  const auto seen = [&](const Vector3d& point) {
    return light.luminance(road.surface, point, {-60.0, point.y(), 1.5});
  };
  EXPECT_NEAR(seen({-16.0, 0.0, 0.0}), 1000.0 * 326e-4 / 64.0, rounding);
  EXPECT_NEAR(seen({16.0, 0.0, 0.0}), 1000.0 * 38e-4 / 64.0, rounding);
  EXPECT_NEAR(seen({0.0, 8.0, 0.0}), 1000.0 * 100e-4 / 64.0, rounding);
  // 5 heights are 40 m, 12 heights 96 m.
  EXPECT_EQ(seen({41.0, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(light.luminance(road.surface, {-95.0, 0.0, 0.0}, {-155.0, 0.0, 1.5}),
              1000.0 * (0.75 * 53e-4 + 0.25 * 56e-4) / 64.0, rounding);
  EXPECT_EQ(light.luminance(road.surface, {-97.0, 0.0, 0.0}, {-157.0, 0.0, 1.5}), 0.0);
}

/// E = I H / d^3; upright: E_v = I cos / d^2 by the horizontal share of the way, here 6 of 10 from
/// a face 1.5 m high below a lamp 9.5 m high; E_sc of a face towards the light is 2 / pi of that.
TEST(RoadLight, OnLevelAndUprightFacesFollowsTheCosines) {
  Road road = road_of_even_lamps();
  EXPECT_NEAR(one_lamp(road).illuminance({6.0, 0.0, 0.0}), 1000.0 * 8.0 / 1000.0, rounding);
  EXPECT_EQ(one_lamp(road).illuminance({40.1, 0.0, 0.0}), 0.0);
  road.luminaires.height = 9.5;
  const RoadLight light = one_lamp(road);
  const Vector3d face(-6.0, 0.0, 1.5), towards = Vector3d::UnitX();
  EXPECT_NEAR(light.vertical(face, towards), 1000.0 * 0.6 / 100.0, rounding);
  EXPECT_EQ(light.vertical(face, -towards), 0.0);
  EXPECT_NEAR(light.semicylindrical(face, towards), 2.0 / std::numbers::pi * 6.0, rounding);
  EXPECT_NEAR(light.semicylindrical(face, Vector3d::UnitY()), 1.0 / std::numbers::pi * 6.0,
              rounding);
  EXPECT_NEAR(light.semicylindrical(face, -towards), 0.0, rounding);
}

/// An eye 17.875 m before the lamp and 6.5 m below: it stands 19.9831 degrees high, 20.9831 from
/// the line of sight. E = 1000 cos(20.9831) / 361.766 = 2.58091 lx, L_v = 10.00194 E / 20.9831^2 =
/// 0.0586298 cd/m^2. f_TI = 65 L_v / 0.5^0.8, 95 L_v / 10^1.05. Seven digits stand here.
TEST(RoadLight, VeilsAsTheFormulaDoes) {
  const RoadLight light = one_lamp(road_of_even_lamps());
  const double veil = light.veiling_luminance({-17.875, 0.0, 1.5}, 1.0);
  EXPECT_NEAR(veil, 0.0586298, 1e-6 * veil);
  EXPECT_NEAR(light.veiling_luminance({17.875, 0.0, 1.5}, -1.0), veil, 1e-12 * veil);
  EXPECT_NEAR(threshold_increment(veil, 0.5), 6.635227, 1e-5);
  EXPECT_NEAR(threshold_increment(veil, 10.0), 0.4964117, 1e-6);
  // Above the screen of 20 degrees, behind the eye, and farther away than 500 m.
  EXPECT_EQ(light.veiling_luminance({-17.8, 0.0, 1.5}, 1.0), 0.0);
  EXPECT_EQ(light.veiling_luminance({17.875, 0.0, 1.5}, 1.0), 0.0);
  EXPECT_EQ(light.veiling_luminance({-501.0, 0.0, 1.5}, 1.0), 0.0);
}

/// Near the line of sight: a lamp 4 m high, 2.5 m above an eye 400 m before it, is atan(2.5 / 400)
/// and 1 degree off, 1.3580940 degrees. E = 1000 cos(theta) / 160006.25 = 6.2480003e-3 lx, and L_v
/// = (10 / theta^3 + 5.0917018 / theta^2) E = 0.042191378 cd/m^2. Seven digits stand here. Lamps 1
/// m below the eye, 50 m ahead, are 0.146 degrees off, and those 55 m ahead 0.042, where none
/// counts.
TEST(RoadLight, VeilsNearTheLineOfSight) {
  Road road = road_of_even_lamps();
  road.luminaires.height = 4.0;
  const double veil = one_lamp(road).veiling_luminance({-400.0, 0.0, 1.5}, 1.0);
  EXPECT_NEAR(veil, 0.042191378, 1e-7 * veil);
  road.luminaires.height = 0.5;
  EXPECT_GT(one_lamp(road).veiling_luminance({-50.0, 0.0, 1.5}, 1.0), 0.0);
  EXPECT_EQ(one_lamp(road).veiling_luminance({-55.0, 0.0, 1.5}, 1.0), 0.0);
}

/// A lamp at the height of the eye, 10 m ahead and y to the side, is theta off, with cos theta =
/// cos(1) 10 / sqrt(100 + y^2): 59.96 degrees for y = 17.3 m, and 60.04 for 17.36 m.
TEST(RoadLight, VeilsUpToSixtyDegrees) {
  Road road = road_of_even_lamps();
  road.luminaires.height = 1.5;
  EXPECT_GT(one_lamp(road).veiling_luminance({-10.0, 17.3, 1.5}, 1.0), 0.0);
  EXPECT_EQ(one_lamp(road).veiling_luminance({-10.0, 17.36, 1.5}, 1.0), 0.0);
}

/// A luminaire with light in the plane C90 alone, at 45 degrees, lights the point across the road;
/// turned about its street side by 90 degrees it lights along; tilted by 45 degrees it lights
/// straight ahead, above the road.
TEST(RoadLight, FacesTheRoadWithItsStreetSide) {
  auto file = std::make_shared<LuminaireFile>();
  Eigen::ArrayXXd cd = Eigen::ArrayXXd::Zero(4, 5);
  cd(1, 2) = 100.0;
  file->web =
      std::make_shared<const PhotometricWeb>(std::vector<double>{0.0, 90.0, 180.0, 270.0},
                                             std::vector<double>{0.0, 40.0, 45.0, 50.0, 90.0}, cd);
  Road road = road_of_even_lamps();
  road.luminaires.file = file;
  const double lux = 100.0 * 8.0 / std::pow(2.0 * 64.0, 1.5);
  EXPECT_NEAR(one_lamp(road).illuminance({0.0, 8.0, 0.0}), lux, rounding);
  EXPECT_NEAR(one_lamp(road).illuminance({8.0, 0.0, 0.0}), 0.0, rounding);
  road.luminaires.arrangement = RoadArrangement::single_left;
  EXPECT_NEAR(one_lamp(road).illuminance({0.0, 7.0 - 8.0, 0.0}), lux, rounding);
  road.luminaires.arrangement = RoadArrangement::single_right;
  road.luminaires.street_side = 0.0;  // C90 lies to the left of C0 seen from above
  EXPECT_NEAR(one_lamp(road).illuminance({-8.0, 0.0, 0.0}), lux, rounding);
  road.luminaires.street_side = 90.0;
  road.luminaires.tilt = 45.0;
  EXPECT_NEAR(one_lamp(road).illuminance({0.0, 8.0, 0.0}), 0.0, rounding);
  EXPECT_NEAR(one_lamp(road).vertical({0.0, 8.0, 8.0}, -Vector3d::UnitY()), 100.0 / 64.0, rounding);
}

}  // namespace
}  // namespace lightwell::road_light_test
