// Light channels through the built program: solve, relight, info, render and probe.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "radiosity/solution/solution_file.h"
#include "raytrace/pictures/image.h"
#include "tests/cli/program.h"

namespace lightwell::relight_test {
namespace {

using Words = std::vector<std::string>;

std::string office() {
  return small_room_with(R"(
[materials.bulb]
exitance = [300, 240, 150]
[[surfaces]]
name = "desk lamp"
material = "bulb"
polygon = [[3, 0.5, 1.2], [3, 0.7, 1.2], [3.2, 0.7, 1.2], [3.2, 0.5, 1.2]]
)");
}

class RelightCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("office.toml", office());
    folder.write("points.csv", "x,y,z,nx,ny,nz\n2,1.5,0,0,0,1\n3.1,0.6,0,0,0,1\n");
  }
  void solve() {
    const Ended ended = run(Words{"solve", "office.toml", "-o", "S.vtp", "--channels", "desk=desk*",
                                  "--channels", "ceiling=panel"} +
                            quick());
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find("channels  desk 27.6 W, ceiling 30 W"), std::string::npos)
        << ended.out;
  }
  Ended relight(const Words& settings, const std::string& from = "S.vtp",
                const std::string& to = "T.vtp") {
    Words words{"relight", from, "-o", to};
    for (const std::string& setting : settings) words = words + Words{"--channel", setting};
    return run(words);
  }
  // E_r, E_g, E_b and lux of both points.
  std::vector<double> probed(const std::string& solution) {
    EXPECT_EQ(run({"probe", "office.toml", solution, "--points", "points.csv", "-o", "E.csv"}).code,
              0);
    std::ifstream in(folder / "E.csv");
    std::vector<double> values;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::stringstream fields(line);
      int column = 0;
      for (std::string field; std::getline(fields, field, ',');) {
        ++column;
        if (column > 6 && column <= 10) values.push_back(std::stod(field));
      }
    }
    EXPECT_EQ(values.size(), 8u);
    return values;
  }
};

TEST_F(RelightCommand, InfoListsChannelsWithTheirFluxAndScale) {
  solve();
  const Ended relit = relight({"desk=0.5", "ceiling=#ff8040"});
  ASSERT_EQ(relit.code, 0) << relit.err;
  EXPECT_NE(relit.out.find("desk 13.8 W (scale 0.5)"), std::string::npos) << relit.out;
  const auto before = run_json({"info", "S.vtp"}), after = run_json({"info", "T.vtp"});
  ASSERT_EQ(after["channels"].size(), 2u);
  const auto &desk = after["channels"][0], &ceiling = after["channels"][1];
  EXPECT_EQ(desk["name"], "desk");
  EXPECT_EQ(desk["surfaces"], nlohmann::json::array({"desk lamp"}));
  EXPECT_EQ(desk["scale"], nlohmann::json::array({0.5, 0.5, 0.5}));
  // Half of 690 W/m2 (sum of the bands) on 0.04 m2. Exitances, scales and colours are floats with a
  // relative rounding error of 6e-8; a few of them are multiplied and added.
  constexpr double rounding = 1e-6;
  EXPECT_NEAR(desk["watts_radiated"].get<double>(), 13.8, rounding * 13.8);
  // A colour keeps the lumens and changes the watts.
  EXPECT_NEAR(ceiling["lumens"].get<double>() / before["channels"][1]["lumens"].get<double>(), 1.0,
              rounding);
  EXPECT_GT(std::abs(ceiling["watts_radiated"].get<double>() - 30.0), 1.0);
  EXPECT_NEAR(after["energy"]["emitted"].get<double>(),
              desk["watts_radiated"].get<double>() + ceiling["watts_radiated"].get<double>(),
              rounding * 40.0);
  EXPECT_EQ(before["scene_hash"], after["scene_hash"]);
}

/// Progressive refinement shoots the light of all channels at once.
TEST_F(RelightCommand, ProgressiveLightIsKeptApartToo) {
  const Ended ended = run(Words{"solve", "office.toml", "-o", "P.vtp", "--solver", "progressive",
                                "--channels", "per-luminaire"} +
                          quick());
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("desk lamp 27.6 W"), std::string::npos) << ended.out;
  ASSERT_EQ(relight({"desk lamp=off"}, "P.vtp", "panel.vtp").code, 0);
  ASSERT_EQ(relight({"panel=off"}, "P.vtp", "desk.vtp").code, 0);
  const auto all = probed("P.vtp"), panel = probed("panel.vtp"), desk = probed("desk.vtp");
  // 2 * 4 * 6e-8: both sides have up to four float operations, each with a relative error of 6e-8:
  // irradiance by a lamp, its scale, the sum over lamps, the sum over an element's corners.
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(panel[i] + desk[i], all[i], 5e-7 * all[i]);
  }
}

