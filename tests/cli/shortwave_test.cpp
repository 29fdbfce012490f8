// Sky view factors and net shortwave flux by the command line.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
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
  // The numbers of a file from column `first` on, by row.
  std::vector<std::vector<double>> table(std::size_t first, const char* file = "k.csv") {
    std::istringstream lines(content_of(folder / file));
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
TEST_F(Shortwave, FacetsHaveTheAlbedosOfTheirTypesInACaseOfUdales) {
  std::filesystem::create_directory(folder / "case");
  folder.write("case/facets.inp.001", "# type, normal\n 1 0 0 1\n  -2 1 0 0\n 1 -1 0 0\n");
  const std::string types = "# one\n# two\n# id lGR z0 z0h al em\n1 0 0.05 0.0004 0.5 0.85\n";
  folder.write("case/factypes.inp.001", types + "-2 0 0.05 0.0004 0.2 0.9\n");
  const std::vector<std::string> wanted{"--udales", "case", "--udales-albedos"};
  const Ended ended = shortwave(wanted);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto rows = table(4);
  EXPECT_EQ(rows[0][0], 0.5);
  EXPECT_EQ(rows[1][0], 0.2);
  EXPECT_EQ(rows[2][0], 0.5);
  folder.write("case/factypes.inp.001", types);
  EXPECT_TRUE(says(shortwave(wanted).err, "facets.inp.001:3: the facet has the type -2"));
  folder.write("case/facets.inp.001", "# type\n1\n1\n");
  EXPECT_TRUE(says(shortwave(wanted).err, "has 2 facets, and the model 3"));
  folder.write("case/factypes.inp.001", "1 0 0.05 0.0004 1.5\n");
  EXPECT_TRUE(says(shortwave(wanted).err, "factypes.inp.001:1: the albedo is 1.5"));
  folder.write("case/factypes.inp.001", "1 0 0.05 0.0004\n");
  EXPECT_TRUE(says(shortwave(wanted).err, "needs a number in column 5"));
  for (const char* number : {"1e300", "1.5"}) {
    folder.write("case/factypes.inp.001", std::string(number) + " 0 0.05 0.0004 0.5\n");
    EXPECT_TRUE(says(shortwave(wanted).err, "is no type of facets"));
  }
}

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

// At 48 degrees north, 0 east. Every hour of 21 June from 4 to 20 o'clock has 500 W/m2 across the
// sun's rays, and 100 W/m2 of the sky; all other days are dark.
std::string june_weather() {
  std::string text =
      "place Test\nlatitude 48\nlongitude 0\ntime_zone 0\nsite_elevation 0\n"
      "weather_data_file_units 1\n";
  for (int hour = 4; hour < 20; ++hour) text += fmt::format("6 21 {}.5 500 100\n", hour);
  return text;
}

TEST_F(Shortwave, HoursOfAWeatherFileAddUp) {
  folder.write("june.wea", june_weather());
  folder.write("p.csv", "x,y,z,nx,ny,nz\n5,500,0,0,0,1\n5,500,20,0,0,1\n");
  const std::vector<std::string> wanted{"--albedo", "0.3",   "--weather",       "june.wea",
                                        "--points", "p.csv", "--points-output", "q.csv"};
  const Ended ended = shortwave(
      wanted + std::vector<std::string>{"--days", "06-20..06-22", "--hourly", "hours", "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  ASSERT_EQ(json["hours"], 16);
  const double arriving = json["arriving_kwh"].get<double>();
  EXPECT_NEAR(json["absorbed_kwh"].get<double>() + json["escaped_kwh"].get<double>(), arriving,
              1e-6 * arriving);
  const auto rows = table(5);  // sky_view_factor, then kWh/m2: direct, diffuse, reflected, net
  ASSERT_EQ(rows.size(), 3u);
  // Both are written with nine digits. The sky fills less than 0.6 of any view here, so both are
  // below 1 and rounded by 5e-10; a rounded view factor counts 16 h x 100 W/m2 = 1.6 kWh/m2 times.
  for (const auto& row : rows) EXPECT_NEAR(row[2], 1.6 * row[0], 5e-10 + 1.6 * 5e-10);
  // hours.csv, and net.npy of 128 bytes and 16 x 3 floats, hold the same.
  std::istringstream lines(content_of(folder / "hours/hours.csv"));
  std::string line;
  std::getline(lines, line);
  double sum = 0.0, up = 0.0;
  for (int h = 0; h < 16; ++h) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream parts(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 11u);
    EXPECT_EQ(cells[3], fmt::format("{:02d}:30", 4 + h));
    sum += std::stod(cells[8]);
    up += std::sin(std::stod(cells[4]) * std::numbers::pi / 180.0);
  }
  // Each hour is written with nine digits, so that it is rounded by 5e-9 of itself at most; the
  // total comes with all digits. The sum of all hours is then off by 5e-9 of the total at most.
  EXPECT_NEAR(sum / 1000.0, arriving, 5e-9 * arriving);
  const std::string net = content_of(folder / "hours/net.npy");
  ASSERT_EQ(net.size(), 128 + 16 * 3 * sizeof(float));
  double of_road = 0.0;
  for (std::size_t h = 0; h < 16; ++h) {
    float value = 0.0f;
    std::memcpy(&value, net.data() + 128 + h * 3 * sizeof(float), sizeof(float));
    of_road += double{value};
  }
  // The place of the last bit of a float below 512 is 2^-15, so each of 16 hours is rounded by
  // 2^-16 W/m2 at most. The sum is below 10 kWh/m2 and has nine digits: 5e-9.
  EXPECT_NEAR(of_road / 1000.0, rows[0][4], 16 * 0x1p-16 / 1000.0 + 5e-9);
  // The second point, above the roofs, has all of the sun and all of the sky, and no wall in view.
  std::istringstream points(content_of(folder / "q.csv"));
  std::getline(points, line);
  EXPECT_EQ(line, "x,y,z,nx,ny,nz,sky_view_factor,direct_kwh,diffuse_kwh,reflected_kwh,total_kwh");
  std::getline(points, line);
  std::getline(points, line);
  EXPECT_TRUE(line.starts_with("5,500,20,0,0,1,1,"));
  // Angles have four decimals: 5e-5 degrees in each of 16 hours. Nine digits of a number below 10.
  EXPECT_NEAR(std::stod(line.substr(std::string("5,500,20,0,0,1,1,").size())), 0.5 * up,
              0.5 * 16 * 5e-5 * std::numbers::pi / 180.0 + 5e-9);
  EXPECT_NE(line.find(",1.6,0,"), std::string::npos);
  // Without days the year has the same 16 hours.
  ASSERT_EQ(shortwave(wanted).code, 0);
  EXPECT_EQ(table(5), rows);
}

// Open ground has the weather's light whatever the sky. Of an instant, the wall that faces the sun
// is brighter than under an even sky, and the other one darker.
TEST_F(Shortwave, HoursUnderPerezSkyLightOpenGroundAsTheWeatherHasIt) {
  folder.write("june.wea", june_weather());
  folder.write("p.csv", "x,y,z,nx,ny,nz\n5,500,20,0,0,1\n");
  const std::vector<std::string> wanted{"--albedo", "0.3",   "--weather",       "june.wea",
                                        "--points", "p.csv", "--points-output", "q.csv"};
  const Ended ended = shortwave(wanted + std::vector<std::string>{"--sky", "perez", "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(nlohmann::json::parse(ended.out)["sky"], "perez");
  const auto rows = table(5);
  const std::vector<double> cells = table(0, "q.csv").at(0);
  ASSERT_EQ(cells.size(), 11u);
  // Sums of 577 floats in each of 16 hours of 100 W/m2, in kWh/m2.
  EXPECT_NEAR(cells[8], 1.6, 1.6 * 2 * 577 * 0x1p-24);
  ASSERT_EQ(shortwave(wanted).code, 0);
  EXPECT_NE(table(5), rows);
  const auto instant = [&](const std::string& sky, const std::vector<std::string>& more) {
    EXPECT_EQ(shortwave(std::vector<std::string>{"--albedo", "0.3", "--sun", "40,90", "--direct",
                                                 "700", "--diffuse", "100", "--sky", sky} +
                        more)
                  .code,
              0);
    return table(5);
  };
  const auto even = instant("even", {}), clear = instant("perez", {"--date", "06-21"});
  EXPECT_EQ(even[0][0], clear[0][0]);  // the sky view factor
  EXPECT_GT(clear[1][2], even[1][2]);  // the western wall faces the sun
  EXPECT_LT(clear[2][2], even[2][2]);
}

TEST_F(Shortwave, PointsOfAnInstantHaveSunSkyAndReflections) {
  folder.write("p.csv", "0,500,10,1,0,0\n");
  const Ended ended =
      shortwave({"--albedo", "0.3", "--sun", "45,90", "--direct", "800", "--diffuse", "100",
                 "--points", "p.csv", "--points-output", "q.csv"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::vector<double> cells = table(0, "q.csv").at(0);
  ASSERT_EQ(cells.size(), 11u);
  // Five metres below the tops the sky ends at atan(5 / 10) above the horizon.
  const double sky = 0.5 * (1.0 - 5.0 / std::hypot(5.0, 10.0));
  EXPECT_NEAR(cells[6], sky, 4.0 * std::sqrt(sky * (1.0 - sky) / 16384.0));
  // All numbers have nine digits. The sun and the total are hundreds of W/m2, rounded by 5e-7; sky
  // and reflections are tens, rounded by 5e-8; the view factor is rounded by 5e-10, and counts 100
  // times. The sun's 800 sin(45 degrees) is exact but for doubles.
  EXPECT_NEAR(cells[7], 800 * std::sqrt(0.5), 5e-7);
  EXPECT_NEAR(cells[8], 100 * cells[6], 5e-8 + 100 * 5e-10);
  EXPECT_GT(cells[9], 0.0);
  EXPECT_NEAR(cells[10], cells[7] + cells[8] + cells[9], 2 * 5e-7 + 2 * 5e-8);
}

TEST_F(Shortwave, WrongOptionsAndTablesAreRefused) {
  struct Case {
    std::vector<std::string> options;
    int code;
    std::string says;
  };
  folder.write("white.csv", "surface,albedo\n*,1\n");
  folder.write("june.wea", june_weather());
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
      {{"--case", "001"}, 2, "the number names the files of --udales FOLDER; give the folder"},
      {{"--points", "white.csv"}, 2, "points are read from --points FILE and written to"},
      {{"--points-output", "q.csv"}, 2, "give both"},
      {{"--days", "06-21"}, 2, "days are those of --weather FILE"},
      {{"--hourly", "hours"}, 2, "hours are those of --weather FILE"},
      {{"--weather", "june.wea", "--days", "6/21"}, 2, "'6/21' is no span of days"},
      {{"--weather", "june.wea", "--days", "02-30..03-01"}, 2, "is no span of days"},
      {{"--weather", "june.wea"}, 2, "give --albedo A"},
      {{"--weather", "june.wea", "--albedo", "0", "--diffuse", "9"}, 2, "give either"},
      {{"--weather", "june.wea", "--albedo", "0", "--udales", "case"}, 2, "have one instant"},
      {{"--weather", "june.wea", "--albedo", "0", "--days", "12-24"}, 3, "no hour of the days"},
      {{"--rays", "48"}, 2, "48"},
      {{"--udales-albedos"}, 2, "the case lies in --udales FOLDER"},
      {{"--udales", "case", "--udales-albedos", "--albedo", "0.2"}, 2, "come from one place"},
      {{"--sky", "blue"}, 2, "blue"},
      {{"--sky", "perez", "--diffuse", "9", "--albedo", "0"},
       2,
       "follows from the sun and the date"},
      {{"--date", "06-21"}, 2, "that of an instant under --sky perez"},
      {{"--weather", "june.wea", "--albedo", "0", "--sky", "perez", "--date", "06-21"},
       2,
       "no --weather"},
      {{"--sky", "perez", "--date", "02-30", "--sun", "9,9"}, 2, "'02-30' is no date"},
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
