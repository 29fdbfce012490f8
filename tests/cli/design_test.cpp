// Files, figures and errors of 'lightwell design'.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell::design_test {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

class DesignCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("room.toml", small_room_with("[[lamps]]\nname = \"spot\"\nposition = [3, 2, 2.4]\n"
                                              "lumens = 2000\nwatts = 18\n"
                                              "[[lamps]]\nname = \"spot\"\nposition = [1, 1, 2.4]\n"
                                              "lumens = 1000\nwatts = 9\n"
                                              "[[grids]]\nname = \"plane\"\nsurface = \"room\"\n"
                                              "height = 0.75\n"));
  }
  Words design(const std::string& limits) {
    folder.write("limits.toml", limits);
    return Words{"design", "room.toml",   "--limits", "limits.toml", "-o",
                 "out",    "--grid-rays", "64",       "--watts",     "panel=40"} +
           quick();
  }
  void expect_refused(const std::string& limits, const std::string& sentence,
                      const Words& more = {}) {
    const Words words = design(limits);
    const int files = folder.file_count();
    const Ended ended = run(words + more);
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
    EXPECT_EQ(folder.file_count(), files) << sentence;
  }
};

/// The power is that of the levels in the table, and the light is written at these levels.
TEST_F(DesignCommand, WritesLevelsFiguresAndTheLight) {
  const Json json =
      run_json(design("maintenance = 0.8\n[[limits]]\ngrid = \"plane\"\nmean_at_least = 60\n"));
  EXPECT_TRUE(json["feasible"]);
  EXPECT_EQ(json["minimised"], "watts");
  EXPECT_DOUBLE_EQ(json["at_full_power"], 67.0);
  EXPECT_EQ(json["limits"][0]["verdict"], "met");
  EXPECT_GE(json["limits"][0]["reached"], 60.0);
  double watts = 0.0;
  for (const Json& luminaire : json["luminaires"]) {
    watts += luminaire["level"].get<double>() * luminaire["watts_full"].get<double>();
  }
  // Sums of three products in two orders: five roundings each, of 2^-53 of the sum at
  // most: 1.2e-15.
  EXPECT_NEAR(watts, json["optimum"].get<double>(), 1.2e-15 * watts);
  const std::string table = content_of(folder / "out/levels.csv");
  EXPECT_EQ(table.rfind("luminaire,x,y,z,level,watts_full,watts,group\n", 0), 0u) << table;
  EXPECT_NE(table.find("\n\"spot 2\",1,1,2.4,"), std::string::npos) << table;
  EXPECT_TRUE(Json::parse(content_of(folder / "out/design.json"))["meets_all"]);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/solution.vtp"));
  // The plan of the grid has the level of each lamp over it.
  const double level = json["luminaires"][1]["level"];
  const std::string label = ">" + std::to_string(std::lround(100.0 * level)) + " %</text>";
  EXPECT_TRUE(says(content_of(folder / "out/design.html"), label));

  // The limit holds for 'report' as well, which measures by itself.
  const Json report = run_json({"report", "room.toml", "out/solution.vtp", "--maintenance", "0.8"});
  EXPECT_GE(report["surfaces"][0]["E_m"].get<double>(), 60.0);
}

const std::string move_spots =
    "[[move]]\nluminaires = [\"spot\"]\naxes = \"xy\"\nlowest = [0.5, 0.5]\n"
    "highest = [3.5, 2.5]\napart = 0.3\n";

/// The scene is written with the lamps where they were moved to, and the solution is of that scene.
TEST_F(DesignCommand, MovesLampsAndWritesTheScene) {
  const std::string limits =
      "maintenance = 0.8\n[[limits]]\ngrid = \"plane\"\nmean_at_least = 130\n"
      "uniformity_at_least = 0.3\n";
  // A panel that takes so much stays off where spots can give the light.
  const Json json = run_json(design(limits + move_spots) + Words{"--watts", "panel=900"});
  EXPECT_TRUE(json["meets_all"]);
  EXPECT_LT(json["optimum"].get<double>(), json["moved"]["optimum_before"].get<double>());
  EXPECT_GE(json["moved"]["solves"].get<int>(), 2);
  const Json& spot = json["luminaires"][1];
  EXPECT_EQ(spot["name"], "spot 1");
  EXPECT_EQ(spot["place_before"], Json({3.0, 2.0, 2.4}));
  EXPECT_NE(spot["place"], spot["place_before"]);
  EXPECT_EQ(json["luminaires"][0]["place"], json["luminaires"][0]["place_before"]) << "a surface";
  const std::string table = content_of(folder / "out/places.csv");
  EXPECT_EQ(table.rfind("luminaire,x_before,y_before,z_before,x,y,z,moved\n", 0), 0u) << table;
  EXPECT_TRUE(says(content_of(folder / "out/design.html"), "<h2>Places</h2>"));

  const Json info = run_json({"info", "out/solution.vtp"});
  EXPECT_EQ(info["scene"], "out/moved.toml");
  const Json report =
      run_json({"report", "out/moved.toml", "out/solution.vtp", "--maintenance", "0.8"});
  EXPECT_GE(report["surfaces"][0]["E_m"].get<double>(), 130.0);
  const Ended of_before = run({"report", "room.toml", "out/solution.vtp"});
  EXPECT_EQ(of_before.code, 3) << "the solution is not that of the scene as it was";
}

