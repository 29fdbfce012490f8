#include "daylight/annual_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell::annual_metrics_test {
namespace {

// Light in every hour from 6 to 18 h, brightest at noon, of every day.
std::vector<SkyHour> days() {
  std::vector<SkyHour> hours;
  for (int n = 0; n < 8760; ++n) {
    const int hour = n % 24;
    if (hour < 6 || hour >= 18) continue;
    hours.push_back({.number = n, .dome_lux = 10000.0 - 500.0 * std::abs(hour - 12)});
  }
  return hours;
}

// One block with the illuminance of each sensor as a function of the hour of the day.
template <class Lux>
HourBlock block(const std::vector<SkyHour>& hours, int sensors, Lux lux, float sunlight = 0.0f) {
  HourBlock light{.hours = hours};
  const auto count = static_cast<Eigen::Index>(hours.size());
  light.total.resize(sensors, count);
  light.sunlight = Eigen::ArrayXXf::Constant(sensors, count, sunlight);
  for (Eigen::Index h = 0; h < count; ++h) {
    for (int i = 0; i < sensors; ++i) {
      light.total(i, h) =
          static_cast<float>(lux(i, hours[static_cast<std::size_t>(h)].number % 24)) + sunlight;
    }
  }
  return light;
}

}  // namespace

// Occupied are 8 to 18 h: 10 of the 12 hours with light. The sensors have 50, 300 and 5000 lx in
// every hour, and one has 300 lx in the mornings (4 of 10 hours) and 150 lx after noon.
TEST(AnnualMetrics, CountHoursOfTheDay) {
  const std::vector<SkyHour> hours = days();
  AnnualMetrics metrics(4, hours, 8760, {});
  metrics.add(block(hours, 4, [](int sensor, int hour) {
    if (sensor == 3) return hour < 12 ? 300.0 : 150.0;
    return sensor == 0 ? 50.0 : sensor == 1 ? 300.0 : 5000.0;
  }));
  EXPECT_EQ(metrics.occupied_hours(), 3650);
  const SensorMetrics year = metrics.sensors();
  // Hours are whole numbers, and means of lux are exact. The rounding of the float E / 300 lx,
  // 2^-24, shows in per cent of continuous autonomy.
  constexpr double rounding = 100.0 / (1 << 24);
  const auto expect = [](const Eigen::ArrayXd& found, std::vector<double> expected) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(found[static_cast<Eigen::Index>(i)], expected[i], rounding) << "sensor " << i;
    }
  };
  expect(year.autonomy, {0.0, 100.0, 100.0, 40.0});
  expect(year.continuous_autonomy, {100.0 / 6.0, 100.0, 100.0, 70.0});
  expect(year.below_100, {100.0, 0.0, 0.0, 0.0});
  expect(year.from_100_to_300, {0.0, 0.0, 0.0, 60.0});
  expect(year.from_300_to_3000, {0.0, 100.0, 0.0, 40.0});
  expect(year.above_3000, {0.0, 0.0, 100.0, 0.0});
  expect(year.mean_lux, {25.0, 150.0, 2500.0, 112.5});
  // All 4380 hours with light are the brighter half of the year.
  expect(year.en_above_300, {0.0, 100.0, 100.0, 50.0});
  expect(year.en_above_100, {0.0, 100.0, 100.0, 100.0});
  // A median is known to a bin of the histogram: 1024 for the seven decades from 0.1 to 1e6 lx.
  const double bin = std::pow(10.0, 7.0 / 1024.0) - 1.0;
  EXPECT_NEAR(year.en_median_lux[2], 5000.0, bin * 5000.0);
  EXPECT_NEAR(year.en_median_lux[3], 300.0, bin * 300.0);
}

// 240 lx in every hour, and a quarter more: 300 lx.
TEST(AnnualMetrics, FactorScalesLightButSun) {
  const std::vector<SkyHour> hours = days();
  const HourBlock light = block(hours, 1, [](int, int) { return 240.0; });
  AnnualMetrics as_is(1, hours, 8760, {}), more(1, hours, 8760, {});
  as_is.add(light);
  more.add(light, std::vector<float>(hours.size(), 1.25f));
  EXPECT_EQ(as_is.sensors().autonomy[0], 0.0);
  EXPECT_EQ(more.sensors().autonomy[0], 100.0);
  AnnualMetrics sunny(1, hours, 8760, {});
  sunny.add(block(
                hours, 1, [](int, int) { return 0.0; }, 1000.0f),
            std::vector<float>(hours.size(), 0.5f));
  EXPECT_EQ(sunny.sensors().autonomy[0], 100.0);
  EXPECT_EQ(sunny.sensors().sun_hours[0], 3650.0);
}

TEST(AnnualMetrics, OfARoom) {
  SensorMetrics sensors;
  sensors.autonomy = Eigen::ArrayXd{{0.0, 49.9, 50.0, 100.0}};
  sensors.continuous_autonomy = sensors.mean_lux = sensors.autonomy;
  sensors.sun_hours = Eigen::ArrayXd{{0.0, 250.0, 251.0, 400.0}};
  sensors.en_above_100 = Eigen::ArrayXd{{60.0, 60.0, 60.0, 60.0}};
  sensors.en_above_300 = Eigen::ArrayXd{{40.0, 50.0, 60.0, 70.0}};
  sensors.en_above_500 = Eigen::ArrayXd{{0.0, 0.0, 60.0, 70.0}};
  sensors.en_above_750 = Eigen::ArrayXd{{0.0, 0.0, 0.0, 70.0}};
  const Eigen::ArrayXf factor{{0.01f, 0.02f, 0.03f, 0.06f}};
  const RoomMetrics all = room_metrics(sensors, factor, 0, 4);
  EXPECT_EQ(all.spatial_autonomy, 50.0);
  EXPECT_EQ(all.sun_exposure, 50.0);
  EXPECT_NEAR(all.mean_daylight_factor, 3.0, 1e-6);
  EXPECT_NEAR(all.median_daylight_factor, 2.5, 1e-6);
  EXPECT_EQ(all.en_level, "minimum");
  // The last two meet 500 lx everywhere and 750 lx on half; 300 lx everywhere.
  EXPECT_EQ(room_metrics(sensors, factor, 2, 2).en_level, "high");
  EXPECT_EQ(room_metrics(sensors, factor, 0, 1).en_level, "none");
}

TEST(Occupancy, IsReadFromTwoHours) {
  const Occupancy read = read_occupancy("0-24");
  EXPECT_EQ(read.from, 0);
  EXPECT_EQ(read.to, 24);
  for (const char* const text : {"", "8", "18-8", "8-8", "0-25", "-1-8", "8-18h", "8.5-18"}) {
    EXPECT_THROW(read_occupancy(text), InputError) << text;
  }
}

}  // namespace lightwell::annual_metrics_test
