#include "daylight/sun_exposure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "scene/errors.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::sun_exposure_test {
namespace {

using Eigen::Vector3d;

// Hours at points of the room with a window in its south wall, for a place on the equator.
Eigen::ArrayXd hours_at(const std::vector<Vector3d>& points, const ExposureDay& day) {
  DaylightOptions options{.sky_subdivision = 1, .direct_only = true};
  options.mesh.auto_patch_count = 100;
  const DaylightModel model(test::room_with_panes(1), Vector3d::UnitZ(), Vector3d::UnitY(),
                            options);
  return sun_exposure(model, Weather{}, points, day);
}

}  // namespace

// On the equator, a day after the equinox, the sun rises in the east, goes through the zenith by
// 360 degrees a day and sets in the west: half a day above the roof, 8 h above 30 degrees. The sun
// is 0.4 degrees from the equator, and the day differs from 24 h by seconds: two minutes.
TEST(SunExposure, OfTheEquatorIsHalfADay) {
  const std::vector<Vector3d> roof = {{2.0, 1.5, 5.0}};
  EXPECT_NEAR(hours_at(roof, {})[0], 12.0, 2.0 / 60.0);
  EXPECT_NEAR(hours_at(roof, {.least_altitude_degrees = 30.0})[0], 8.0, 2.0 / 60.0);
}

// In the room the sun of the equator's equinox, which goes from east to west, comes through no
// southern window; on 1 February (17 degrees south) it does, by way of the pane.
TEST(SunExposure, PanesPassTheSunAndWallsDoNot) {
  const std::vector<Vector3d> points = {{2.0, 0.1, 1.2}, {2.0, 1.5, 0.8}, {2.0, 0.2, 0.3}};
  const Eigen::ArrayXd equinox = hours_at(points, {});
  EXPECT_EQ(equinox.maxCoeff(), 0.0);
  const Eigen::ArrayXd february = hours_at(points, {.month = 2, .day = 1});
  // The first point is 0.1 m from the window. South of the zenith by at least 16.9 degrees, the sun
  // comes through it at most 0.1 / tan 16.9 = 0.33 m above and to either side of the point, where
  // the window reaches 0.8 m and 1 m: all of half a day, to two minutes.
  EXPECT_NEAR(february[0], 12.0, 2.0 / 60.0);
  EXPECT_EQ(february[2], 0.0);
}

TEST(SunExposure, DaysAreThoseOfEn17037) {
  const ExposureDay day = read_exposure_day("02-28");
  EXPECT_EQ(day.month, 2);
  EXPECT_EQ(day.day, 28);
  for (const char* const text : {"", "02-29", "01-31", "03-22", "3", "03-21-", "1e300-1"}) {
    EXPECT_THROW(read_exposure_day(text), InputError) << text;
  }
}

TEST(SunExposure, LevelsAreThoseOfEn17037) {
  EXPECT_EQ(exposure_level(1.49), "none");
  EXPECT_EQ(exposure_level(1.5), "minimum");
  EXPECT_EQ(exposure_level(3.0), "medium");
  EXPECT_EQ(exposure_level(4.0), "high");
}

}  // namespace lightwell::sun_exposure_test
