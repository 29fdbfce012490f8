#include "daylight/room_hours.h"

#include <gtest/gtest.h>

#include <vector>

namespace lightwell::room_hours_test {

// Three sensors of which the last two are the room, over four hours, lx:
//
//     0    0    0    0
//   300  400  500   80
//   300  110   90   90      means 300, 255, 295, 85
TEST(RoomHours, CountTheMeanAndThePointThatHasFewest) {
  const std::vector<SkyHour> hours = {{.number = 3}, {.number = 8}, {.number = 9}, {.number = 23}};
  HourBlock light{.hours = hours};
  light.total.resize(3, 4);
  light.total << 0, 0, 0, 0, 300, 400, 500, 80, 300, 110, 90, 90;
  light.sunlight = Eigen::ArrayXXf::Zero(3, 4);
  RoomHours count({.first = 1, .count = 2}, {.mean = 250.0, .point = 90.0});
  count.add(light);
  EXPECT_EQ(count.mean_hours(), 3);
  // The first of them lacks the last hour; the second has all four.
  EXPECT_EQ(count.point_hours(), 3);
  // Nine tenths of the light: means 270, 229.5, 265.5, 76.5, and 81 lx in two hours of the second.
  RoomHours less({.first = 1, .count = 2}, {.mean = 250.0, .point = 90.0});
  less.add(light, std::vector<float>(4, 0.9f));
  EXPECT_EQ(less.mean_hours(), 2);
  EXPECT_EQ(less.point_hours(), 2);
}

}  // namespace lightwell::room_hours_test