TEST_F(RelightCommand, LightAddsUpAtEveryPoint) {
  solve();
  ASSERT_EQ(relight({"desk=off"}, "S.vtp", "ceiling.vtp").code, 0);
  ASSERT_EQ(relight({"ceiling=off"}, "S.vtp", "desk.vtp").code, 0);
  // Settings are relative to the scene as solved, also in a relit file; the scale of the desk lamp
  // stays 0 unless it is set.
  ASSERT_EQ(relight({"ceiling=2"}, "ceiling.vtp", "bright.vtp").code, 0);
  ASSERT_EQ(relight({"desk=1", "ceiling=1"}, "ceiling.vtp", "again.vtp").code, 0);
  const auto all = probed("S.vtp"), ceiling = probed("ceiling.vtp"), desk = probed("desk.vtp"),
             bright = probed("bright.vtp"), again = probed("again.vtp");
  for (std::size_t i = 0; i < all.size(); ++i) {
    // 2 * 4 * 6e-8: both sides have up to four float operations, each with a relative error of
    // 6e-8: irradiance at vertices, its reflection, the sum over lamps, the sum of direct and
    // indirect light.
    EXPECT_NEAR(ceiling[i] + desk[i], all[i], 5e-7 * all[i]);
    EXPECT_NEAR(bright[i], 2.0 * ceiling[i], 5e-7 * all[i]);
    EXPECT_EQ(again[i], all[i]);
    EXPECT_GT(desk[i], 0.0);
    EXPECT_GT(ceiling[i], 0.0);
  }
}

TEST_F(RelightCommand, PicturesAddUpWithTheOriginalScene) {
  solve();
  ASSERT_EQ(relight({"desk=off"}, "S.vtp", "ceiling.vtp").code, 0);
  ASSERT_EQ(relight({"ceiling=off"}, "S.vtp", "desk.vtp").code, 0);
  const auto picture = [&](const std::string& name, const Words& how) {
    EXPECT_EQ(run(Words{"render", "office.toml", name + ".vtp", "-o", name + ".exr"} + how).code,
              0);
    return read_exr(folder / (name + ".exr")).radiance;
  };
  {
    // Every pixel has the same samples in each picture, and no shadow rays: the pictures differ by
    // float rounding alone. A sample has some ten operations with a relative error of 6e-8, on both
    // sides.
    const Words plain{"--pass", "interpolate", "--samples", "16"};
    const BandArray all = picture("S", plain);
    const BandArray sum = picture("ceiling", plain) + picture("desk", plain);
    EXPECT_LT((all - sum).abs().maxCoeff(), 2 * 10 * 6e-8 * all.maxCoeff());
  }
  const BandArray all = picture("S", {});
  const BandArray sum = picture("ceiling", {}) + picture("desk", {});
  // Shadow rays are distributed by each lamp's share of the light, and pixels are supersampled by
  // their contrast. A pixel that is supersampled in one picture alone differs by up to that
  // contrast, 10 %; if one pixel in a hundred does, at the edges of shadows, the RMS is 1 %.
  const double rms = std::sqrt((all - sum).cast<double>().square().mean());
  EXPECT_LT(rms, 0.01 * all.cast<double>().mean());
}

TEST_F(RelightCommand, PerLuminaireThereIsAChannelForEach) {
  const auto json = run_json(
      Words{"solve", "office.toml", "-o", "S.vtp", "--channels", "per-luminaire"} + quick());
  ASSERT_EQ(json["channels"].size(), 2u);
  EXPECT_EQ(json["channels"][0]["name"], "panel");
  EXPECT_EQ(json["channels"][1]["name"], "desk lamp");
  EXPECT_NE(json["options"].get<std::string>().find("--channels per-luminaire"), std::string::npos);
}

