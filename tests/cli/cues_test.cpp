// Lighting cues through the built program: relight, view and export.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "raytrace/pictures/image.h"
#include "tests/cli/program.h"

namespace lightwell::cues_test {
namespace {

using Words = std::vector<std::string>;

// small_room() with two more lamps.
std::string stage() {
  return small_room_with(R"(
[materials.bulb]
exitance = [300, 240, 150]
[[surfaces]]
name = "spot left"
material = "bulb"
polygon = [[1, 0.5, 1.2], [1, 0.7, 1.2], [1.2, 0.7, 1.2], [1.2, 0.5, 1.2]]
[[surfaces]]
name = "spot right"
material = "bulb"
polygon = [[3, 0.5, 1.2], [3, 0.7, 1.2], [3.2, 0.7, 1.2], [3.2, 0.5, 1.2]]
)");
}

constexpr const char* cue_file = R"([[cues]]
name = "work"
channels = { "spot*" = 0.5 }

[[cues]]
name = "late evening"
fade_up = 2
fade_down = 3
channels = { panel = "0.25,#ffd9b0", "spot left" = "off" }

[[cues]]
name = "night"
others = "off"
channels = { "spot left" = 0.125 }
hold = 1
)";

class CuesCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("stage.toml", stage());
    folder.write("cues.toml", cue_file);
    const Ended ended =
        run(Words{"solve", "stage.toml", "-o", "S.vtp", "--channels", "per-luminaire"} + quick());
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  std::string bytes(const std::string& file) const { return content_of(folder / file); }
};

/// A channel that a cue does not name keeps the value of the cue before: each solution is that of
/// all values given one by one, bit for bit.
TEST_F(CuesCommand, EachSolutionIsThatOfItsChannels) {
  const auto json = run_json({"relight", "S.vtp", "--cues", "cues.toml", "-o", "out"});
  ASSERT_EQ(json["cues"].size(), 3u);
  EXPECT_EQ(json["cues"][1]["name"], "late evening");
  EXPECT_EQ(json["cues"][1]["fade_up"], 2.0);
  EXPECT_EQ(json["cues"][1]["fade_down"], 3.0);
  EXPECT_EQ(json["cues"][2]["scales"]["panel"], nlohmann::json::array({0.0, 0.0, 0.0}));
  const Words settings[] = {{"panel=on", "spot left=0.5", "spot right=0.5"},
                            {"panel=0.25,#ffd9b0", "spot left=off", "spot right=0.5"},
                            {"panel=off", "spot left=0.125", "spot right=off"}};
  const char* const names[] = {"work", "late evening", "night"};
  for (std::size_t i = 0; i < std::size(names); ++i) {
    Words words{"relight", "S.vtp", "-o", "alone.vtp"};
    for (const std::string& setting : settings[i]) words = words + Words{"--channel", setting};
    ASSERT_EQ(run(words).code, 0);
    const std::string solution = bytes(std::string("out/") + names[i] + ".vtp");
    EXPECT_FALSE(solution.empty());
    EXPECT_TRUE(bytes("alone.vtp") == solution) << names[i];
  }
}

/// --channel sets what the first cue begins with, also by a pattern.
TEST_F(CuesCommand, ChannelsBeforeTheFirstCue) {
  ASSERT_EQ(
      run({"relight", "S.vtp", "--channel", "p*=0.5", "--cues", "cues.toml", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"relight", "S.vtp", "--channel", "panel=0.5", "--channel", "spot*=0.5", "-o",
                 "alone.vtp"})
                .code,
            0);
  EXPECT_TRUE(bytes("alone.vtp") == bytes("out/work.vtp"));
}

/// Light is linear in its channels: pictures of cues, seen without shadow rays, are too.
TEST_F(CuesCommand, PicturesAreOfTheCuesLight) {
  folder.write("cues.toml", R"([[cues]]
name = "both"
[cues.channels]
panel = 1
"spot*" = 2
[[cues]]
name = "panel"
channels = { "spot*" = 0 }
[[cues]]
name = "spots"
channels = { panel = 0, "spot*" = 2 }
)");
  const Words task{"relight", "S.vtp",      "--cues",      "cues.toml",  "-o",
                   "out",     "--pictures", "--scene",     "stage.toml", "--size",
                   "40x30",   "--pass",     "interpolate", "--samples",  "4"};
  const Ended ended = run(task);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto radiance = [&](const char* name) {
    return read_exr(folder / "out" / (std::string(name) + ".exr")).radiance;
  };
  const BandArray both = radiance("both"), sum = radiance("panel") + radiance("spots");
  // Ten operations on each side with a relative rounding of 6e-8.
  EXPECT_LT((both - sum).abs().maxCoeff(), 2 * 10 * 6e-8 * both.maxCoeff());
  EXPECT_GT(both.maxCoeff(), 0.0f);
  for (const char* const name : {"both", "panel", "spots"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / (std::string(name) + ".png"))) << name;
  }
}

