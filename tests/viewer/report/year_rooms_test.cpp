#include "viewer/report/year_rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scene/errors.h"
#include "tests/temporary_folder.h"
#include "viewer/report/year_ratings.h"

namespace lightwell::year_rooms_test {
namespace {

// A hall of 30 m^2 with daylight factors of 4, 3, 2 and 1 %, and a cell of 10 m^2 with twice 1 %,
// whose light is known to 4 %.
YearReport hall_and_cell() {
  YearReport report{.error = 0.04};
  report.daylight_factor = Eigen::ArrayXf{{0.04f, 0.03f, 0.02f, 0.01f, 0.01f, 0.01f}};
  report.rooms = {{.name = "hall", .first = 0, .count = 4, .area = 30.0},
                  {.name = "cell", .first = 4, .count = 2, .area = 10.0}};
  report.rooms[0].metrics.mean_daylight_factor = 2.5;
  report.rooms[1].metrics.mean_daylight_factor = 1.0;
  for (YearRoom& room : report.rooms) room.rated_hours.resize(1);
  report.ratings = {{.key = "house",
                     .title = "House rule",
                     .points = "stars",
                     .area = {{.at_least = 75.0, .points = 1}},
                     .daylight_factor = 2.0,
                     .uniformity = 0.38}};
  return report;
}

BoundedFigure figure_of(const YearReport& report, const std::string& room, DaylightFigure figure) {
  const RatedDaylight rated = rate_year(report).at(0).daylight;
  const auto at = std::ranges::find_if(rated.figures, [&](const RatedFigure& one) {
    return one.room == room && one.figure == figure;
  });
  if (at == rated.figures.end()) {
    ADD_FAILURE() << "no such figure of '" << room << "'";
    return {};
  }
  return at->value;
}

void expect_bounded(const BoundedFigure& found, const BoundedFigure& expected) {
  // Factors are floats, to 2^-25 of at most 3 %, and a quotient has twice the relative error of
  // each.
  constexpr double rounding = 2.0 * 3.0 / (1 << 25);
  EXPECT_NEAR(found.value, expected.value, rounding);
  EXPECT_NEAR(found.least, expected.least, rounding);
  EXPECT_NEAR(found.most, expected.most, rounding);
}

}  // namespace

// 4 % of the mean of 2.5 %, and of 1 % at the darkest point; 1 / 2.5 has both bounds.
TEST(YearRooms, DaylightFactorsHaveTheBoundOfTheLight) {
  const YearReport report = hall_and_cell();
  expect_bounded(figure_of(report, "hall", DaylightFigure::mean_factor), {2.5, 2.4, 2.6});
  expect_bounded(figure_of(report, "hall", DaylightFigure::least_factor), {1.0, 0.96, 1.04});
  expect_bounded(figure_of(report, "hall", DaylightFigure::factor_uniformity),
                 {0.4, 0.96 / 2.6, 1.04 / 2.4});
}

// The bound of a dark point is relative to a quarter of the mean of all sensors, 2 %, at least.
TEST(YearRooms, DarkPointsHaveTheBoundOfAQuarterOfTheMean) {
  YearReport report = hall_and_cell();
  report.daylight_factor[3] = 0.001f;
  report.daylight_factor[0] = 0.049f;
  expect_bounded(figure_of(report, "hall", DaylightFigure::least_factor),
                 {0.1, 0.1 - 0.04 * 0.5, 0.1 + 0.04 * 0.5});
}

// Daylight factors are those of the first states, whose computation has a bound of its own.
TEST(YearRooms, DaylightFactorsOfOperatedWindowsHaveTheBoundOfTheFirstStates) {
  YearReport report = hall_and_cell();
  report.states = {{.error = 0.1}, {.error = 0.5}};
  expect_bounded(figure_of(report, "hall", DaylightFigure::mean_factor), {2.5, 2.25, 2.75});
}

// The hall's darkest point of 0.96 to 1.04 % has 0.41 times 2 %, and may have 0.51 times 2 %. Its
// area is three quarters of all, which is enough.
TEST(YearRooms, PointsAreOpenWhereAnEndOfTheBoundGivesNone) {
  YearReport report = hall_and_cell();
  report.ratings[0].uniformity = 0.41;
  EXPECT_EQ(rate_year(report).at(0).daylight.points.least, 1);
  report.ratings[0].uniformity = 0.51;
  EXPECT_EQ(rate_year(report).at(0).daylight.points.least, 0);
  EXPECT_EQ(rate_year(report).at(0).daylight.points.most, 1);
  EXPECT_NE(rating_sections(report).find("House rule: 0 to 1 of 1 star, too close to tell"),
            std::string::npos);
  report.rooms[0].is_regularly_occupied = false;
  EXPECT_EQ(rate_year(report).at(0).daylight.points.most, 0);
}

// The hall has four of six sensors, 67 %, which is less than the 75 % of its area.
TEST(YearRooms, CountByTheirSensorsWithoutAnArea) {
  YearReport report = hall_and_cell();
  EXPECT_EQ(rate_year(report).at(0).daylight.points.value, 1);
  report.rooms[1].area = 0.0;
  EXPECT_EQ(rate_year(report).at(0).daylight.points.value, 0);
}

// 100 W over 10 m^2 in 2000 h of daylight with F_D = 0.4 (0.3 to 0.5) and 1000 h without:
//
//     LENI = 100 (2000 * 0.4 + 1000) / (1000 * 10) = 18 kWh/m^2 (16 to 20) of 30
//
// and daylight saves 12 kWh/m^2 (10 to 14), 40 % (1/3 to 7/15).
TEST(YearRooms, LampsTakeTheEnergyOfTheStandard) {
  YearRoom room{.name = "cell", .area = 10.0};
  room.lighting = RoomLighting{.watts = 100.0, .lux = 500.0};
  room.lamps = {.daylight_hours = 2000,
                .night_hours = 1000,
                .daylight_dependency = {.value = 0.4, .least = 0.3, .most = 0.5}};
  const LampEnergy energy = lamp_energy(room);
  const auto expect = [](const BoundedFigure& found, double value, double least, double most) {
    // Fewer than eight operations round at 2^-53 of 30 each.
    constexpr double rounding = 8.0 * 30.0 / (1LL << 53);
    EXPECT_NEAR(found.value, value, rounding);
    EXPECT_NEAR(found.least, least, rounding);
    EXPECT_NEAR(found.most, most, rounding);
  };
  expect(energy.indicator, 18.0, 16.0, 20.0);
  expect(energy.saved, 12.0, 10.0, 14.0);
  expect(energy.saved_share, 0.4, 1.0 / 3.0, 7.0 / 15.0);
}

// Each room has the first table that fits its name.
TEST(YearRooms, HaveTheUseOfTheirTable) {
  YearReport report = hall_and_cell();
  report.rooms[1].area = 0.0;
  const RoomUse all{.sensors = "*", .area = 7.0}, hall{.sensors = "hall"};
  use_rooms(std::vector{hall, all}, report.rooms);
  EXPECT_EQ(report.rooms[0].area, 30.0);
  EXPECT_EQ(report.rooms[1].area, 7.0);
  const auto refusal = [&](const std::vector<RoomUse>& uses) {
    return message_of<InputError>([&] { use_rooms(uses, report.rooms); });
  };
  EXPECT_TRUE(says(refusal({all, hall}), "no sensors are left for 'hall'"));
  EXPECT_TRUE(says(refusal({{.sensors = "hal"}}), "Did you mean 'hall'?"));
  report.rooms[1].area = 0.0;
  const RoomLighting lamps{.watts = 100.0, .lux = 500.0};
  EXPECT_TRUE(says(refusal({{.sensors = "cell", .lighting = lamps}}), "no area"));
}

}  // namespace lightwell::year_rooms_test
