#include "viewer/window/cue_player.h"

#include <gtest/gtest.h>
#include <vtkRenderWindowInteractor.h>

#include "tests/temporary_folder.h"
#include "tests/viewer/channel_room.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/walk_window.h"

namespace lightwell::cue_player_test {
namespace {

const SolvedScene& room() {
  static const SolvedScene solved = solve_by_channel(channel_room());
  return solved;
}

std::vector<Spectrum> levels(float desk, float panel) {
  return {Spectrum::Constant(3, desk), Spectrum::Constant(3, panel)};
}

std::vector<Cue> cues() {
  return {{.name = "work", .scales = levels(1.0f, 0.5f), .fade_down = 2.0, .hold = 1.0},
          {.name = "night", .scales = levels(0.25f, 0.0f), .fade_up = 1.0, .fade_down = 4.0},
          {.name = "full", .scales = levels(1.0f, 1.0f)}};
}

// The player's scales after `seconds`, at which the light must change.
std::vector<float> after(CuePlayer& player, double seconds, const RadiositySolution& solution) {
  const auto scales = player.advance(seconds, solution);
  if (!scales) return {};
  return {(*scales)[0][1], (*scales)[1][1]};
}

using Factors = std::vector<float>;

TEST(CuePlayer, GoFadesAndTheLightThenStays) {
  const RadiositySolution& solution = room().solution;  // both channels at 1
  CuePlayer player(cues());
  EXPECT_EQ(player.text(), "3 cues");
  EXPECT_EQ(after(player, 1.0, solution), Factors{}) << "nothing was begun";
  player.go(solution);
  EXPECT_EQ(player.text(), "cue 1/3 work, 0.0 s");
  EXPECT_EQ(after(player, 0.5, solution), (Factors{1.0f, 0.875f}));
  EXPECT_EQ(after(player, 1.5, solution), (Factors{1.0f, 0.5f}));
  EXPECT_EQ(player.text(), "cue 1/3 work");
  EXPECT_EQ(after(player, 9.0, solution), Factors{}) << "the next cue waits for its go";
}

TEST(CuePlayer, PlayingFollowsFadesAndHolds) {
  const RadiositySolution& solution = room().solution;
  CuePlayer player(cues());
  player.switch_playing(solution);
  EXPECT_EQ(after(player, 2.5, solution), (Factors{1.0f, 0.5f}));
  EXPECT_EQ(after(player, 0.25, solution), Factors{}) << "it holds";
  // A quarter of a second of the hold, then one of the fade, both channels falling.
  EXPECT_EQ(after(player, 1.25, solution), (Factors{0.8125f, 0.375f}));
  // The rest of the fade, after which the last cue is a cut.
  EXPECT_EQ(after(player, 10.0, solution), (Factors{1.0f, 1.0f}));
  EXPECT_FALSE(player.is_playing());
  player.switch_playing(solution);
  EXPECT_EQ(player.text(), "cue 1/3 work, 0.0 s") << "from the first again";
}

TEST(CuePlayer, BackIsAtOnce) {
  const RadiositySolution& solution = room().solution;
  std::vector<Cue> waiting = cues();
  for (Cue& cue : waiting) cue.wait = 0.5;
  CuePlayer player(waiting);
  player.back(solution);
  EXPECT_EQ(player.text(), "3 cues");
  player.go(solution);
  player.advance(5.0, solution);
  player.go(solution);
  player.advance(1.0, solution);
  player.back(solution);
  EXPECT_EQ(after(player, 0.01, solution), (Factors{1.0f, 0.5f}));
  EXPECT_EQ(player.text(), "cue 1/3 work");
}

class CuesInTheWindow : public testing::Test {
 protected:
  static ViewOptions options() {
    ViewOptions options{.cameras = channel_room().cameras, .width = 60, .height = 40};
    options.cues = cues();
    return options;
  }
  void tap(const char* key) {
    window_.press(key);
    window_.release(key);
  }
  WalkWindow window_{room(), options()};
};

/// The light of a cue that has arrived is that of relight(), to the last bit.
TEST_F(CuesInTheWindow, KeysStepThroughTheCues) {
  tap("period");
  window_.tick(3.0);
  SolvedScene wanted = room();
  relight(wanted, cues()[0].scales);
  EXPECT_TRUE(
      (window_.solved().solution.direct_irradiance == wanted.solution.direct_irradiance).all());
  EXPECT_NE(window_.status().find("cue 1/3 work"), std::string::npos) << window_.status();
  EXPECT_NE(window_.status().find("panel 50 %"), std::string::npos) << window_.status();
  tap("semicolon");
  for (int i = 0; i < 100; ++i) window_.tick(0.1);
  EXPECT_NE(window_.status().find("cue 3/3 full"), std::string::npos) << window_.status();
  EXPECT_EQ(window_.solved().solution.channels[0].scale[0], 1.0f);
  tap("comma");
  window_.tick(0.1);
  EXPECT_EQ(window_.solved().solution.channels[0].scale[0], 0.25f);
}

/// A channel that is set by hand during a fade keeps what the hand gave it.
TEST_F(CuesInTheWindow, AHandEndsTheFade) {
  tap("period");
  window_.tick(1.0);
  tap("bracketright");
  tap("backslash");
  const float panel = window_.solved().solution.channels[1].scale[0];
  // Half of the way from 1 to 0.5; the board's product of factor and colour rounds twice, 6e-8
  // each.
  EXPECT_NEAR(panel, 0.75f, 2 * 6e-8);
  window_.tick(1.0);
  EXPECT_EQ(window_.solved().solution.channels[0].scale[0], 0.0f);
  EXPECT_EQ(window_.solved().solution.channels[1].scale[0], panel);
}

TEST(WindowWithoutCues, SaysSo) {
  WalkWindow window(room(), {.width = 60, .height = 40});
  window.press("semicolon");
  EXPECT_NE(window.message().find("there are no cues"), std::string::npos);
}

/// The first and the last picture of a film are those of the solution and of the last cue; all have
/// the exposure of the brightest.
TEST(FilmOfCues, GoesThroughAllCues) {
  const TemporaryFolder folder;
  ViewOptions options{.cameras = channel_room().cameras, .width = 60, .height = 40};
  options.cues = {{.name = "dim", .scales = levels(0.0f, 0.25f), .fade_down = 1.0},
                  {.name = "off", .scales = levels(0.0f, 0.0f), .fade_down = 1.0},
                  {.name = "full", .scales = levels(1.0f, 1.0f), .fade_up = 2.0}};
  const auto files = write_film(room(), options, {.frames = 5}, (folder / "f-%d.png").string());
  ASSERT_EQ(files.size(), 5u);
  const auto bytes = [&](int frame) { return content_of(files[static_cast<std::size_t>(frame)]); };
  EXPECT_EQ(bytes(0), bytes(4)) << "the light of the solution at the begin and at the end";
  EXPECT_NE(bytes(1), bytes(0));
  EXPECT_NE(bytes(2), bytes(1));
  ViewOptions still = options;
  still.cues.clear();
  write_snapshot(room(), still, folder / "still.png");
  EXPECT_EQ(content_of(folder / "still.png"), bytes(0));

  options.cues[0].fade_down = options.cues[1].fade_down = options.cues[2].fade_up = 0.0;
  EXPECT_THROW(write_film(room(), options, {.frames = 5}, (folder / "g-%d.png").string()),
               InputError);
}

/// A surface that only lamps which are off would light is drawn as lit: a cue may switch them on.
TEST(ViewInTheDark, KnowsWhatLampsWouldLight) {
  const SolvedScene dark = relit(room(), {"off", "off"});
  EXPECT_EQ(SolutionView(dark, {}).kinds(), SolutionView(room(), {}).kinds());
}

}  // namespace
}  // namespace lightwell::cue_player_test
