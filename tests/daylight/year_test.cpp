#include "daylight/year.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "daylight/year_error.h"
#include "scene/io/weather/weather_file.h"
#include "scene/parallel.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::year_test {
namespace {

using Eigen::Vector3d;

// Every third hour of a week in March in Oakland.
std::vector<SkyHour> some_hours() {
  Weather weather{.latitude = 37.72, .longitude = -122.22, .hours_east = -8.0};
  weather.hours.assign(8760, {});
  for (int n = 24 * 75; n < 24 * 82; n += 3) {
    weather.hours[static_cast<std::size_t>(n)] = {.direct_normal = 400.0,
                                                  .diffuse_horizontal = 150.0};
  }
  return sky_hours(weather, Vector3d::UnitZ(), Vector3d::UnitY());
}

DaylightOptions few_patches() {
  DaylightOptions options{.gather_rays = 256};
  options.sky_subdivision = 2;
  options.mesh.auto_patch_count = 400;
  return options;
}

Eigen::ArrayXXf year_of(const DaylightModel& model, const std::vector<SkyHour>& hours) {
  Eigen::ArrayXXf all(model.sensor_count(), 0);
  simulate_year(model, model.sky_coefficients().sum(), hours, 0.2, [&](const HourBlock& block) {
    const Eigen::Index before = all.cols();
    all.conservativeResize(Eigen::NoChange, before + block.total.cols());
    all.rightCols(block.total.cols()) = block.total;
  });
  return all;
}

}  // namespace

// Open ground gets the light of the weather: that of the dome, to the rounding of 578 floats, and
// the sun's by the cosine, whose mean over the disc is that of its middle to 1e-5.
TEST(Year, OpenGroundGetsTheLightOfTheWeather) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "slab", black,
                    {{0.0, 0.0, -1.0}, {1.0, 0.0, -1.0}, {1.0, 1.0, -1.0}, {0.0, 1.0, -1.0}});
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  const std::vector<GatherPoint> above = {{.position = {0.5, 0.5, 0.0}}};
  model.set_sensors(above);
  const std::vector<SkyHour> hours = some_hours();
  ASSERT_GT(hours.size(), 20u);
  const Eigen::ArrayXXf E = year_of(model, hours);
  ASSERT_EQ(E.cols(), static_cast<Eigen::Index>(hours.size()));
  for (std::size_t h = 0; h < hours.size(); ++h) {
    const double expected = hours[h].horizontal_lux(Vector3d::UnitZ());
    // Cosines vary over the disc by half its radius, 0.0047, times the cosine of the altitude, at
    // most 1; four standard errors of 16 rays.
    const double off = 4.0 * 0.5 * 0.0047 / 4.0 * hours[h].sun_lux + 1e-5 * expected;
    EXPECT_NEAR(double{E(0, static_cast<Eigen::Index>(h))}, expected, off) << h;
  }
  EXPECT_NEAR(double{daylight_factors(model, model.sky_coefficients().sum(), 0.2)[0]}, 1.0, 1e-5);
}

TEST(Year, SameBitsForAnyNumberOfThreads) {
  const Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  const std::vector<SkyHour> hours = some_hours();
  const auto light = [&](int threads) {
    const ThreadLimit limit(threads);
    DaylightModel model(room, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
    model.set_sensors(test::desks());
    return year_of(model, hours);
  };
  EXPECT_TRUE((light(1) == light(3)).all());
}

// The bound exceeds the difference from a computation with four times the patches and rays.
TEST(Year, BoundHolds) {
  const Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  const std::vector<SkyHour> hours = some_hours();
  DaylightModel model(room, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  model.set_sensors(test::desks());
  const double bound = year_error(model, model.sky_coefficients().sum(), hours, 0.2, 16);
  EXPECT_GT(bound, 0.0);
  DaylightOptions many = few_patches();
  many.mesh.auto_patch_count *= 4;
  many.gather_rays *= 4;
  many.points.rays *= 4;
  many.patches.rays *= 4;
  many.replica = 7;
  DaylightModel better(room, Vector3d::UnitZ(), Vector3d::UnitY(), many);
  better.set_sensors(test::desks());
  const Eigen::ArrayXXf E = year_of(model, hours), truth = year_of(better, hours);
  // The last desk gets no direct sunlight.
  EXPECT_NEAR(double{E.row(2).sum() / truth.row(2).sum()}, 1.0, bound);
}

}  // namespace lightwell::year_test
