// Sky view factors and net shortwave flux by the command line.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell {
namespace {

// A road of 10 m, and walls of 15 m to the west and to the east, a kilometre long.
const std::string street =
    "v 0 0 0\nv 10 0 0\nv 10 1e3 0\nv 0 1e3 0\nv 0 0 15\nv 10 0 15\nv 10 1e3 15\nv 0 1e3 15\n"
    "o road\nf 1 2 3 4\no west\nf 1 4 8 5\no east\nf 3 2 6 7\n";

class Shortwave : public CommandTest {
 protected:
  void SetUp() override { folder.write("street.obj", street); }
  Ended shortwave(const std::vector<std::string>& options) {
    return run(std::vector<std::string>{"shortwave", "street.obj", "-o", "k.csv"} + options);
  }
  // The numbers of k.csv from column `first` on, by row.
  std::vector<std::vector<double>> table(std::size_t first) {
    std::istringstream lines(content_of(folder / "k.csv"));
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream parts(line);
      std::string cell;
      rows.emplace_back();
      for (std::size_t c = 0; std::getline(parts, cell, ','); ++c) {
        if (c >= first) rows.back().push_back(std::stod(cell));
      }
    }
    return rows;
  }
};

TEST_F(Shortwave, TheSunShinesFromItsAzimuthAndFilesOfUdalesHoldTheTable) {
  folder.write("albedos.csv", "surface,albedo\n*,0.4\nroad,0.1\n");
  const Ended ended =
      shortwave({"--surfaces", "albedos.csv", "--sun", "45,90", "--direct", "800", "--diffuse",
                 "100", "--udales", "case", "--case", "012", "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto rows = table(4);  // albedo, sky_view_factor, direct, diffuse, reflected, net
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0][0], 0.1);
  EXPECT_EQ(rows[1][0], 0.4);
  // An end of 10 m x 15 m sends less than half of what leaves it to the road of 10 m x 1000 m; by
  // reciprocity less than 15 / 2000 of the road's light goes through either end.
  EXPECT_NEAR(rows[0][1], std::hypot(1.5, 1.0) - 1.5, 2 * 15.0 / 2000);
  EXPECT_EQ(rows[0][2], 0.0);
  // The shadow's edge cuts one of 16384 strips of the wall, each 0.9 mm high. Rays in single
  // precision, 1000 m x 6e-8 = 0.06 mm, take no more than its neighbour for cut.
  const double strip = 800 * std::sqrt(0.5) / 16384;
  EXPECT_NEAR(rows[1][2], 800 * std::sqrt(0.5) * 10 / 15, 2 * strip);
  EXPECT_EQ(rows[2][2], 0.0);
  for (const auto& row : rows) {
    // Nine digits: a view factor is rounded by 5e-10, W/m2 below 100 by 5e-8, below 1000 by 5e-7.
    EXPECT_NEAR(row[3], 100 * row[1], 100 * 5e-10 + 5e-8);
    EXPECT_NEAR(row[5], (1 - row[0]) * (row[2] + row[3] + row[4]), 3 * 5e-7 + 5e-8);
  }
  const auto json = nlohmann::json::parse(ended.out);
  const double arriving = json["arriving"].get<double>();
  EXPECT_NEAR(json["absorbed"].get<double>() + json["escaped"].get<double>(), arriving,
              1e-6 * arriving);
  const auto lines = [&](const char* file) {
    const std::string text = content_of(folder / file);
    return std::ranges::count(text, '\n');
  };
  EXPECT_EQ(lines("case/svf.inp.012"), 4);  // a heading, and a line for each facet
  EXPECT_EQ(lines("case/netsw.inp.012"), 4);
  EXPECT_EQ(lines("case/Sdir.txt"), 3);
  EXPECT_EQ(lines("case/vfsparse.inp.012"), json["nnz"].get<int>());
  std::istringstream factors(content_of(folder / "case/vfsparse.inp.012"));
  int i = 0, j = 0;
  double F = 0.0;
  factors >> i >> j >> F;
  EXPECT_EQ(i, 1);
  EXPECT_EQ(j, 2);
  // Six decimals in the file, 5e-7, and two factors of 0.35 that are floats, 3e-8.
  EXPECT_NEAR(F, 0.5 * (1.0 - rows[0][1]), 5e-7 + 3e-8);
}

// The facet faces +z, and the model is no longer along y than along z: y would be up.
TEST_F(Shortwave, TheZenithIsThatOfTheOption) {
  folder.write("street.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 9\no a\nf 1 2 3 4\no b\nf 1 2 5\n");
  ASSERT_EQ(shortwave({"--up", "z"}).code, 0);
  EXPECT_GT(table(5)[0][0], 0.5);
  ASSERT_EQ(shortwave({"--udales", "case"}).code, 0);
  EXPECT_GT(table(5)[0][0], 0.5);
  ASSERT_EQ(shortwave({}).code, 0);
  EXPECT_LE(table(5)[0][0], 0.5 + 0.016);  // four standard errors of 16384 rays
}

TEST_F(Shortwave, WrongOptionsAndTablesAreRefused) {
  struct Case {
    std::vector<std::string> options;
    int code;
    std::string says;
  };
  folder.write("white.csv", "surface,albedo\n*,1\n");
  folder.write("empty.csv", "surface,albedo\n*,\n");
  const std::vector<Case> cases{
      {{"--direct", "800", "--albedo", "0.2"}, 2, "the sun needs a place"},
      {{"--diffuse", "100"}, 2, "give --albedo A, or --surfaces FILE.csv"},
      {{"--sun", "0,90"}, 2, "'0,90' is no place of the sun"},
      {{"--sun", "45"}, 2, "'45' is no place of the sun"},
      {{"--albedo", "1"}, 2, "an albedo from 0 to 0.99 is needed, not '1'"},
      {{"--diffuse", "nan", "--albedo", "0"}, 2, "not 'nan'"},
      {{"--up", "x"}, 2, "x"},
      {{"--udales", "case", "--case", "1"}, 2, "three digits are needed, not '1'"},
      {{"--surfaces", "white.csv"}, 3, "white.csv:2: the albedo is 1; it lies from 0 to 0.99"},
      {{"--surfaces", "empty.csv"}, 3, "empty.csv:2: has no albedo"}};
  for (const auto& [options, code, sentence] : cases) {
    const Ended ended = shortwave(options);
    EXPECT_EQ(ended.code, code) << sentence;
    EXPECT_TRUE(says(ended.err, sentence));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "k.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "case"));
}

}  // namespace
}  // namespace lightwell
