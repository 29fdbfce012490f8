#include "daylight/window_operation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "scene/errors.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::window_operation_test {
namespace {

using Eigen::Vector3d;

DaylightOptions direct_options() {
  DaylightOptions options{.sky_subdivision = 1, .direct_only = true};
  options.mesh.auto_patch_count = 100;
  return options;
}

// A model of the room with two panes, with sensors: one in the sun of pane 0, and `dark` ones.
DaylightModel room_of(const Scene& room) {
  return {room, Vector3d::UnitZ(), Vector3d::UnitY(), direct_options()};
}

std::vector<GatherPoint> one_in_the_sun(int dark) {
  std::vector<GatherPoint> sensors = {{.position = {1.5, 0.5, 0.8}}};
  for (int i = 0; i < dark; ++i) sensors.push_back({.position = {2.0, 2.5, 0.8}});
  return sensors;
}

// Suns due south, 45 degrees high: the first sensor sees them through pane 0, at x = 1.5 and z =
// 1.3.
std::vector<SkyHour> southern_suns(const std::vector<double>& lux) {
  std::vector<SkyHour> hours;
  for (const double sun_lux : lux) {
    hours.push_back({.number = 8 + static_cast<int>(hours.size()),
                     .sun = Vector3d(0.0, -1.0, 1.0).normalized(),
                     .altitude_degrees = 45.0,
                     .azimuth_degrees = 180.0,
                     .sun_lux = sun_lux,
                     .dome_lux = 1.0});
  }
  return hours;
}

Eigen::ArrayXXi states_for(int dark_sensors, const std::vector<double>& lux) {
  const Scene room = test::room_with_panes(2);
  const OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  DaylightModel model = room_of(room);
  const std::vector<GatherPoint> sensors = one_in_the_sun(dark_sensors);
  model.set_sensors(sensors);
  const std::vector<SkyHour> hours = southern_suns(lux);
  const SensorRange all{0, static_cast<Eigen::Index>(sensors.size())};
  return operate_windows(model, windows, {.hours = hours, .rooms = {&all, 1}});
}

}  // namespace

// One sensor of 49 is more than 2 %, and one of 50 is not. 2000 lx across the rays are 1414 lx on
// the sensor, 1000 lx are 707 lx. The sun is not seen through pane 1.
TEST(WindowOperation, Lm83ClosesThePaneThatTheSunComesThrough) {
  const Eigen::ArrayXXi few = states_for(48, {2000.0, 1000.0, 0.0});
  EXPECT_EQ(few.row(0).matrix(), Eigen::RowVector3i(1, 0, 0));
  EXPECT_EQ(few.row(1).maxCoeff(), 0);
  EXPECT_EQ(states_for(49, {2000.0}).maxCoeff(), 0);
}

// Rooms are judged one by one: 1 of 10 sensors in the one, none of 100 in the other.
TEST(WindowOperation, OneSunnyRoomIsEnough) {
  const Scene room = test::room_with_panes(2);
  const OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  DaylightModel model = room_of(room);
  model.set_sensors(one_in_the_sun(109));
  const std::vector<SkyHour> hours = southern_suns({2000.0});
  const std::vector<SensorRange> rooms = {{0, 10}, {10, 100}};
  EXPECT_EQ(operate_windows(model, windows, {.hours = hours, .rooms = rooms})(0, 0), 1);
  const std::vector<SensorRange> together = {{0, 110}};
  EXPECT_EQ(operate_windows(model, windows, {.hours = hours, .rooms = together})(0, 0), 0);
}

// Over black ground a vertical pane gets cos 45 = 0.707 of the sun's lux, and half a lux of the
// dome: it closes above 10000 lx, stays closed down to 5000 lx, and is open after a gap of the
// hours.
TEST(WindowOperation, IlluminanceHasTwoThresholds) {
  const Scene room = test::room_with_panes(1);
  OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  windows.groups[0].operation = WindowOperation::illuminance;
  windows.groups[0].close_above = 10000.0;
  windows.groups[0].open_below = 5000.0;
  const DaylightModel model = room_of(room);
  std::vector<SkyHour> hours =
      southern_suns({13000.0, 15000.0, 8000.0, 6000.0, 8000.0, 15000.0, 8000.0});
  hours.back().number += 10;
  const Eigen::ArrayXXi states =
      operate_windows(model, windows, {.hours = hours, .ground_reflectance = 0.0});
  const std::vector<int> expected = {0, 1, 1, 0, 0, 1, 0};
  for (std::size_t h = 0; h < expected.size(); ++h) {
    EXPECT_EQ(states(0, static_cast<Eigen::Index>(h)), expected[h]) << "hour " << h;
  }
}

TEST(WindowOperation, SchedulesAreFollowed) {
  const Scene room = test::room_with_panes(2);
  OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  for (WindowGroup& group : windows.groups) group.operation = WindowOperation::schedule;
  windows.groups[0].spans = {{.state = 1}, {.state = 0, .from_hour = 9, .to_hour = 10}};
  windows.groups[1].hours.assign(8760, 0);
  windows.groups[1].hours[10] = 1;
  const DaylightModel model = room_of(room);
  const std::vector<SkyHour> hours = southern_suns({1.0, 1.0, 1.0});  // from 8 h on
  const Eigen::ArrayXXi states = operate_windows(model, windows, {.hours = hours});
  EXPECT_EQ(states.row(0).matrix(), Eigen::RowVector3i(1, 0, 1));
  EXPECT_EQ(states.row(1).matrix(), Eigen::RowVector3i(0, 0, 1));
  EXPECT_THROW(operate_windows(model, windows, {.hours = hours, .is_leap_year = true}), InputError);
}

TEST(WindowOperation, AlwaysIsOneState) {
  const Scene room = test::room_with_panes(1);
  OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  windows.groups[0].operation = WindowOperation::always;
  const DaylightModel model = room_of(room);
  const std::vector<SkyHour> hours = southern_suns({1.0, 9000.0});
  EXPECT_EQ(operate_windows(model, windows, {.hours = hours}).minCoeff(), 1);
}

}  // namespace lightwell::window_operation_test
