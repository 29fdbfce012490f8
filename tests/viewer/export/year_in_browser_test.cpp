// A page of a year of daylight in a browser.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/readings/probe.h"
#include "tests/viewer/in_browser.h"
#include "tests/viewer/year_room.h"
#include "viewer/export/appearance.h"

namespace lightwell::year_in_browser_test {
namespace {

// 21 March is day 79 of the year, from 0, 21 June day 171 and 21 December day 354.
constexpr const char* drive = R"(<script>
driver.run(async (page, found) => {
  const {wait, read, pixel} = driver, panel = page.year_panel, {year} = panel;
  await wait(300);
  found.suns = Array.from(year.numbers, (hour) => year.sun_at(hour + 0.5));
  found.directions = Array.from(year.numbers, (hour) => page.model.about.to_scene.map((row) => {
    const {x, y, z} = year.direction_of(year.sun_at(hour + 0.5));
    return row[0] * x + row[1] * y + row[2] * z;
  }));
  panel.set(79, 12.5);
  page.camera.aspect = page.bookmark.aspect;
  page.fit_view();
  const places = [[0.5, 0.5], [0.5, 0.8], [0.1, 0.35]];
  found.readings = [];
  for (const place of places) found.readings.push(await read(...place));
  page.ranges.illuminance = {low: 100, high: 100000, logarithmic: true};
  page.set_false_colors('illuminance');
  found.pixels = places.map((place) => pixel(...place));
  page.set_false_colors(null);

  // Minute by minute from one midnight to the next.
  const sizes = (light) => [light.sun_lux, light.dome_lux, year.light_of(0, light)[0]];
  const day = Array.from({length: 1441}, (_, m) => sizes(year.light_at(24 * 79 + m / 60)));
  found.steps = [0, 1, 2].map((i) => Math.max(...day.slice(1).map((x, m) => Math.abs(x[i] - day[m][i]))) /
    Math.max(...day.map((x) => x[i])));
  panel.set(79, 0);
  found.at_night = await read(0.5, 0.5);

  // The next light after dusk is that of June.
  panel.set(79, 16);
  panel.play(true);
  panel.advance(0.5);
  found.played = [element('date').value, element('hour').value];
  panel.advance(1);
  found.next = [element('date').value, element('hour').value];
  panel.play(false);

  // A sun that rises 20 s before the middle of the first lit hour.
  const horizon = year.horizon_between, shares = year.shares_at, first = year.numbers[0];
  year.horizon_between = () => first + 0.5 - 20 / 3600;
  const of_minute = Array.from({length: 91}, (_, m) =>
    year.shares_at(first - 1 + m / 60).reduce((sum, [, share]) => sum + share, 0));
  found.late_sunrise = Math.max(...of_minute.slice(1).map((x, m) => x - of_minute[m]));
  year.horizon_between = horizon;
  // A lit midnight, as of a polar summer.
  year.shares_at = () => [[0, 1]];
  panel.set(79, 23.98);
  panel.play(true);
  panel.advance(0.1);
  panel.play(false);
  found.after_midnight = [element('date').valueAsNumber, element('hour').valueAsNumber];
  year.shares_at = shares;

  const exposure_at = (day, hour) => {
    panel.set(day, hour);
    page.meter_moment(page.metered_at + 1e6);
    return page.metered;
  };
  found.automatic = [exposure_at(79, 12.5), exposure_at(79, 16.4)];
  element('adapt').click();
  found.fixed = [exposure_at(79, 12.5), exposure_at(79, 16.4)];
  found.dome = (() => {
    panel.set(79, 12.5);
    const {columns, rows_above, rows_below} = page.picture.sky.about, L = new Float32Array(4 * columns * (rows_above + rows_below));
    paint_dome(year, panel.light, L, page.picture.sky.about);
    return {zenith: L[0], ground: L[4 * columns * rows_above]};
  })();
});
</script>)";

}  // namespace

