// Files and errors of 'lightwell daylight'.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "tests/cli/program.h"

namespace lightwell::daylight_command_test {
namespace {
using Words = std::vector<std::string>;
using Json = nlohmann::json;

// A court of 4 m x 4 m x 2 m without a roof, z up, walls and floor of reflectance 0.5; `roof`
// closes it.
std::string court(bool roof = false) {
  std::string text =
      "unit = \"m\"\n[materials.grey]\nreflectance = 0.5\n"
      "[sky]\nkind = \"cie-overcast\"\nilluminance = 1\nup = [0, 0, 1]\n";
  const auto add = [&](const std::string& name, const std::string& polygon) {
    text +=
        "[[surfaces]]\nname = \"" + name + "\"\nmaterial = \"grey\"\npolygon = " + polygon + "\n";
  };
  add("floor", "[[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]");
  add("south", "[[0, 0, 0], [0, 0, 2], [4, 0, 2], [4, 0, 0]]");
  add("north", "[[0, 4, 0], [4, 4, 0], [4, 4, 2], [0, 4, 2]]");
  add("west", "[[0, 0, 0], [0, 4, 0], [0, 4, 2], [0, 0, 2]]");
  add("east", "[[4, 0, 0], [4, 0, 2], [4, 4, 2], [4, 4, 0]]");
  if (roof) add("roof", "[[0, 0, 2], [0, 4, 2], [4, 4, 2], [4, 0, 2]]");
  return text;
}

// The court under a roof of clear glass, and `windows`, a group of that roof.
std::string glazed_court(const std::string& windows = "", const std::string& roof = "clear") {
  return court() +
         "[materials.clear]\nglass = { ior = 1.5, thin = true }\n"
         "[materials.fabric]\ntranslucent = 0.05\nreflectance = 0.5\n"
         "[[surfaces]]\nname = \"roof\"\nmaterial = \"" +
         roof +
         "\"\npolygon = [[0, 0, 2], [0, 4, 2], [4, 4, 2], [4, 0, 2]]\n"
         "[[grids]]\nsurface = \"floor\"\nheight = 0.8\nspacing = 1\n" +
         windows;
}

const std::string roof_states =
    "[[windows]]\nname = \"skylight\"\nsurfaces = \"roof\"\n"
    "states = [{ name = \"open\" }, { name = \"blind\", material = \"fabric\" }]\n";

const std::string weather =
    "place Testville\nlatitude 50\nlongitude 0\ntime_zone 0\nsite_elevation 0\n"
    "weather_data_file_units 1\n6 21 9.5 500 150\n6 21 12.5 700 150\n12 21 12.5 0 50\n";

class DaylightCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("court.toml", court());
    folder.write("year.wea", weather);
  }
  Words command(const Words& more) {
    return Words{"daylight", "court.toml",       "--weather", "year.wea", "-o",
                 "year",     "--max-patch-size", "1",         "--rays",   "64"} +
           more;
  }
  std::string text_of(const std::string& file) {
    std::ifstream in(folder / ("year/" + file), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

// The numbers of a line of CSV.
std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> values;
  std::istringstream words(line);
  for (std::string word; std::getline(words, word, ',');) values.push_back(std::stod(word));
  return values;
}

// Form factor to the court's opening, mean over the sensors of sensors.csv below it.
double mean_form_factor_of_opening(const std::string& csv) {
  const std::vector<Eigen::Vector3d> opening = {{0, 0, 2}, {0, 4, 2}, {4, 4, 2}, {4, 0, 2}};
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  double sum = 0.0;
  int count = 0;
  while (std::getline(lines, line)) {
    const std::vector<double> at = numbers_of(line);
    if (at[2] > 2.0) continue;
    sum += std::abs(
        point_to_polygon({at[0], at[1], at[2]}, Eigen::Vector3d::UnitZ(), std::span(opening)));
    ++count;
  }
  return sum / count;
}

int lines_of(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_F(DaylightCommand, WritesSensorsHoursAndAPage) {
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,0.8,0,0,1\n2,2,5,0,0,1\n");
  const Json json = run_json(
      command({"--plane", "floor@0.8", "--spacing", "1", "--points", "p.csv", "--hourly"}));
  ASSERT_EQ(json["rooms"].size(), 2u);
  const Json &grid = json["rooms"][0], &points = json["rooms"][1];
  EXPECT_EQ(grid["name"], "floor + 0.8 m");
  EXPECT_EQ(points["sensors"], 2);
  EXPECT_EQ(json["hours_with_light"], 3);
  const int sensors = grid["sensors"].get<int>() + 2;
  EXPECT_EQ(lines_of(text_of("sensors.csv")), sensors + 1);
  EXPECT_EQ(lines_of(text_of("hours.csv")), 4);
  EXPECT_EQ(text_of("illuminance.npy").size(), 128u + sizeof(float) * 3 * sensors);
  // A sensor that faces up, 3 m above the walls, sees the whole dome. Six digits are written, to
  // 5e-4; the sum of 2305 floats rounds to about sqrt(2305) 2^-24 of 100, 3e-4.
  const std::string csv = text_of("sensors.csv");
  const std::string last = csv.substr(csv.rfind(',') + 1);
  EXPECT_NEAR(std::stod(last), 100.0, 5e-4 + 3e-4);
  // The overcast sky is brightest overhead, where the opening is, so the opening gives at least its
  // form factor; reflections add to that. The dome that the walls hide, up to atan(1.2 / 2), has
  // 0.72 of open ground's luminosity in the mean, and surfaces of reflectance 0.5 at most 0.5.
  EXPECT_GT(grid["mean_daylight_factor"].get<double>(), 100.0 * mean_form_factor_of_opening(csv));
  EXPECT_LT(grid["mean_daylight_factor"], 100.0);
  EXPECT_LE(grid["mean_lux"]["least"], grid["mean_lux"]["value"]);
  const std::string page = text_of("year.html");
  for (const char* part : {"<svg", "Daylight autonomy", "Perez", "Testville"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(Json::parse(text_of("year.json"))["rooms"], json["rooms"]);
}

// A page of three hours has a term for each, and a fourth that is nothing.
TEST_F(DaylightCommand, WritesAPageToWalkIn) {
  const Json json = run_json(command({"--plane", "floor@0.8", "--walk", "walk.html"}));
  EXPECT_EQ(json["walk"]["terms"], 4);
  // The root of 1 - a / b, where a and b are equal sums of the squares of 256 vertices, three bands
  // at most and three hours: n = 2304 terms, each sum rounds to n 2^-53 = 2.6e-13 at most, and the
  // root of two such is 7.2e-7.
  EXPECT_LT(json["walk"]["relative_error"], 7.2e-7);
  std::ifstream in(folder / "walk.html", std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(json["walk"]["bytes"], page.size());
  EXPECT_NE(page.find("\"place\":\"Testville\""), std::string::npos);
  // The view begins among the sensors, 1.6 m over the floor.
  const std::size_t camera = page.find("\"cameras\":[{\"name\":\"room\"");
  ASSERT_NE(camera, std::string::npos);
  const std::size_t begin = page.find('[', page.find("\"position\"", camera));
  const Json eye = Json::parse(page.substr(begin, page.find(']', begin) + 1 - begin));
  // The way to the floor is a ray of 0.8 m in single precision, to 2^-24 of its two ends at most 1
  // m from the middle of the scene: 1.2e-7.
  EXPECT_NEAR(eye[1].get<double>(), 1.6, 1.2e-7);
}

// Small patches make the page take seconds, which begin once the year is written.
TEST_F(DaylightCommand, CtrlCWithinThePageKeepsTheYear) {
  const Words fine = {"daylight", "court.toml", "--weather", "year.wea",         "-o",
                      "year",     "--plane",    "floor@0.8", "--max-patch-size", "0.12",
                      "--rays",   "64",         "--walk",    "walk.html",        "--sky",
                      "1"};
  Running running(folder / "", fine);
  const auto is_written = [&] { return std::filesystem::exists(folder / "year/year.json"); };
  for (int i = 0; i < 1200 && !is_written(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(is_written()) << running.err();
  running.signal(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 4) << ended.err;
  EXPECT_NE(ended.err.find("the page 'walk.html' is not written"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "walk.html"));
  EXPECT_EQ(Json::parse(text_of("year.json"))["rooms"].size(), 1u);
}

// Level ground 5 m above the court has the sun and the dome of the hour.
TEST_F(DaylightCommand, HoursAreThoseOfTheWeather) {
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,5,0,0,1\n");
  ASSERT_EQ(run(command({"--points", "p.csv", "--hourly"})).code, 0);
  const std::string hours = text_of("hours.csv"), light = text_of("illuminance.npy");
  std::istringstream lines(hours);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "hour,month,day,standard_time,sun_altitude,sun_azimuth,sun_lux,dome_lux");
  for (int row = 0; row < 3; ++row) {
    std::getline(lines, line);
    const std::vector<double> values = numbers_of(line);
    float lux = 0.0f;
    light.copy(reinterpret_cast<char*>(&lux), sizeof lux, 128 + sizeof lux * row);
    const double expected = values[7] + values[6] * std::sin(values[4] * 3.14159265358979 / 180.0);
    // Cosines vary over the disc by half its radius, 0.0047; four standard errors of 16 rays. Lux
    // are written with six digits.
    EXPECT_NEAR(double{lux}, expected, 4.0 * 0.5 * 0.0047 / 4.0 * values[6] + 1e-5 * expected)
        << line;
  }
}

// The sums are those of the file's three hours.
TEST_F(DaylightCommand, InfoDescribesWeather) {
  const Json json = run_json({"info", "year.wea"});
  EXPECT_EQ(json["kind"], "weather");
  EXPECT_EQ(json["place"], "Testville");
  EXPECT_EQ(json["hours"], 8760);
  EXPECT_EQ(json["hours_with_light"], 3);
  EXPECT_EQ(json["direct_normal_kWh_m2"], 1.2);
  EXPECT_EQ(json["diffuse_horizontal_kWh_m2"], 0.35);
  EXPECT_GT(json["brightest_hour_klx"].get<double>(), 0.0);
  EXPECT_EQ(json["notes"].size(), 1u);
}

// A roof that is always closed is one of the blind's material, but for ASE and the daylight factor,
// which are without blinds.
TEST_F(DaylightCommand, ABlindThatIsAlwaysClosedIsItsMaterial) {
  folder.write("court.toml", glazed_court("", "fabric"));
  const Json fabric = run_json(command({}))["rooms"][0];
  folder.write("court.toml", glazed_court());
  const Json open = run_json(command({}))["rooms"][0];
  folder.write("court.toml",
               glazed_court(roof_states + "operation = \"always\"\nstate = \"blind\"\n"));
  const Json json = run_json(command({}));
  const Json& closed = json["rooms"][0];
  EXPECT_EQ(closed["mean_lux"]["value"], fabric["mean_lux"]["value"]);
  EXPECT_LT(closed["mean_lux"]["value"].get<double>(),
            0.5 * open["mean_lux"]["value"].get<double>());
  EXPECT_EQ(closed["mean_daylight_factor"], open["mean_daylight_factor"]);
  EXPECT_EQ(closed["ASE1000_250"], open["ASE1000_250"]);
  EXPECT_EQ(json["states"].size(), 2u);
  EXPECT_EQ(json["states"][0]["rooms"][0]["mean_lux"], open["mean_lux"]["value"]);
  EXPECT_EQ(json["windows"][0]["states"][1]["hours_with_light"], 3);
  EXPECT_EQ(json["method"], "combinations");
}

// The sun of noon in June comes through the roof with more than 1000 lx onto all of the floor that
// walls do not shade; in December there is none.
TEST_F(DaylightCommand, BlindsCloseByTheSun) {
  folder.write("court.toml", glazed_court());
  folder.write("windows.toml", roof_states);
  const Json json = run_json(command({"--windows", "windows.toml", "--hourly"}));
  EXPECT_EQ(json["windows"][0]["states"][0]["occupied_hours"], 1);
  EXPECT_EQ(json["windows"][0]["states"][1]["occupied_hours"], 2);
  const std::string hours = text_of("hours.csv"), page = text_of("year.html");
  EXPECT_NE(hours.find("dome_lux,\"skylight\"\n"), std::string::npos);
  EXPECT_NE(hours.find(",\"blind\"\n"), std::string::npos);
  EXPECT_TRUE(hours.ends_with(",\"open\"\n"));
  EXPECT_NE(page.find("IES LM-83-12"), std::string::npos);
  EXPECT_EQ(Json::parse(text_of("year.json"))["windows"], json["windows"]);
}

// An eye in the court that looks up at the bright roof, a point above the roof, from which the sun
// is seen all of a day that is 12 h long, and one close to the south wall, which the walls shade:
// at the equinox the sun rises in the east and climbs to 40 degrees, below the 45 degrees of the
// east and west walls' edges.
TEST_F(DaylightCommand, GlareAndExposureAreReported) {
  folder.write("court.toml", glazed_court("[[cameras]]\nname = \"visitor\"\nposition = [2, 2, 1]\n"
                                          "direction = [0, -1, 1]\nup = [0, 0, 1]\n"));
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,3,0,0,1\n2,0.05,0.5,0,0,1\n");
  const Json json =
      run_json(command({"--observer", "visitor", "--sun-points", "p.csv", "--occupied", "12-13"}));
  const Json& glare = json["glare"][0];
  EXPECT_EQ(glare["observer"], "visitor");
  std::istringstream lines(text_of("glare.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "hour,\"visitor lux\",\"visitor DGP\"");
  int noons = 0, with_glare = 0;
  while (std::getline(lines, line)) {
    const std::vector<double> values = numbers_of(line);
    // Contrast only adds to what the light at the eye makes; four decimals are written.
    EXPECT_GE(values[2], std::min(1.0, 5.87e-5 * values[1] + 0.16) - 1e-4) << line;
    if (static_cast<int>(values[0]) % 24 != 12) continue;
    ++noons;
    with_glare += values[2] > 0.35 ? 1 : 0;
  }
  EXPECT_EQ(noons, 2);
  // The sun of noon in June, 63 degrees high, is ahead of the eye and shines through the roof with
  // tens of thousands of lux; 3300 lx alone make a DGP of 0.35.
  EXPECT_GE(with_glare, 1);
  EXPECT_DOUBLE_EQ(glare["DGP_above_0.35"].get<double>(), 100.0 * with_glare / 365);
  EXPECT_EQ(glare["en_17037"], "high");
  const Json& points = json["exposure_to_sunlight"]["points"];
  // The equinox at 50 degrees north: the sun is 0 to 0.4 degrees north of the equator, which makes
  // the day 0 to 0.4 tan 50 / 7.5 h = 4 minutes longer than half a day. Whole minutes are counted,
  // one at either end.
  EXPECT_GE(points[0]["hours"].get<double>(), 12.0 - 2.0 / 60);
  EXPECT_LE(points[0]["hours"].get<double>(), 12.0 + (4.0 + 2.0) / 60);
  EXPECT_EQ(points[1]["hours"], 0.0);
  EXPECT_EQ(points[0]["en_17037"], "high");
  EXPECT_EQ(lines_of(text_of("glare.csv")), 4);
  EXPECT_NE(text_of("year.html").find("Daylight glare probability"), std::string::npos);
}

// On level ground above the court the instant has the light of its hour's weather.
TEST_F(DaylightCommand, AnInstantHasTheLightOfItsHour) {
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,5,0,0,1\n");
  const Json json = run_json(command({"--points", "p.csv", "--at", "2017-06-21 12:30"}));
  const double sun = json["sun"]["lux"], dome = json["dome_lux"],
               altitude = json["sun"]["altitude"];
  const double expected = dome + sun * std::sin(altitude * 3.14159265358979 / 180.0);
  // Cosines vary over the disc by half its radius, 0.0047; four standard errors of 16 rays.
  EXPECT_NEAR(json["rooms"][0]["mean_lux"].get<double>(), expected,
              4.0 * 0.5 * 0.0047 / 4.0 * sun + 1e-5 * expected);
  EXPECT_EQ(lines_of(text_of("instant.csv")), 2);
  EXPECT_NE(text_of("instant.html").find("2017-06-21 12:30"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "year/year.json"));
  const auto refused = [&](const std::string& at, int code, const std::string& sentence) {
    const Ended ended = run(command({"--points", "p.csv", "--at", at}));
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
  };
  refused("2017-06-21 23:30", 3, "the sun is below the horizon");
  refused("2017-02-30 12:30", 2, "is no instant");
  refused("noon", 2, "is no instant");
  refused("2016-02-29 12:30", 3, "the weather has no hour on day 29 of month 2");
}

TEST_F(DaylightCommand, WrongWindowsAreASentence) {
  const auto expect = [&](const std::string& windows, const std::string& sentence) {
    folder.write("windows.toml", windows);
    folder.write("court.toml", glazed_court());
    const Ended ended = run(command({"--windows", "windows.toml"}));
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
  };
  expect("", "there are no windows");
  expect("[[windows]]\nsurfaces = \"rof\"\nstates = []\n", "Did you mean 'roof'?");
  expect(
      "[[windows]]\nsurfaces = \"roof\"\nstates = [{ name = \"open\", material = \"grey\" }, "
      "{ name = \"blind\", material = \"fabric\" }]\n",
      "is not for the first state, which is the scene as it stands; remove");
  expect(roof_states +
             "operation = \"schedule\"\nschedule = [{ state = \"blind\", hours = \"24-0\" }]\n",
         "write two different hours from 0 to 24");
  std::string hours;
  for (int h = 0; h < 8784; ++h) hours += "open\n";
  folder.write("hours.csv", hours);
  expect(roof_states + "operation = \"schedule\"\nschedule = \"hours.csv\"\n",
         "has 8784 hours, and the weather file 8760");
}

TEST_F(DaylightCommand, WrongInputIsASentence) {
  const auto expect = [&](const Words& more, int code, const std::string& sentence) {
    const Ended ended = run(command(more));
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
  };
  expect({}, 3, "there are no sensors");
  expect({"--plane", "flour@0.8"}, 3, "Did you mean 'floor'?");
  expect({"--plane", "floor@0.8", "--occupied", "18-8"}, 2, "'18-8' is no span of hours");
  expect({"--plane", "floor@0.8", "--ground", "2"}, 2, "--ground");
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,0.8,0,0,1\n");
  folder.write("year.wea", weather.substr(0, weather.find("6 21")) + "6 21 0.5 500 150\n");
  expect({"--points", "p.csv"}, 3, "there is no daylight to compute");
  folder.write("year.wea", weather);
  const Words with_points = {"--points", "p.csv"},
              with_sun = with_points + Words{"--sun-points", "p.csv"};
  for (const char* day : {"01-31", "03-22", "06-21"}) {
    expect(with_sun + Words{"--sun-day", day}, 2, "write one from 02-01 to 03-21");
  }
  expect(with_points + Words{"--sun-day", "02-01"}, 2, "--sun-points");
  expect(with_points + Words{"--least-sun", "11"}, 2, "--sun-points");
  const Words at_noon = with_points + Words{"--at", "2017-06-21 12:30"};
  expect(at_noon + Words{"--hourly"}, 2, "--hourly");
  expect(at_noon + Words{"--occupied", "8-12"}, 2, "--occupied");
  expect(at_noon + Words{"--walk", "walk.html"}, 2, "--walk");
  expect({"--plane", "floor@0.8", "--walk", "walk.pdf"}, 2, "'walk.pdf' is no name of a page");
  expect({"--plane", "floor@0.8", "--walk", "year/year.html"}, 1, "year.html");
  expect({"--plane", "floor@0.8", "--walk", "nowhere/walk.html"}, 1, "nowhere/walk.html");
  expect({"--plane", "floor@0.8", "--sky", "9"}, 2, "--sky");
  folder.write("year.wea", "nonsense");
  expect({"--plane", "floor@0.8"}, 3, "year.wea:1: ");
  folder.write("year.csv", weather);
  const Ended ended = run(
      {"daylight", "court.toml", "--weather", "year.csv", "-o", "year", "--plane", "floor@0.8"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("weather is read from .epw"), std::string::npos) << ended.err;
}

// The limit is told before form factors, which would take minutes for these patches.
TEST_F(DaylightCommand, APageOfTooManyVerticesIsRefusedAtOnce) {
  const Ended ended =
      run({"daylight", "court.toml", "--weather", "year.wea", "-o", "year", "--plane", "floor@0.8",
           "--walk", "walk.html", "--max-patch-size", "0.02"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("vertices, and a page of a year takes 400000 at most; give a larger "
                           "'--max-patch-size'"),
            std::string::npos)
      << ended.err;
}

// A year whose every hour is dark has states of windows, and no light in them.
TEST_F(DaylightCommand, SaysThatAClosedRoomGetsNoDaylight) {
  folder.write("court.toml", court(true));
  const Ended ended = run(command({"--plane", "floor@0.8"}));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("No daylight reaches any sensor"), std::string::npos) << ended.err;
}

// Results never replace what they were made from.
TEST_F(DaylightCommand, RefusesToWriteOverItsPoints) {
  std::filesystem::create_directory(folder / "year");
  folder.write("year/sensors.csv", "x,y,z,nx,ny,nz\n2,2,0.8,0,0,1\n");
  const Ended ended = run(command({"--points", "year/sensors.csv"}));
  EXPECT_NE(ended.code, 0);
  EXPECT_EQ(lines_of(text_of("sensors.csv")), 2);
}

// The schedule that a file of windows names is an input, too, and within the reach of
// --inside-folder.
TEST_F(DaylightCommand, RefusesToWriteOverItsSchedule) {
  std::filesystem::create_directory(folder / "year");
  std::filesystem::create_directory(folder / "blinds");
  folder.write("court.toml", glazed_court());
  std::string hours;
  for (int h = 0; h < 8760; ++h) hours += "open\n";
  folder.write("year/hours.csv", hours);
  folder.write("blinds/windows.toml",
               roof_states + "operation = \"schedule\"\nschedule = \"../year/hours.csv\"\n");
  const Words with_windows = command({"--windows", "blinds/windows.toml"});
  const Ended ended = run(with_windows);
  EXPECT_NE(ended.code, 0);
  EXPECT_NE(ended.err.find("the command reads the same file"), std::string::npos) << ended.err;
  EXPECT_EQ(text_of("hours.csv"), hours);
  const Ended outside = run(with_windows + Words{"--inside-folder"});
  EXPECT_NE(outside.code, 0);
  EXPECT_NE(outside.err.find("outside of its folder"), std::string::npos) << outside.err;
}

// The court of three hours of light in a year has daylight factors above 2 % everywhere, and none
// of the hours that ratings count: LEED gives nothing, and BREEAM its credits by daylight factors.
TEST_F(DaylightCommand, HoldsRoomsToRatings) {
  const Words grid = {"--plane", "floor@0.8", "--spacing", "1"};
  const Json json =
      run_json(command(grid + Words{"--rating", "leed", "--rating", "breeam-office"}));
  ASSERT_EQ(json["ratings"].size(), 2u);
  const Json &leed = json["ratings"][0], &breeam = json["ratings"][1];
  EXPECT_EQ(leed["points"]["most"], 0);
  EXPECT_EQ(leed["points"]["available"], 3);
  EXPECT_EQ(leed["weights"], "area");
  EXPECT_EQ(breeam["points"]["least"], 2);
  const auto limit = [&](const Json& rating, const char* figure) {
    for (const Json& one : rating["limits"]) {
      if (one["figure"] == figure) return one;
    }
    return Json();
  };
  const Json factor = limit(breeam, "mean_daylight_factor");
  EXPECT_EQ(factor["value"], json["rooms"][0]["mean_daylight_factor"]);
  EXPECT_EQ(factor["at_least"], 2.0);
  EXPECT_EQ(factor["verdict"], "met");
  EXPECT_EQ(limit(breeam, "by_daylight_factors")["verdict"], "met");
  const Json hours = limit(breeam, "hours_of_mean");
  EXPECT_LE(hours["most"], 3.0);
  EXPECT_EQ(hours["verdict"], "missed");
  EXPECT_EQ(limit(leed, "sDA300_50")["verdict"], "missed");
  // A line of titles, LEED's five limits (of the room two) and BREEAM's eight (of the room seven).
  EXPECT_EQ(lines_of(text_of("rooms.csv")), 1 + 5 + 8);
  const std::string page = text_of("year.html");
  for (const char* part : {"LEED v4.1 daylight, option 1: 0 of 3 points", "2 of 2 credits"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

// Two of 10 hours a day are lit in June and one in December; lamps that daylight does not dim take
//
//     100 W * 3650 h / (1000 * 16 m^2) = 22.8125 kWh/m^2
//
// in a year, and for 1 lx of maintained illuminance, which any of these hours gives, they are off
// in three of the 3650 hours.
TEST_F(DaylightCommand, FindsTheEnergyThatDaylightSaves) {
  const auto lighting_of = [&](const std::string& keys) {
    folder.write("rooms.toml", "[[rooms]]\nsensors = \"floor*\"\nlighting = { " + keys + " }\n");
    return run_json(command({"--plane", "floor@0.8", "--spacing", "1", "--rooms",
                             "rooms.toml"}))["rooms"][0]["lighting"];
  };
  const Json off = lighting_of("watts = 100, lux = 1, control = \"on/off\"");
  EXPECT_EQ(off["daylight_hours"], 3);
  EXPECT_EQ(off["night_hours"], 3647);
  EXPECT_EQ(off["area_m2"], 16.0);
  EXPECT_EQ(off["daylight_dependency"]["value"], 0.0);
  EXPECT_EQ(off["daylight_dependency"]["most"], 0.0);
  // Each of five operations rounds at 2^-53 of 22.8.
  constexpr double rounding = 5 * 22.8 / (1LL << 53);
  EXPECT_NEAR(off["LENI_kWh_per_m2"]["value"].get<double>(), 22.8125 * 3647.0 / 3650.0, rounding);
  // A difference of two such figures.
  EXPECT_NEAR(off["saved_kWh_per_m2"]["value"].get<double>(), 22.8125 * 3.0 / 3650.0,
              2.0 * rounding);
  EXPECT_NE(text_of("rooms.csv").find("LENI_kWh_per_m2"), std::string::npos);
  EXPECT_NE(text_of("year.html").find("Energy of lamps"), std::string::npos);
  // Lamps for a million lux are never off, and stay so within the bound.
  const Json on = lighting_of("lux = 1e6, control = \"on/off\"");
  EXPECT_EQ(on["daylight_dependency"]["value"], 1.0);
  EXPECT_EQ(on["saved_share"]["most"], 0.0);
  EXPECT_FALSE(on.contains("LENI_kWh_per_m2"));
  // Dimmed lamps take less where there is more light.
  const Json dimmed = lighting_of("lux = 1e5, control = \"dimmed\"");
  EXPECT_LT(dimmed["daylight_dependency"]["least"], dimmed["daylight_dependency"]["value"]);
  EXPECT_LT(dimmed["daylight_dependency"]["value"], dimmed["daylight_dependency"]["most"]);
}

TEST_F(DaylightCommand, RefusesRoomsThatDoNotFit) {
  folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,0.8,0,0,1\n");
  const auto expect_refused = [&](const std::string& rooms, const std::string& sentence) {
    folder.write("rooms.toml", rooms);
    const Ended ended = run(command({"--points", "p.csv", "--rooms", "rooms.toml"}));
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "year/year.json"));
  };
  const std::string room = "[[rooms]]\nsensors = \"p.csv\"\n";
  expect_refused("[[rooms]]\nsensors = \"q.csv\"\n", "no sensors are left for 'q.csv'");
  expect_refused(room + "lighting = { watts = 50, lux = 500, control = \"dimmed\" }\n",
                 "no area to relate its energy to");
  expect_refused(room + "lighting = { watts = -50, lux = 500, control = \"dimmed\" }\n",
                 "rooms.toml:3");
  expect_refused(room + "lighting = { lux = 500, control = \"manual\" }\n",
                 "'on/off', 'stepped' or 'dimmed'");
  folder.write("rooms.toml", room + "regularly_occupied = false\n");
  const Ended empty =
      run(command({"--points", "p.csv", "--rooms", "rooms.toml", "--rating", "leed"}));
  EXPECT_EQ(empty.code, 3);
  EXPECT_NE(empty.err.find("no room is regularly occupied"), std::string::npos) << empty.err;
  const Ended unknown = run(command({"--points", "p.csv", "--rating", "lead"}));
  EXPECT_EQ(unknown.code, 3);
  EXPECT_NE(unknown.err.find("Did you mean 'leed'?"), std::string::npos) << unknown.err;
}

}  // namespace lightwell::daylight_command_test