/// The film ends with the picture of the last cue.
TEST_F(CuesCommand, FilmsAreOfTheFades) {
  const Words task{"relight", "S.vtp",      "--cues",     "cues.toml",  "-o",
                   "out",     "--pictures", "--scene",    "stage.toml", "--size",
                   "40x30",   "--pass",     "interpolate"};
  const auto json = run_json(task + Words{"--frames", "9"});
  EXPECT_EQ(json["film"]["frames"], 9);
  // 'work' and 'night' are cuts, and to 'late evening' all that changes falls in the same time: one
  // state a cue.
  EXPECT_EQ(json["film"]["rendered"], 3);
  EXPECT_TRUE(bytes("out/frame-0008.png") == bytes("out/night.png"));
  EXPECT_FALSE(bytes("out/frame-0004.png") == bytes("out/frame-0003.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "frame-0009.png"));
  EXPECT_EQ(run(Words{"relight", "S.vtp", "--cues", "cues.toml", "-o", "o", "--frames", "9"}).code,
            2)
      << "a film is one of pictures";
}

TEST_F(CuesCommand, PagesHoldTheCues) {
  const Ended ended = run({"export", "S.vtp", "--cues", "cues.toml", "-o", "page.html"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string page = bytes("page.html");
  EXPECT_NE(page.find(R"("cues":[{"name":"work","wait":0.0,"fade_up":0.0)"), std::string::npos);
  EXPECT_NE(page.find(R"({"name":"late evening","wait":0.0,"fade_up":2.0,"fade_down":3.0)"),
            std::string::npos);
}

struct Mistake {
  const char* name;
  const char* cues;
  Words arguments;
  int code;
  const char* says;
};

TEST_F(CuesCommand, MistakesAreExplained) {
  const Words relight{"relight", "S.vtp", "--cues", "bad.toml", "-o", "T"};
  const std::string good = "[[cues]]\nname = 'a'\nothers = 1\n";
  const Mistake mistakes[] = {
      {"NoFile", nullptr, relight, 3, "bad.toml"},
      {"Empty", "", relight, 3, "bad.toml:"},
      {"NoChannel", "[[cues]]\nname = 'a'\nchannels = {pannel = 1}", relight, 3,
       "bad.toml:3:22: level 'pannel' of cue 'a': there is no channel 'pannel'; the solution has: "
       "panel, spot left, spot right. Did you mean 'panel'?"},
      {"TwoPatterns", "[[cues]]\nname = 'a'\nchannels = {'s*' = 1, '*left' = 0}", relight, 3,
       "would have two settings"},
      {"Negative", "[[cues]]\nname = 'a'\nchannels = {panel = -1}", relight, 3,
       "bad.toml:3:21: level 'panel' of cue 'a': '-1' is no setting of a channel"},
      {"NegativeFade", "[[cues]]\nname = 'a'\nothers = 1\nfade = -1", relight, 3,
       "bad.toml:4:8: fade of cue 'a' is -1"},
      {"OutOfTheFolder", "[[cues]]\nname = '../a'\nothers = 1", relight, 3,
       "must not contain a slash"},
      {"InPlaceOfTheSolution",
       "[[cues]]\nname = 'S'\nothers = 1",
       {"relight", "S.vtp", "--cues", "bad.toml", "-o", "."},
       1,
       "the command reads the same file"},
      {"Neither", nullptr, {"relight", "S.vtp", "-o", "T.vtp"}, 2, "needs --channel or --cues"},
      {"NoFolder",
       nullptr,
       {"relight", "S.vtp", "-o", "T", "--channel", "panel=1"},
       2,
       "must end in .vtp; a folder is for --cues"},
      {"NoScene", good.c_str(), relight + Words{"--pictures"}, 2, "--scene"},
      {"NoPictures", good.c_str(), relight + Words{"--size", "20x20"}, 2, "--pictures"},
      {"PictureWithoutCues",
       nullptr,
       {"relight", "S.vtp", "-o", "T.vtp", "--channel", "panel=1", "--pictures", "--scene",
        "stage.toml"},
       2,
       "are of cues"},
      {"NoCamera", good.c_str(),
       relight + Words{"--pictures", "--scene", "stage.toml", "--camera", "dor"}, 3,
       "Did you mean 'door'?"},
      {"NoPage",
       good.c_str(),
       {"export", "S.vtp", "--cues", "bad.toml", "-o", "T.glb"},
       2,
       "is for pages"}};
  for (const Mistake& mistake : mistakes) {
    std::filesystem::remove(folder / "bad.toml");
    if (mistake.cues) folder.write("bad.toml", mistake.cues);
    const std::string before = bytes("S.vtp");
    const Ended ended = run(mistake.arguments);
    EXPECT_EQ(ended.code, mistake.code) << mistake.name << ": " << ended.err;
    EXPECT_EQ(ended.out, "") << mistake.name;
    EXPECT_NE(ended.err.find(mistake.says), std::string::npos) << mistake.name << ": " << ended.err;
    for (const char* const left : {"T", "T.vtp", "T.glb"}) {
      EXPECT_FALSE(std::filesystem::exists(folder / left)) << mistake.name << " leaves " << left;
    }
    EXPECT_TRUE(bytes("S.vtp") == before) << mistake.name;
  }
}

TEST_F(CuesCommand, ASolutionWithoutChannelsHasNoCues) {
  ASSERT_EQ(run(Words{"solve", "stage.toml", "-o", "W.vtp", "--channels", "off"} + quick()).code,
            0);
  const Ended ended = run({"relight", "W.vtp", "--cues", "cues.toml", "-o", "T"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("W.vtp: its light was not kept apart"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "T"));
}

#ifdef LIGHTWELL_VIEWER
TEST_F(CuesCommand, AWindowNeedsWhatCuesNeed) {
  const Ended live = run(
      {"view", "stage.toml", "--cues", "cues.toml", "--offscreen", "T-%d.png", "--frames", "3"});
  EXPECT_EQ(live.code, 3);
  EXPECT_NE(live.err.find("'--cues' needs a solution"), std::string::npos) << live.err;
  const Ended one =
      run({"view", "stage.toml", "S.vtp", "--cues", "cues.toml", "--offscreen", "T.png"});
  EXPECT_EQ(one.code, 3);
  EXPECT_NE(one.err.find("needs the number of pictures"), std::string::npos) << one.err;
}
#endif

}  // namespace
}  // namespace lightwell::cues_test
