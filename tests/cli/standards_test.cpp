// Limits of standards, and light at the eye, by 'lightwell report'.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/cli/report_command.h"

namespace lightwell::standards_test {
namespace {
using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string areas = R"(
[[grids]]
name = "desk"
surface = "room"
height = 0.75
part = { min = [1, 1, 0], max = [3, 2, 0] }
[[grids]]
name = "around"
surface = "room"
height = 0.75
leaves_out = ["desk"]
[[grids]]
name = "way"
surface = "room"
part = { min = [1, 0.5, 0], max = [2, 2.5, 0] }
[[areas]]
name = "work"
activity = "mine"
grid = "desk"
surround = "around"
[[areas]]
name = "escape"
emergency = "escape route"
grid = "way"
[maintenance]
room = 0.5
[energy]
surface = "room"
daylight_hours = 2000
night_hours = 500
)";

/// The limit for cylindrical illuminance asks for a grid of its own; E_max / E_min of the route and
/// the least of its direct light are those of the grids in the report. The figures of limits are
/// copies of those of grids, so they are equal.
TEST_F(ReportCommand, AreasAreHeldToTheLimitsOfStandards) {
  folder.write("areas.toml", areas);
  folder.write("mine.toml",
               "[activities.mine]\nmean = 1\nuniformity = 0.01\ncylindrical = 1e6\nglare = 1\n");
  const Json json = run_json({"report", "room.toml", "room.vtp", "--areas", "areas.toml",
                              "--activities", "mine.toml", "--watts", "panel=40", "--rays", "64"});
  EXPECT_EQ(json["maintenance_factor"], 0.5);
  const auto surface = [&](const std::string& name) -> const Json& {
    for (const Json& one : json["surfaces"]) {
      if (one["name"] == name) return one;
    }
    throw std::runtime_error("no surface " + name);
  };
  const auto limit = [&](const std::string& place, const std::string& figure) -> const Json& {
    for (const Json& one : json["requirements"]) {
      if (one["place"] == place && one["figure"] == figure) return one;
    }
    throw std::runtime_error("no limit of " + place);
  };
  EXPECT_EQ(limit("desk", "E_m")["value"], surface("desk")["E_m"]);
  EXPECT_EQ(limit("desk", "E_m")["within"], surface("desk")["mean_within"]);
  EXPECT_EQ(limit("desk", "E_m")["verdict"], "met");
  const std::string eyes = "desk, eyes at 1.2 m, cylindrical";
  EXPECT_EQ(surface(eyes)["quantity"], "cylindrical");
  EXPECT_EQ(limit(eyes, "E_m,z")["value"], surface(eyes)["E_m"]);
  EXPECT_EQ(limit(eyes, "E_m,z")["verdict"], "missed");
  EXPECT_EQ(surface("way, direct light")["light"], "direct");
  EXPECT_EQ(limit("way, direct light, centre line", "E_min")["value"],
            surface("way, direct light, centre line")["E_min"]);
  EXPECT_LT(surface("way, direct light")["E_m"].get<double>(), surface("way")["E_m"].get<double>());
  EXPECT_EQ(json["verdict"], "missed");
  // 40 W for 2500 h over 12 m2.
  EXPECT_DOUBLE_EQ(json["energy"]["LENI_kWh_per_m2"].get<double>(), 100.0 / 12.0);
  EXPECT_EQ(surface("around")["points"].get<int>() > 0, true);
  // In text the energy of a year stands in place of the solution's energy balance.
  const Ended text = run({"report", "room.toml", "room.vtp", "--areas", "areas.toml",
                          "--activities", "mine.toml", "--watts", "panel=40", "--rays", "64"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, "LENI 8.33 kWh/m2"));
}

TEST_F(ReportCommand, APlaneIsHeldToTheLimitsOfAnActivity) {
  const Words words = {"report", "room.toml", "room.vtp", "--plane", "room@0.75", "--rays", "64"};
  const Json json = run_json(words + Words{"--activity", "corridor"});
  EXPECT_EQ(json["requirements"][0]["area"], "room + 0.75 m (corridor)");
  EXPECT_EQ(json["requirements"][0]["at_least"], 100.0);
  expect_refused({"--plane", "room@0.75", "--activity", "corridoor"}, 3,
                 "Did you mean 'corridor'?");
  folder.write("wide.toml",
               "[[grids]]\nname = \"hall\"\nsurface = \"room\"\n[[areas]]\nemergency = \"escape "
               "route\"\ngrid = \"hall\"\n");
  expect_refused({"--areas", "wide.toml"}, 3, "EN 1838 has them up to 2 m wide");
  folder.write("none.toml", "[activities.mine]\nuniformity = 0.4\n");
  expect_refused({"--plane", "room@0.75", "--activities", "none.toml"}, 3, "mean");
}

/// The room of 4 m x 3 m as a pitch, whose p = 0.2 * 5^log10(4) = 0.53 m gives 7 x 5 points. The
/// planes towards the door are upright. A panel above the eye makes a rating.
TEST_F(ReportCommand, ASportsAreaIsHeldToItsClass) {
  const std::string pitch = R"(
[[grids]]
name = "floor"
surface = "room"
part = { min = [0, 0, 0], max = [4, 3, 0] }
[[areas]]
name = "pitch"
sport = "mine"
class = "II"
grid = "floor"
observers = ["door"]
cameras = ["door"]
television = { mean = 1e6, gradient = 100 }
)";
  folder.write("areas.toml", pitch);
  folder.write("mine.toml",
               "[sports.mine]\nI = { mean = 9e9 }\nIII = { mean = 9e9 }\n"
               "II = { mean = 1, uniformity = 0.01, glare_rating = 100, colour_rendering = 60 }\n");
  const Json json = run_json({"report", "room.toml", "room.vtp", "--areas", "areas.toml",
                              "--sports", "mine.toml", "--rays", "64"});
  std::vector<std::string> figures;
  for (const Json& one : json["requirements"]) figures.push_back(one["figure"]);
  // The room has three bands, so R_a is not known.
  EXPECT_EQ(figures, (Words{"E_m", "U_0", "E_v,m", "gradient", "R_G"}));
  const Json& rating = json["requirements"][4];
  EXPECT_EQ(rating["verdict"], "met");
  EXPECT_GT(rating["value"].get<double>(), 0.0);
  EXPECT_EQ(json["verdict"], "missed");
  const Json& surfaces = json["surfaces"];
  EXPECT_EQ(surfaces[1]["name"], "floor, EN 12193");
  EXPECT_EQ(surfaces[1]["points"], 35);
  EXPECT_EQ(surfaces[2]["name"], "floor, towards camera door");
  EXPECT_EQ(surfaces[2]["quantity"], "vertical");
  expect_refused({"--areas", "areas.toml"}, 3, "there is no sport 'mine'");
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& sentence) {
    std::string text = pitch;
    folder.write("areas.toml", text.replace(text.find(from), from.size(), to));
    expect_refused({"--areas", "areas.toml", "--sports", "mine.toml"}, 3, sentence);
  };
  refused("\"II\"", "\"IV\"", "'I', 'II' or 'III'");
  refused("cameras = [\"door\"]", "cameras = [\"dor\"]", "Did you mean 'door'?");
  refused("gradient = 100", "gradient = 101", "gradient");
  refused("sport = \"mine\"", "sport = \"mine\"\nactivity = \"writing\"", "activity");
}

