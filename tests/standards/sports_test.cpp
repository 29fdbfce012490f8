#include "standards/sports.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::sports_test {
namespace {

// A level grid of columns x rows cells.
LuxGrid level_grid(double length, double width, int columns, int rows) {
  LuxGrid grid{
      .step_u = length / columns, .step_v = width / rows, .columns = columns, .rows = rows};
  for (int i = 0; i < columns * rows; ++i) {
    grid.cell.push_back(i);
    grid.points.push_back(
        {.position = {(i % columns + 0.5) * grid.step_u, (i / columns + 0.5) * grid.step_v, 0.3}});
  }
  return grid;
}

/// p = 0.2 * 5^log10(d): of 105 m 5.17 m, of 40 m 2.63 m, of 36 m 2.46 m. 105 / p = 20.3, so 21
/// points, 5 m apart, and 68 / 5 = 13.6, so 13; 40 / p = 15.2, 20 / (40 / 15) = 7.5; 36 / p = 14.7.
TEST(SportGrid, HasTheOddNumbersOfTheStandard) {
  const auto points = [](double length, double width) {
    const LuxGrid grid = sport_grid(level_grid(length, width, 10, 10));
    return std::pair(grid.columns, grid.rows);
  };
  EXPECT_EQ(points(105.0, 68.0), std::pair(21, 13));
  EXPECT_EQ(points(40.0, 20.0), std::pair(15, 7));
  EXPECT_EQ(points(36.0, 18.0), std::pair(15, 7));
  EXPECT_EQ(points(18.0, 36.0), std::pair(7, 15));
}

/// The points keep their height above the corner and leave out where the first grid has none.
TEST(SportGrid, KeepsTheOutlineAndTheHeight) {
  LuxGrid area = level_grid(40.0, 20.0, 4, 2);
  area.cell.pop_back();
  area.points.pop_back();  // x > 30 m, y > 10 m
  const LuxGrid grid = sport_grid(area);
  for (const Probe& point : grid.points) {
    EXPECT_FALSE(point.position.x() > 30.0 && point.position.y() > 10.0);
    EXPECT_NEAR(point.position.z(), 0.3, 1e-12);
  }
  // Columns from 30 m on: 3.75 of 15, whose middles are 4; rows above 10 m: 3.5 of 7, so 3 or 4;
  // the middle row at 10 m lies on the edge of the cell above.
  EXPECT_EQ(grid.points.size(), 15u * 7u - 4u * 4u);
}

/// Neighbours along and across: 100, 80, 50 beside each other, and 60 below the first: the greatest
/// change is 40 % from 100 to 60, greater than 37.5 % from 80 to 50. 50 and 60 end two rows and are
/// no neighbours. Bounds of 1 lx each make 2 of 100 there, and 2 of 80 from 80 to 50: no change
/// lies above 40 + 2 = 42 %. Bounds of 3 lx of the points of 80 and 50 make 6 of 80, so the change
/// there may be 37.5 + 7.5 = 45 %, 5 above the greatest. An unknown bound leaves the gradient
/// unknown.
TEST(Sports, GradientIsTheGreatestChangeBetweenNeighbours) {
  LuxGrid grid = level_grid(3.0, 2.0, 3, 2);
  grid.cell.resize(4);
  LuxField field = field_of(Eigen::Array4d(100, 80, 50, 60));
  field.lux_within.setConstant(1.0);
  const Gradient gradient = greatest_gradient(grid, field);
  EXPECT_NEAR(gradient.percent, 40.0, 1e-12);
  EXPECT_NEAR(gradient.within, 2.0, 1e-12);
  field.lux_within = Eigen::Array4d(0.0, 3.0, 3.0, 0.0);
  EXPECT_NEAR(greatest_gradient(grid, field).percent, 40.0, 1e-12);
  EXPECT_NEAR(greatest_gradient(grid, field).within, 5.0, 1e-12);
  field.lux_within[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(greatest_gradient(grid, field).within));
}

std::vector<Figure> figures_of(const std::vector<Requirement>& requirements) {
  std::vector<Figure> figures;
  for (const Requirement& one : requirements) figures.push_back(one.figure);
  return figures;
}

/// Football of class II: 200 lx, U_0 0.6, R_G 50, R_a 60; and limits towards a camera.
TEST(Sports, AreHeldToTheLimitsOfTheirClass) {
  const LuxGrid grid = level_grid(2.0, 1.0, 2, 1);
  const LuxField pitch = field_of(Eigen::Array2d(150, 270));
  LuxField upright = field_of(Eigen::Array2d(60, 100));
  upright.lux_within.setZero();
  const SportPlace place{.name = "pitch",
                         .pitch = {"pitch", &pitch},
                         .cameras = {{{"main", &upright}, &grid}},
                         .observers = {{"corner", 48.0, 0.5}},
                         .luminaires = {{"mast", 70.0, 1.0}, {"old mast", 58.0, 1.0}}};
  const SportLimits& limits = sport_limits(usual_sports(), "football", 2, "area 'pitch'");
  const auto all = sport_requirements(
      place, limits, {.mean = 90.0, .uniformity = 0.7, .contrast = 0.6, .gradient = 30.0});
  using enum Figure;
  EXPECT_EQ(figures_of(all),
            (std::vector{mean, uniformity, vertical_mean, vertical_uniformity, vertical_contrast,
                         gradient, glare_rating, colour_rendering}));
  std::vector<Verdict> verdicts;
  for (const Requirement& one : all) verdicts.push_back(verdict_of(one));
  // 210 lx, 150 / 210 = 0.71; 80 lx, 0.75, 0.6, 40 %; 48 of 50; 58 of 60.
  using enum Verdict;
  EXPECT_EQ(verdicts, (std::vector{met, met, missed, met, met, missed, met, missed}));
  EXPECT_EQ(all.back().place, "old mast");
  // Without television and without a known spectrum.
  EXPECT_EQ(figures_of(sport_requirements({.name = "pitch", .pitch = place.pitch}, limits, {})),
            (std::vector{mean, uniformity}));
}

TEST(Sports, AreReadFromATable) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    folder.write("sports.toml", text);
    return read_sports(folder / "sports.toml");
  };
  const std::string classes = "I = { mean = 3 }\nII = { mean = 2 }\nIII = { mean = 1 }\n";
  const auto sports = read("[sports.curling]\n" + classes);
  EXPECT_EQ(sport_limits(sports, "curling", 2, "area").mean, 2.0);
  const auto refusal = [&](const std::string& text) {
    return message_of<InputError>([&] { read(text); });
  };
  EXPECT_TRUE(says(refusal("[sports.curling]\nI = { mean = 3 }\n"), "'II'"));
  EXPECT_TRUE(says(refusal("[sports.curling]\nI = { mean = 0 }\n"), "sports.toml:2"));
  EXPECT_TRUE(says(refusal("[sports]\n"), "no sport"));
  EXPECT_TRUE(says(message_of<InputError>([&] { sport_limits(sports, "curlin", 1, "area 'ice'"); }),
                   "area 'ice': there is no sport 'curlin'. Did you mean 'curling'?"));
}

}  // namespace
}  // namespace lightwell::sports_test
