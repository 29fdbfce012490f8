#include "daylight/operated_year.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "daylight/year_error.h"
#include "scene/io/weather/weather_file.h"
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

DaylightOptions few_patches(int gather_rays = 64) {
  DaylightOptions options{.sky_subdivision = 1, .gather_rays = gather_rays};
  options.mesh.auto_patch_count = 150;
  return options;
}

// Light of a scene without operated windows.
HourBlock block_of(const Scene& scene, const std::vector<SkyHour>& hours,
                   const DaylightOptions& options) {
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), options);
  model.set_sensors(test::desks());
  HourBlock all;
  simulate_year(model, model.sky_coefficients().sum(), hours, 0.2,
                [&](const HourBlock& block) { all = block; });
  return all;
}

// The same, sensors x hours.
Eigen::ArrayXXf light_of(const Scene& scene, const std::vector<SkyHour>& hours,
                         const DaylightOptions& options = few_patches()) {
  return block_of(scene, hours, options).total;
}

OperatedYear operated(const Scene& scene, const OperatedWindows& windows,
                      const std::vector<SkyHour>& hours,
                      const DaylightOptions& options = few_patches()) {
  DaylightModel model(scene, Vector3d::UnitZ(), Vector3d::UnitY(), options);
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

// A room of 4 m x 3 m x 2.5 m between two walls of two panes each, which pass all light: panes 0
// and 2 in the south, and 1 and 3 opposite.
Scene room_between_panes() {
  Scene scene;
  Material grey = test::diffuse(scene.bands, 0.2f);
  grey.one_sided = false;
  const int rho = test::add_material(scene, grey);
  test::add_box(scene, {0.0, 0.0, 0.0}, {4.0, 3.0, 2.5}, {rho, rho, rho, rho, rho, rho}, true);
  std::erase_if(scene.surfaces, [](const Surface& surface) {
    return surface.name == "y0" || surface.name == "y1";
  });
  const int veil = test::add_material(scene, test::veil(scene.bands, 1.0f));
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.0 : 2.0, y = i % 2 == 0 ? 0.0 : 3.0;
    test::add_polygon(scene, "pane " + std::to_string(i), veil,
                      {{x, y, 0.0}, {x, y, 2.5}, {x + 2.0, y, 2.5}, {x + 2.0, y, 0.0}});
  }
  return scene;
}

// Gives each hour the states of the bits of its number.
void schedule_bits(const std::vector<SkyHour>& hours, OperatedWindows& windows) {
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    WindowGroup& group = windows.groups[g];
    group.operation = WindowOperation::schedule;
    group.hours.assign(8760, 0);
    for (std::size_t n = 0; n < hours.size(); ++n) {
      group.hours[static_cast<std::size_t>(hours[n].number)] = static_cast<int>(n >> g & 1);
    }
  }
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
  const DaylightOptions options = few_patches(4096);
  const OperatedYear year = operated(room, windows, hours, options);
  ASSERT_TRUE(year.plan.is_superposed);
  EXPECT_EQ(year.total.col(0).maxCoeff(), 0.0f);
  const Eigen::ArrayXXf open = light_of(room, hours, options),
                        alone =
                            light_of(scene_in_states(room, windows, {1, 1, 1, 0}), hours, options);
  const Eigen::Index last = year.total.cols() - 1;
  // A computation, of four, spreads 4096 rays over what its windows show of the sky, and
  // sends 4096 gather rays, whose mean has an error of at most 1 / 64 of the reflected light, which
  // is about a quarter of all: four standard errors of the sum of four such differences, which
  // share their random numbers.
  const double noise = 4.0 * std::sqrt(4.0) * 0.25 / 64.0;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    EXPECT_GT(double{alone(i, last)}, noise * double{open(i, last)}) << i;
    EXPECT_NEAR(double{year.total(i, last)}, double{alone(i, last)}, noise * double{open(i, last)})
        << i;
  }
  EXPECT_LT(alone.col(last).sum(), 0.5f * open.col(last).sum());
}

// Sheets in two windows that face each other send light to and fro, which superposition has only
// from one of them at a time. The bound of the hour holds that, though the room is dark with all
// sheets down. Black sheets send nothing.
TEST(OperatedYear, BoundHoldsWhereWindowsFaceEachOther) {
  const std::vector<SkyHour> hours = some_hours();
  constexpr std::size_t pair = 3;  // hour 3 has the bits of the first two groups
  std::vector<double> superpositions;
  for (const float reflectance : {0.9f, 0.0f}) {
    const Scene room = room_between_panes();
    Material sheet = test::diffuse(room.bands, reflectance);
    sheet.one_sided = false;
    OperatedWindows windows = test::windows_of_panes(room, sheet);
    ASSERT_EQ(windows.groups.size(), 4u);
    schedule_bits(hours, windows);
    const OperatedYear year = operated(room, windows, hours);
    ASSERT_TRUE(year.plan.is_superposed);
    ASSERT_EQ(year.hour_errors.size(), hours.size());
    const HourBlock block =
        block_of(scene_in_states(room, windows, {1, 1, 0, 0}), hours, few_patches());
    const auto h = static_cast<Eigen::Index>(pair);
    const Eigen::ArrayXd computed = (block.total.col(h) - block.sunlight.col(h)).cast<double>(),
                         superposed = (year.total.col(h) - year.sunlight.col(h)).cast<double>();
    const double difference = relative_difference(superposed - computed, computed);
    EXPECT_LE(difference, year.hour_errors[pair]) << reflectance;
    if (reflectance > 0.0f) {
      // More than the error of any computation.
      EXPECT_GT(difference, std::ranges::max(year.errors));
    }
    // One changed group is computed.
    EXPECT_EQ(year.hour_errors[1], year.errors[1]);
    superpositions.push_back(year.superposition);
  }
  EXPECT_GT(superpositions[0], superpositions[1]);
}

}  // namespace lightwell::operated_year_test