class EyeLightReport : public CommandTest {};

/// An observer before a panel of CIE illuminant E: the panel's spectrum is even, and so is that of
/// what grey walls reflect. Means of tables over bands are exact for an even spectrum.
/// - The published melanopic ratio of E, 0.9058, has four digits: half of the last is 5e-5.
/// - The sums of the table of the observer have x = 0.333314 over all wavelengths and 0.333341 from
///   380 to 780 nm: 1.9e-5 of 1/3 at most, wherever the bands cut them.
TEST_F(EyeLightReport, ObserversHaveTheLightOfTheirSpectrum) {
  folder.write("room.toml", R"(
unit = "m"
[bands]
kind = "spectral"
from = 377.5
to = 782.5
step = 5
[materials.grey]
reflectance = 0.5
[materials.panel]
exitance = 2
[[surfaces]]
name = "room"
material = "grey"
box = { min = [0, 0, 0], max = [4, 3, 2.5], inward = true }
[[surfaces]]
name = "panel"
material = "panel"
polygon = [[1, 1, 2.4], [1, 2, 2.4], [3, 2, 2.4], [3, 1, 2.4]]
[[cameras]]
name = "chair"
position = [0.5, 1.5, 1.2]
direction = [1, 0, 0]
up = [0, 0, 1]
)");
  const Ended solved = run(Words{"solve", "room.toml", "-o", "room.vtp", "--quiet"} + quick());
  ASSERT_EQ(solved.code, 0) << solved.err;
  const Json eye = run_json(
      {"report", "room.toml", "room.vtp", "--observer", "chair", "--rays", "64"})["observers"][0];
  EXPECT_GT(eye["E_v"].get<double>(), 0.0);
  EXPECT_NEAR(eye["melanopic_DER"].get<double>(), 0.9058, 5e-5);
  EXPECT_NEAR(eye["x"].get<double>(), 1.0 / 3.0, 1.9e-5);
  EXPECT_NEAR(eye["alpha_opic"]["melanopic"]["EDI"].get<double>(),
              eye["melanopic_DER"].get<double>() * eye["E_v"].get<double>(),
              1e-4 * eye["E_v"].get<double>());
  EXPECT_NEAR(eye["CCT"].get<double>(), 5455.0, 5.0) << "CIE 15: 5455 K";
  // Samples of one grey each have no colour in any light: nothing differs, and no gamut has an
  // area.
  std::string samples;
  for (const char* nm : {"380", "580", "780"}) {
    samples += nm;
    for (int i = 0; i < 99; ++i) samples += ",0.3";
    samples += "\n";
  }
  folder.write("ces.csv", samples);
  const Json rated = run_json({"report", "room.toml", "room.vtp", "--observer", "chair", "--rays",
                               "64", "--colour-samples", "ces.csv"})["observers"][0];
  EXPECT_NEAR(rated["R_f"].get<double>(), 100.0, 1e-2);
  // The spectrum of the panel is that of E, too, whose R_a CIE 13.3 programs give as 95.
  const Json judged = run_json({"report", "room.toml", "room.vtp", "--plane", "room@0.75",
                                "--activity", "corridor", "--rays", "64"});
  EXPECT_NEAR(judged["luminaires"][0]["R_a"].get<double>(), 95.0, 0.6);
  const Json& last = judged["requirements"].back();
  EXPECT_EQ(last["figure"], "R_a");
  EXPECT_EQ(last["place"], "panel");
  EXPECT_EQ(last["at_least"], 80.0);
  EXPECT_EQ(last["verdict"], "met");
}

}  // namespace
}  // namespace lightwell::standards_test
