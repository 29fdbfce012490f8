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
