// Net radiant exchange by the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "radiosity/radiation/radiant_exchange.h"
#include "tests/cli/program.h"

namespace lightwell {
namespace {

// Two squares of side 1 m, one apart, that face each other.
std::string two_squares() {
  return "o low\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
         "o high\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 5 8 7 6\n";
}

class Radiation : public CommandTest {
 protected:
  void SetUp() override { folder.write("squares.obj", two_squares()); }
  Ended radiation(const std::string& surfaces, const std::vector<std::string>& options = {}) {
    folder.write("surfaces.csv", surfaces);
    return run(std::vector<std::string>{"radiation", "squares.obj", "--surfaces", "surfaces.csv",
                                        "-o", "heats.csv"} +
               options);
  }
  // The values of a column of heats.csv, by surface.
  std::map<std::string, double> column(const std::string& name) {
    std::istringstream lines(content_of(folder / "heats.csv"));
    std::map<std::string, double> values;
    std::string line;
    std::size_t wanted = 0;
    while (std::getline(lines, line)) {
      std::vector<std::string> cells;
      std::istringstream parts(line);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      if (values.empty() && cells[0] == "row") {
        wanted = static_cast<std::size_t>(std::ranges::find(cells, name) - cells.begin());
        continue;
      }
      values[cells[1]] = std::stod(cells[wanted]);
    }
    return values;
  }
};

// View factor of equal parallel squares one side apart (Howell's catalogue, C-11).
double between_squares() {
  const double r = std::sqrt(2.0);
  return 2.0 / M_PI *
         (std::log(2.0 / std::sqrt(3.0)) + 2.0 * r * std::atan(1.0 / r) - 2.0 * std::atan(1.0));
}

TEST_F(Radiation, TwoSquaresExchangeByTheNetworkOfResistances) {
  const Ended ended = radiation("surface,emittance,kelvin\nlow,0.8,400\nhigh,0.5,300\n",
                                {"--surroundings", "290", "--json", "--target-error", "1e-6"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  // J = eps E + (1 - eps) (F J' + (1 - F) E0) for both squares: two equations.
  const double F = between_squares();
  const auto power = [](double kelvin) { return stefan_boltzmann * std::pow(kelvin, 4); };
  const double a = 0.8 * power(400) + 0.2 * (1 - F) * power(290), b = 0.2 * F;
  const double c = 0.5 * power(300) + 0.5 * (1 - F) * power(290), d = 0.5 * F;
  const double low = (a + b * c) / (1 - b * d), high = c + d * low;
  const double heat_low = low - F * high - (1 - F) * power(290);
  const double heat_high = high - F * low - (1 - F) * power(290);
  // The factor is of the closed form, for which 1e-7 is stated, and heats differ by its error times
  // 1452 W/m^2, the emission of a black surface of 400 K, at most.
  const double tolerance = 1e-7 * 1452;
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["surfaces"][0]["surface"], "high");
  EXPECT_NEAR(json["surfaces"][0]["heat"].get<double>(), heat_high, tolerance);
  EXPECT_NEAR(json["surfaces"][1]["heat"].get<double>(), heat_low, tolerance);
  EXPECT_NEAR(json["to_surroundings"].get<double>(), heat_low + heat_high, 2 * tolerance);
  // The table repeats the heat with nine digits, which are steps of 1e-6 W.
  EXPECT_NEAR(column("heat").at("\"low\""), json["surfaces"][1]["heat"].get<double>(), 0.5e-6);
}

TEST_F(Radiation, HeatGivenBackGivesTheTemperature) {
  ASSERT_EQ(radiation("surface,emittance,celsius\n*,0.5,26.85\nlow,0.8,126.85\n").code, 0);
  const double heat = column("heat").at("\"low\"");
  EXPECT_DOUBLE_EQ(column("kelvin").at("\"high\""), 300.0);
  ASSERT_EQ(radiation("surface,emittance,kelvin,heat\nlow,0.8,," + std::to_string(heat) +
                      "\nhigh,0.5,300,\n")
                .code,
            0);
  // The heat of some 1100 W was read with nine digits, to 5e-6 W, and T follows with T / 4 of its
  // relative error: 5e-7 K. T itself is written in steps of 1e-6 K.
  EXPECT_NEAR(column("kelvin").at("\"low\""), 400.0, 1e-6);
}

TEST_F(Radiation, GebhartFactorsOfEachRowAddUpToOne) {
  ASSERT_EQ(radiation("surface,emittance,kelvin\n*,0.5,300\n",
                      {"--gebhart", "B.csv", "--script-f", "F.csv"})
                .code,
            0);
  std::istringstream gebhart(content_of(folder / "B.csv")), script(content_of(folder / "F.csv"));
  int rows = 0;
  for (std::string b, f; std::getline(gebhart, b) && std::getline(script, f); ++rows) {
    std::istringstream of_b(b), of_f(f);
    double sum = 0.0;
    int columns = 0;
    for (std::string x, y; std::getline(of_b, x, ',') && std::getline(of_f, y, ','); ++columns) {
      sum += std::stod(x);
      EXPECT_NEAR(std::stod(y), 0.5 * std::stod(x), 1e-11);  // F = eps B; twelve digits
    }
    EXPECT_EQ(columns, 3);         // the surroundings come last
    EXPECT_NEAR(sum, 1.0, 3e-12);  // three numbers of twelve digits
  }
  EXPECT_EQ(rows, 2);
}

TEST_F(Radiation, WrongTablesAreRefusedWithTheirLine) {
  const std::string head = "surface,emittance,kelvin,heat\n";
  struct Case {
    std::string surfaces, says;
  };
  const std::vector<Case> cases{
      {"", "surfaces.csv: describes no surface"},
      {"name,kelvin\n", "surfaces.csv:1: there is no column 'name'"},
      {"emittance,kelvin\n", "surfaces.csv:1: no column is named 'surface'"},
      {"surface,kelvin,kelvin\n", "surfaces.csv:1: two columns are named 'kelvin'"},
      {head + "low,0.5,,\n", "surfaces.csv:2: needs one of kelvin, celsius and heat"},
      {head + "low,0.5,300,10\n", "surfaces.csv:2: needs one of kelvin"},
      {head + "low,1.5,300,\n", "surfaces.csv:2: the emittance is 1.5"},
      {head + "low,0.5,-3,\n", "surfaces.csv:2: the temperature is -3 K"},
      {head + "low,0.5,1e200,\n", "surfaces.csv:2: the temperature is 1e+200 K"},
      {head + "*,0.5,300,\nlow,0,,10\n", "surfaces.csv:3: gives off heat, but has no emittance"},
      {head + "low,0.5,warm,\n", "surfaces.csv:2: kelvin is 'warm', which is not a number"},
      {head + "low,0.5,300,,\n", "surfaces.csv:2: has 5 values"},
      {head + "low,0.5,300,\n", "1 of 2 rows have no line, the first of them of surface 'high'"},
      {head + "*,0.5,300,\nlaw,1,300,\n", "surfaces.csv:3: describes no surface"},
      {head + "low,0.5,300,\n*,0.5,300,\n", "surfaces.csv:2: describes no surface"}};
  for (const auto& [surfaces, sentence] : cases) {
    const Ended ended = radiation(surfaces);
    EXPECT_EQ(ended.code, 3) << surfaces;
    EXPECT_TRUE(says(ended.err, sentence));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "heats.csv"));
  EXPECT_EQ(radiation(head + "*,1,300,\n", {"--surroundings", "-5"}).code, 2);
}

// Heat that only a temperature below zero could give: the table has no line at fault alone, so the
// message names the surface.
TEST_F(Radiation, HeatsThatCannotBeNameTheSurface) {
  const Ended ended = radiation("surface,emittance,kelvin,heat\nhigh,1,300,\nlow,1,,-1e6\n");
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_TRUE(
      says(ended.err, "surfaces.csv: surface 'low', facet 1: to give off -1e+06 W it would"));
}

TEST_F(Radiation, NamesMayHoldBracketsAndCommas) {
  std::string squares = two_squares();
  squares.replace(squares.find("o high"), 6, "o high, [2]");
  folder.write("squares.obj", squares);
  EXPECT_EQ(radiation("surface,kelvin\nlow,300\n\"high, [2]\",400\n").code, 0);
  EXPECT_EQ(radiation("surface,kelvin\nlow,300\n\"high, ?[1-3]?\",400\n").code, 0);
  EXPECT_EQ(radiation("surface,kelvin\nlow,300\nhigh*,400\n").code, 0);
}

TEST_F(Radiation, TwoResultsDoNotShareAFile) {
  const Ended ended = radiation("surface,kelvin\n*,300\n", {"--gebhart", "./heats.csv"});
  EXPECT_NE(ended.code, 0);
  EXPECT_TRUE(says(ended.err, "writes another result into the same file"));
}

TEST_F(Radiation, ATableIsNotReplacedByItsResult) {
  folder.write("heats.csv", "surface,kelvin\n*,300\n");
  const Ended ended =
      run({"radiation", "squares.obj", "--surfaces", "heats.csv", "-o", "heats.csv"});
  EXPECT_NE(ended.code, 0);
  EXPECT_EQ(content_of(folder / "heats.csv"), "surface,kelvin\n*,300\n");
}

}  // namespace
}  // namespace lightwell