TEST_F(DesignCommand, MovesThatCannotBeAreRefusedWithASentence) {
  const std::string limit = "[[limits]]\ngrid = \"plane\"\nmean_at_least = 60\n";
  const auto move = [&](const std::string& name, const std::string& axes, const std::string& low) {
    return limit + "[[move]]\nluminaires = [\"" + name + "\"]\naxes = \"" + axes +
           "\"\nlowest = [" + low + "]\nhighest = [3.5]\n";
  };
  expect_refused(move("spt", "x", "0.5"), "Did you mean 'spot'?");
  expect_refused(move("panel", "x", "0.5"), "which is a surface, and only lamps are moved");
  expect_refused(move("spot", "w", "0.5"), "write the axes that luminaires may be moved along");
  expect_refused(move("spot", "x", "2"), "the scene has it at 1");
  expect_refused(limit + move_spots +
                     "[[move]]\nluminaires = [\"spot 2\"]\naxes = \"z\"\n"
                     "lowest = [2]\nhighest = [2.4]\n",
                 "would move 'spot 2', as ");
}

TEST_F(DesignCommand, OfASolutionLampsAreNotMoved) {
  ASSERT_EQ(
      run(Words{"solve", "room.toml", "-o", "room.vtp", "--channels", "per-luminaire"} + quick())
          .code,
      0);
  const Words words = design("[[limits]]\ngrid = \"plane\"\nmean_at_least = 60\n" + move_spots);
  const Ended ended =
      run(Words{words[0], words[1], "room.vtp"} + Words(words.begin() + 2, words.end()));
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.err.find("leave the solution or the [[move]] tables out"), std::string::npos)
      << ended.err;
}

TEST_F(DesignCommand, LimitsOutOfReachEndWithCodeFourAndTheNearestLevels) {
  const Ended ended = run(design("[[limits]]\ngrid = \"plane\"\nmean_at_least = 90000\n"));
  EXPECT_EQ(ended.code, 4) << ended.err;
  EXPECT_NE(ended.out.find("even with every luminaire at full power, grid 'plane' reaches"),
            std::string::npos)
      << ended.out;
  EXPECT_TRUE(std::filesystem::exists(folder / "out/levels.csv"));
}

TEST_F(DesignCommand, BadInputIsRefusedWithASentence) {
  const std::string limits = "[[limits]]\ngrid = \"plane\"\nmean_at_least = 60\n";
  expect_refused("", "there are no limits");
  expect_refused("[[limits]]\ngrid = \"plan\"\nmean_at_least = 60\n", "Did you mean 'plane'?");
  expect_refused("[[glare]]\nobserver = \"dor\"\nugr_at_most = 19\n", "there is no camera 'dor'");
  expect_refused(limits + "[dimming]\ngroups = [[\"spt\"]]\n", "Did you mean 'spot'?");
  expect_refused(limits + "[dimming]\ngroups = [[\"spot\"], [\"spot 2\"]]\n",
                 "group 1 dims already");
}

TEST_F(DesignCommand, OfASolutionWithoutChannelsIsRefused) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "room.vtp", "--channels", "off"} + quick()).code,
            0);
  const Words words = design("[[limits]]\ngrid = \"plane\"\nmean_at_least = 60\n");
  const Ended ended =
      run(Words{words[0], words[1], "room.vtp"} + Words(words.begin() + 2, words.end()));
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.err.find("solve with --channels per-luminaire"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace lightwell::design_test
