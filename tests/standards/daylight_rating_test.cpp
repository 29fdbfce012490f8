#include "standards/daylight_rating.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::daylight_rating_test {
namespace {

DaylightRating usual(const std::string& key) {
  return find_daylight_rating(usual_daylight_ratings(), key, "test");
}

BoundedFigure sure(double value) {
  return {.value = value, .least = value, .most = value};
}

// The verdict on a figure of a room (empty: of all rooms) that is held to `limit`.
Verdict verdict_on(const RatedDaylight& rated, const std::string& room, DaylightFigure figure,
                   double limit) {
  const auto at = std::ranges::find_if(rated.figures, [&](const RatedFigure& one) {
    return one.room == room && one.figure == figure && one.limit == limit;
  });
  if (at == rated.figures.end()) {
    ADD_FAILURE() << "no such limit for '" << room << "'";
    return Verdict::missed;
  }
  return verdict_of(*at);
}

// sDA of 80 % (70 to 90) on 30 m^2 and of 40 % (30 to 50) on 10 m^2:
//
//     (30 * 80 + 10 * 40) / 40 = 70 %      60 to 80 %
//
// v4.1 gives 2 points from 55 % on, and 3 from 75 %, which lies within the bound.
TEST(DaylightRating, LeedCountsTheMeanOverTheArea) {
  const std::array rooms = {DaylitRoom{.name = "hall",
                                       .area = 30.0,
                                       .autonomy = {.value = 80.0, .least = 70.0, .most = 90.0},
                                       .sun_exposure = sure(5.0)},
                            DaylitRoom{.name = "cell",
                                       .area = 10.0,
                                       .autonomy = {.value = 40.0, .least = 30.0, .most = 50.0},
                                       .sun_exposure = sure(12.0)}};
  const RatedDaylight rated = rate_daylight(usual("leed"), rooms);
  EXPECT_EQ(rated.points.value, 2);
  EXPECT_EQ(rated.points.least, 2);
  EXPECT_EQ(rated.points.most, 3);
  EXPECT_EQ(rated.points.available, 3);
  const auto autonomy = DaylightFigure::spatial_autonomy, sun = DaylightFigure::sun_exposure;
  EXPECT_EQ(verdict_on(rated, "", autonomy, 40.0), Verdict::met);
  EXPECT_EQ(verdict_on(rated, "", autonomy, 55.0), Verdict::met);
  EXPECT_EQ(verdict_on(rated, "", autonomy, 75.0), Verdict::too_close);
  EXPECT_EQ(verdict_on(rated, "hall", autonomy, 55.0), Verdict::met);
  EXPECT_EQ(verdict_on(rated, "cell", autonomy, 55.0), Verdict::missed);
  EXPECT_EQ(verdict_on(rated, "hall", sun, 10.0), Verdict::met);
  EXPECT_EQ(verdict_on(rated, "cell", sun, 10.0), Verdict::missed);
  const BoundedFigure mean = rated.figures.back().value;
  // Sums of whole numbers are exact, and their quotients are whole.
  EXPECT_EQ(mean.value, 70.0);
  EXPECT_EQ(mean.least, 60.0);
  EXPECT_EQ(mean.most, 80.0);
}

// 60 % in each room is 2 points, and a third one since each room has 55 %; 80 % has no fourth.
TEST(DaylightRating, LeedGivesAPointMoreWhereEachRoomHasEnough) {
  const auto points = [](double first, double second) {
    const std::array rooms = {DaylitRoom{.name = "1", .area = 1.0, .autonomy = sure(first)},
                              DaylitRoom{.name = "2", .area = 1.0, .autonomy = sure(second)}};
    return rate_daylight(usual("leed"), rooms).points.value;
  };
  EXPECT_EQ(points(60.0, 60.0), 3);
  EXPECT_EQ(points(80.0, 80.0), 3);
  EXPECT_EQ(points(70.0, 50.0), 2);
  EXPECT_EQ(points(45.0, 45.0), 1);
  EXPECT_EQ(points(39.0, 39.0), 0);
}

DaylitRoom dark_office() {
  return {.name = "office",
          .area = 20.0,
          .mean_factor = sure(1.9),
          .least_factor = sure(0.2),
          .uniformity = sure(0.1),
          .mean_hours = sure(1500.0),
          .point_hours = sure(500.0)};
}

// Hea 01 asks for a mean daylight factor of 2 % with a uniformity of 0.3, or 0.3 times 2 % at the
// darkest point.
TEST(DaylightRating, BreeamTakesUniformityOrTheDarkestPoint) {
  const auto verdict = [](double mean, double uniformity, const BoundedFigure& least) {
    DaylitRoom room = dark_office();
    room.mean_factor = sure(mean);
    room.uniformity = sure(uniformity);
    room.least_factor = least;
    const std::array rooms = {room};
    return verdict_on(rate_daylight(usual("breeam-office"), rooms), "office",
                      DaylightFigure::factor_route, 1.0);
  };
  EXPECT_EQ(verdict(2.1, 0.2, sure(0.42)), Verdict::missed);
  EXPECT_EQ(verdict(2.1, 0.35, sure(0.735)), Verdict::met);
  EXPECT_EQ(verdict(4.0, 0.2, sure(0.8)), Verdict::met);
  EXPECT_EQ(verdict(1.9, 0.5, sure(0.95)), Verdict::missed);
  EXPECT_EQ(verdict(2.9, 0.2, {.value = 0.59, .least = 0.57, .most = 0.61}), Verdict::too_close);
}

// 80 m^2 of 100 m^2 comply by hours, whose bound holds the limit of 2000 h or not.
TEST(DaylightRating, BreeamCountsTheAreaThatComplies) {
  DaylitRoom bright = dark_office();
  bright.name = "hall";
  bright.area = 80.0;
  bright.mean_hours = sure(2100.0);
  bright.point_hours = {.value = 2050.0, .least = 2000.0, .most = 2100.0};
  const RatedDaylight rated =
      rate_daylight(usual("breeam-office"), std::array{bright, dark_office()});
  EXPECT_EQ(verdict_on(rated, "hall", DaylightFigure::hours_route, 1.0), Verdict::met);
  EXPECT_EQ(verdict_on(rated, "", DaylightFigure::complying_area, 80.0), Verdict::met);
  EXPECT_EQ(rated.points.least, 2);
  bright.point_hours.least = 1999.0;
  const RatedDaylight close =
      rate_daylight(usual("breeam-office"), std::array{bright, dark_office()});
  EXPECT_EQ(verdict_on(close, "hall", DaylightFigure::hours_route, 1.0), Verdict::too_close);
  EXPECT_EQ(verdict_on(close, "", DaylightFigure::complying_area, 80.0), Verdict::too_close);
  EXPECT_EQ(close.points.least, 0);
  EXPECT_EQ(close.points.value, 2);
  EXPECT_EQ(close.points.available, 2);
}

// Every row of the program's table names the source of its numbers.
TEST(DaylightRating, RowsNameTheirSource) {
  for (const DaylightRating& rating : usual_daylight_ratings()) {
    EXPECT_FALSE(rating.source.empty()) << rating.key;
  }
}

TEST(DaylightRating, TablesAreRefusedWithASentence) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    return read_daylight_ratings(folder.write("mine.toml", text));
  };
  const auto refusal = [&](const std::string& text) {
    return message_of<InputError>([&] { read(text); });
  };
  const std::string half = "[ratings.half]\narea = [{ at_least = 50, points = 1 }]\n";
  const auto mine = read(half + "daylight_factor = 3\n");
  EXPECT_EQ(find_daylight_rating(mine, "half", "--rating").daylight_factor, 3.0);
  EXPECT_TRUE(says(message_of<InputError>([&] { find_daylight_rating(mine, "hafl", "--rating"); }),
                   "--rating: there is no rating 'hafl'. Did you mean 'half'?"));
  EXPECT_TRUE(says(refusal(half), "which rooms comply"));
  EXPECT_TRUE(says(refusal("[ratings.none]\nmean = { lux = 1, hours = 1 }\n"), "one of the two"));
  EXPECT_TRUE(says(refusal(half + "mean = { lux = 300, hours = 9000 }\n"), "mine.toml:3"));
  EXPECT_TRUE(says(refusal(half + "mean = { lux = -3, hours = 2000 }\n"), "mine.toml:3"));
  EXPECT_TRUE(says(refusal(half + "uniformity = 1.2\n"), "mine.toml:3"));
  EXPECT_TRUE(says(refusal("[ratings]\n"), "no rating"));
}

}  // namespace
}  // namespace lightwell::daylight_rating_test