TEST_P(InBrowser, ThePageShowsEveryMomentOfAYear) {
  test::ComputedRoom& room = test::glazed_year();
  const Json found = run(room.page(), drive);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());

  // The page's sun is the program's: the same formula in double precision.
  ASSERT_EQ(found["suns"].size(), room.hours.size());
  for (std::size_t h = 0; h < room.hours.size(); ++h) {
    EXPECT_NEAR(found["suns"][h]["altitude"].get<double>() * 180.0 / std::numbers::pi,
                room.hours[h].altitude_degrees, 1e-8);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(found["directions"][h][static_cast<std::size_t>(c)].get<double>(),
                  room.hours[h].sun[c], 1e-9);
    }
  }

  const int noon = room.hour_of(3, 21, 12);
  const RadiositySolution solution = room.solution(noon);
  const SkyHour& sky = room.hours[static_cast<std::size_t>(noon)];
  int lit = 0;
  for (std::size_t i = 0; i < found["readings"].size(); ++i) {
    const Json& reading = found["readings"][i];
    ASSERT_TRUE(reading.contains("illuminance")) << reading;
    const Eigen::Vector3d at(number(reading["x"]), number(reading["y"]), number(reading["z"]));
    const bool on_floor = at.z() < 1e-4;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    if (!on_floor) normal = at.x() > 2.0 ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(1, 0, 0);
    const Probe probe{.position = at, .normal = normal};
    const BandArray E = interpolate_irradiance(room.model.caster(), solution, {&probe, 1});
    const double lux = luminous(rgb_bands(), E.row(0).transpose());
    const double sunlight = number(reading["sunlight"]), all = number(reading["illuminance"]);
    // Products of half floats, 2^-10 of their sizes, whose sum is at most four times the light.
    EXPECT_NEAR(all - sunlight, lux, 4e-3 * lux) << reading;
    // The sun through the pane: n = 1.5, of whose transmittance the table has 64 steps. A step at
    // this angle changes it by 0.3 %, and the line between two is off by less than a tenth of that.
    if (sunlight > 0.0) {
      ++lit;
      const GatherPoint point{.position = at + 1e-6 * normal, .normal = normal};
      room.model.set_sensors({&point, 1});
      const std::vector<SunDisc> sun = {{room.model.sky(), sky.sun}};
      const double wanted = sky.sun_lux * double{room.model.direct_sun(sun)(0, 0)};
      // The disc has 16 rays, whose cosines differ by up to 0.0047: four of their errors.
      EXPECT_NEAR(sunlight, wanted, (0.0047 / std::sqrt(3.0) + 3e-4) * sky.sun_lux);
    }
    // The picture shows what the reading says, in roundings of two colours and of the place on the
    // scale, whose 255 steps are 2.7 % each; the map of the sun has 8 bits of the pane's
    // transmittance, 0.2 %.
    const auto colour = false_colors({static_cast<float>(all)}, {.low = 100.0, .high = 1e5});
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(found["pixels"][i][c].get<int>(), colour[c], 3) << i << ' ' << c;
    }
  }
  EXPECT_EQ(found["readings"][0]["surface"], "z0");
  EXPECT_GT(number(found["readings"][0]["sunlight"]), 0.0);
  EXPECT_EQ(lit, 1) << "the other places are in the shade";

  // Light grows and falls within an hour, half an hour at least at the sun's rise and set, or
  // within 60 minutes between two hours: no minute changes it by more than a thirtieth of the day's
  // most.
  for (const Json& step : found["steps"]) EXPECT_LT(step.get<double>(), 1.0 / 30.0);
  EXPECT_EQ(number(found["at_night"]["illuminance"]), 0.0);
  constexpr double rounding = 1e-9;  // of hours of a year, 8760, in double precision: 2e-12
  EXPECT_NEAR(found["late_sunrise"].get<double>(), 1.0 / 30.0, rounding);
  EXPECT_EQ(found["after_midnight"][0], 80);
  // The slider has steps; 0.08 is the hour itself.
  EXPECT_LT(found["after_midnight"][1].get<double>(), 0.2);

  EXPECT_EQ(found["played"], Json::array({"79", "16.5"}));
  EXPECT_EQ(found["next"][0], "171");
  EXPECT_LT(number(found["next"][1]), 8.0);
  EXPECT_GT(found["automatic"][1].get<double>(), 1.2 * found["automatic"][0].get<double>());
  EXPECT_EQ(found["fixed"][0], found["fixed"][1]);

  // The dome is the program's: the mean over the patch at the zenith differs from the zenith by the
  // gradation over 6 degrees, 2 %, and the page's sum over the dome is one in 5 degrees, 2 %.
  const SkyPatches patches(4, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  const Eigen::ArrayXf L = column_luminances(patches, sky, test::ComputedRoom::ground);
  const double zenith = double{L[patches.dome_count() - 1]};
  EXPECT_NEAR(found["dome"]["zenith"].get<double>(), zenith, 0.04 * zenith);
  const double below = double{L[patches.ground_column()]};
  EXPECT_NEAR(found["dome"]["ground"].get<double>(), below, 1e-3 * below);  // of the sun's place
}

// On a phone the controls of the year are below each other, on the screen, and large enough for
// fingers: 44 pixels.
TEST_P(InBrowser, AYearFitsOnAPhone) {
  constexpr const char* look = R"(<script>
driver.run(async (page, found) => {
  await driver.wait(300);
  document.body.classList.add('touch');
  await driver.frame();
  const box = (id) => { const {left, right, top, bottom} = element(id).getBoundingClientRect(); return [left, right, top, bottom]; };
  found.screen = [innerWidth, innerHeight];
  for (const id of ['bar', 'year', 'hour', 'date', 'play', 'adapt', 'stick']) found[id] = box(id);
});
</script>)";
  const Json found = run(test::glazed_year().page(), look, {.width = 390, .height = 780});
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  const auto side = [&](const char* id, std::size_t i) { return found[id][i].get<double>(); };
  for (const char* id : {"year", "hour", "date", "play", "adapt"}) {
    EXPECT_GE(side(id, 0), 0.0) << id;
    EXPECT_LE(side(id, 1), side("screen", 0)) << id;
    EXPECT_LE(side(id, 3), side("screen", 1)) << id;
    EXPECT_GE(side(id, 3) - side(id, 2), 44.0) << id;
  }
  EXPECT_GT(side("hour", 1) - side("hour", 0), 300.0) << "the sliders are as wide as the screen";
  EXPECT_LE(side("stick", 3), side("year", 2)) << "the stick is above the sliders";
  EXPECT_LE(side("bar", 3), side("stick", 2));
}

}  // namespace lightwell::year_in_browser_test