TEST_F(RelightCommand, WithoutChannelsTheFileIsAsEver) {
  ASSERT_EQ(run(Words{"solve", "office.toml", "-o", "S.vtp", "--channels", "off"} + quick()).code,
            0);
  EXPECT_TRUE(read_solution(folder / "S.vtp").solution.channels.empty());
  const Ended ended = relight({"desk=0.5"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("S.vtp: its light was not kept apart"), std::string::npos) << ended.err;
}

TEST_F(RelightCommand, StartsFromAnotherSolution) {
  solve();
  folder.write("grey.toml", [] {
    std::string text = office();
    const std::string white = "[0.7, 0.5, 0.3]";
    return text.replace(text.find(white), white.size(), "[0.68, 0.48, 0.3]");
  }());
  const Words more = Words{"--solver", "jacobi", "--tolerance", "1e-7"} + quick();
  const auto cold = run_json(Words{"solve", "grey.toml", "-o", "A.vtp"} + more);
  const auto warm =
      run_json(Words{"solve", "grey.toml", "-o", "B.vtp", "--start-from", "S.vtp"} + more);
  EXPECT_LT(warm["sweeps"].get<int>(), cold["sweeps"].get<int>());
  // The error of each B is at most 1e-7 of the lamp's 300 W/m2, in three bands on 60 m2.
  EXPECT_NEAR(warm["energy"]["absorbed"].get<double>(), cold["energy"]["absorbed"].get<double>(),
              2 * 1e-7 * 300 * 3 * 60);
  const Ended other = run(
      {"solve", "grey.toml", "-o", "C.vtp", "--start-from", "S.vtp", "--max-patch-size", "0.7"});
  EXPECT_EQ(other.code, 3);
  EXPECT_NE(other.err.find("the solution to start from has"), std::string::npos) << other.err;
}

struct Mistake {
  const char* name;
  Words arguments;
  int code;
  const char* says;
};

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) {
  return out << mistake.name;
}

TEST_F(RelightCommand, MistakesAreExplained) {
  solve();
  const Words solve_it = {"solve", "office.toml", "-o", "T.vtp"};
  const Words relight_it = {"relight", "S.vtp", "-o", "T.vtp", "--channel"};
  const Mistake mistakes[] = {
      {"UnknownChannel", relight_it + Words{"desc=0.5"}, 3,
       "S.vtp: there is no channel 'desc'; the solution has: desk, ceiling. Did you mean 'desk'?"},
      {"NoValue", relight_it + Words{"desk"}, 2, "'desk' is not NAME=VALUE"},
      {"EmptyValue", relight_it + Words{"desk="}, 2, "'desk=' is not NAME=VALUE"},
      {"NoNumber", relight_it + Words{"desk=bright"}, 2, "'bright' is no setting of a channel"},
      {"Negative", relight_it + Words{"desk=-0.5"}, 2, "'-0.5' is no setting"},
      {"Black", relight_it + Words{"desk=#000000"}, 2, "write off"},
      {"Twice", relight_it + Words{"desk=1", "--channel", "desk=2"}, 2, "'desk' is set twice"},
      {"NoChannel", {"relight", "S.vtp", "-o", "T.vtp"}, 2, "needs --channel or --cues"},
      {"NoSolution", {"relight", "none.vtp", "-o", "T.vtp", "--channel", "a=1"}, 3, "none.vtp"},
      {"NoEmitter", solve_it + Words{"--channels", "desk=dsk lamp"}, 3,
       "Did you mean 'desk lamp'?"},
      {"DarkSurface", solve_it + Words{"--channels", "a=room"}, 3, "emits no light"},
      {"TwoChannels", solve_it + Words{"--channels", "a=desk*", "--channels", "b=*lamp"}, 3,
       "in two channels"},
      {"NoPattern", solve_it + Words{"--channels", "desk"}, 2,
       "'desk' is not kinds, per-luminaire, off or NAME=PATTERN"},
      {"NoSuchChoice", solve_it + Words{"--channels", "per-lamp"}, 2, "per-luminaire"},
      {"BothWays", solve_it + Words{"--channels", "per-luminaire", "--channels", "desk=desk*"}, 2,
       "only one of them"}};
  for (const Mistake& mistake : mistakes) {
    const Ended ended = run(mistake.arguments);
    EXPECT_EQ(ended.code, mistake.code) << mistake << ": " << ended.err;
    EXPECT_EQ(ended.out, "") << mistake;
    EXPECT_NE(ended.err.find(mistake.says), std::string::npos) << mistake << ": " << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "T.vtp")) << mistake;
  }
}

}  // namespace
}  // namespace lightwell::relight_test
