#include "daylight/operated_year.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/daylight/daylight_rooms.h"

namespace lightwell::operated_year_test {
namespace {

using Eigen::Vector3d;

// Every third hour of three days in March in Oakland.
std::vector<SkyHour> some_hours() {
  Weather weather{.latitude = 37.72, .longitude = -122.22, .hours_east = -8.0};
  weather.hours.assign(8760, {});
  for (int n = 24 * 75; n < 24 * 78; n += 3) {
    weather.hours[static_cast<std::size_t>(n)] = {.direct_normal = 400.0,
                                                  .diffuse_horizontal = 150.0};
  }
  return sky_hours(weather, Vector3d::UnitZ(), Vector3d::UnitY());
}

DaylightOptions few_patches() {
  DaylightOptions options{.sky_subdivision = 1, .gather_rays = 64};
  options.mesh.auto_patch_count = 150;
  return options;
}

// Light of a scene without operated windows, sensors x hours.
Eigen::ArrayXXf light_of(const Scene& scene, const std::vector<SkyHour>& hours) {
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  model.set_sensors(test::desks());
  Eigen::ArrayXXf all;
  simulate_year(model, model.sky_coefficients().sum(), hours, 0.2,
                [&](const HourBlock& block) { all = block.total; });
  return all;
}

OperatedYear operated(const Scene& scene, const OperatedWindows& windows,
                      const std::vector<SkyHour>& hours) {
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), few_patches());
  model.set_sensors(test::desks());
  const SensorRange all{0, model.sensor_count()};
  return operate_year(scene, model, windows, {.hours = hours, .rooms = {&all, 1}},
                      [](const ComputedYear&, const HourBlock&) {});
}

// The scene whose materials include that of the blind, as a file that names it has.
Scene room_with_blind(int panes, const Material& blind) {
  Scene room = test::room_with_panes(panes);
  test::add_material(room, blind);
  return room;
}

Material fabric() {
  Material blind = test::diffuse(Bands(rgb_bands()), 0.5f);
  blind.one_sided = false;
  blind.transmittance = constant_spectrum(Bands(rgb_bands()), 0.05f);
  return blind;
}

}  // namespace

// Hour by hour, light is that of the scene with the pane of the state's material, to the bit.
TEST(OperatedYear, LightOfEachStateIsThatOfItsScene) {
  const Scene room = room_with_blind(1, fabric());
  OperatedWindows windows = test::windows_of_panes(room, fabric());
  windows.groups[0].operation = WindowOperation::schedule;
  windows.groups[0].spans = {{.state = 1, .from_hour = 12, .to_hour = 24}};
  const std::vector<SkyHour> hours = some_hours();
  const OperatedYear year = operated(room, windows, hours);
  const Eigen::ArrayXXf open = light_of(room, hours),
                        closed = light_of(scene_in_states(room, windows, {1}), hours);
  int afternoons = 0;
  for (std::size_t n = 0; n < hours.size(); ++n) {
    const auto h = static_cast<Eigen::Index>(n);
    const bool is_closed = hours[n].number % 24 >= 12;
    afternoons += is_closed ? 1 : 0;
    EXPECT_TRUE((year.total.col(h) == (is_closed ? closed : open).col(h)).all()) << "hour " << n;
  }
  EXPECT_GT(afternoons, 0);
  EXPECT_LT(afternoons, static_cast<int>(hours.size()));
  // A blind that passes 5 % of the light makes the room darker than the hole does.
  EXPECT_LT(closed.sum(), 0.5f * open.sum());
  EXPECT_EQ(year.superposition, 0.0);
  EXPECT_EQ(year.errors.size(), 2u);
}

TEST(OperatedYear, AlwaysClosedIsTheSceneWithTheBlind) {
  const Scene room = room_with_blind(1, fabric());
  OperatedWindows windows = test::windows_of_panes(room, fabric());
  windows.groups[0].operation = WindowOperation::always;
  const std::vector<SkyHour> hours = some_hours();
  EXPECT_TRUE(
      (operated(room, windows, hours).total == light_of(scene_in_states(room, windows, {1}), hours))
          .all());
}

TEST(OperatedYear, ABlindOfThePanesMaterialChangesNothing) {
  const Scene room = test::room_with_panes(1);
  OperatedWindows windows = test::windows_of_panes(room, test::veil(room.bands, 1.0f));
  windows.groups[0].operation = WindowOperation::always;
  const std::vector<SkyHour> hours = some_hours();
  EXPECT_TRUE((operated(room, windows, hours).total == light_of(room, hours)).all());
}

// Panes that pass all light and black ones reflect alike, so that superposed light is exact but
// for noise: three panes of four closed leave the light of the fourth. All closed are computed.
TEST(OperatedYear, SuperposedLightIsThatOfTheOpenPanes) {
  constexpr int panes = 4;
  const Scene room = test::room_with_panes(panes);
  OperatedWindows windows = test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
  const std::vector<SkyHour> hours = some_hours();
  // Hour n has the states of the bits of n, but all are closed in the first, and all but pane 3 in
  // the last.
  for (int g = 0; g < panes; ++g) {
    WindowGroup& group = windows.groups[static_cast<std::size_t>(g)];
    group.operation = WindowOperation::schedule;
    group.hours.assign(8760, 1);
    for (std::size_t n = 1; n < hours.size(); ++n) {
      const int bits = n + 1 < hours.size() ? static_cast<int>(n) : 7;
      group.hours[static_cast<std::size_t>(hours[n].number)] = bits >> g & 1;
    }
  }
  const OperatedYear year = operated(room, windows, hours);
  ASSERT_TRUE(year.plan.is_superposed);
  EXPECT_EQ(year.total.col(0).maxCoeff(), 0.0f);
  const Eigen::ArrayXXf open = light_of(room, hours),
                        alone = light_of(scene_in_states(room, windows, {1, 1, 1, 0}), hours);
  const Eigen::Index last = year.total.cols() - 1;
  // Each of the four computations spreads 4096 rays over what its windows show of the sky, and
  // sends 64 gather rays, whose mean has an error of at most 1 / 8 of the reflected light, which is
  // about a quarter of all: four standard errors of the sum of four such differences, which share
  // their random numbers.
  const double noise = 4.0 * std::sqrt(4.0) * 0.25 / 8.0;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    EXPECT_NEAR(double{year.total(i, last)}, double{alone(i, last)}, noise * double{open(i, last)})
        << i;
  }
  EXPECT_LT(alone.col(last).sum(), 0.5f * open.col(last).sum());
}

}  // namespace lightwell::operated_year_test
