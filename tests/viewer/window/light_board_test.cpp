#include "viewer/window/light_board.h"

#include <gtest/gtest.h>
#include <vtkRenderWindowInteractor.h>

#include "radiosity/solution/solution_file.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/channel_room.h"
#include "viewer/window/walk_window.h"

namespace lightwell::light_board_test {
namespace {

const SolvedScene& room() {
  static const SolvedScene solved = solve_by_channel(channel_room());
  return solved;
}

TEST(LightBoard, ChoosesChannelsInTurnAndNone) {
  LightBoard board(room().solution);
  EXPECT_FALSE(board.is_chosen());
  EXPECT_EQ(board.text(), "desk 100 %  panel 100 %");
  board.choose(1);
  EXPECT_EQ(board.text(), "[desk 100 %]  panel 100 %");
  board.choose(1);
  EXPECT_EQ(board.text(), "desk 100 %  [panel 100 %]");
  board.choose(1);
  EXPECT_FALSE(board.is_chosen());
  board.choose(-1);
  EXPECT_EQ(board.text(), "desk 100 %  [panel 100 %]");
}

/// Three steps of a third of a stop halve the light; three steps back restore its bits.
TEST(LightBoard, DimsInThirdsOfAStop) {
  LightBoard board(room().solution);
  board.choose(1);
  for (int i = 0; i < 3; ++i) board.dim(-1);
  EXPECT_NEAR(board.scales()[0][1], 0.5f, 1e-6f);
  EXPECT_EQ(board.scales()[1][1], 1.0f) << "the other stays";
  for (int i = 0; i < 3; ++i) board.dim(1);
  EXPECT_EQ(board.scales()[0][1], 1.0f);
  for (int i = 0; i < 40; ++i) board.dim(-1);
  EXPECT_EQ(board.scales()[0][1], 0.0f);
  EXPECT_EQ(board.text(), "[desk off]  panel 100 %");
  board.dim(1);
  EXPECT_NEAR(board.scales()[0][1], 0.01f, 1e-6f);
  board.switch_chosen();
  EXPECT_EQ(board.scales()[0][1], 0.0f);
  board.switch_chosen();
  EXPECT_NEAR(board.scales()[0][1], 0.01f, 1e-6f);
}

/// A warm white keeps the luminous flux, by relight.h's definition of a colour.
TEST(LightBoard, ColoursKeepTheFlux) {
  LightBoard board(room().solution);
  EXPECT_NE(board.next_colour().find("choose"), std::string::npos);
  board.choose(1);
  EXPECT_EQ(board.next_colour(), "desk: 2700 K");
  const Spectrum scale = board.scales()[0];
  EXPECT_GT(scale[0], scale[2]);
  const Spectrum flux = room().solution.channels[0].energy.row(0).transpose().cast<float>();
  EXPECT_NEAR(luminous(rgb_bands(), scale * flux) / luminous(rgb_bands(), flux), 1.0, 1e-5);
  for (int i = 0; i < 3; ++i) board.next_colour();
  EXPECT_TRUE((board.scales()[0] == 1.0f).all());
}

TEST(LightBoard, BeginsWithWhatIsInForce) {
  const SolvedScene dimmed = relit(room(), {"0.25", "off"});
  const LightBoard board(dimmed.solution);
  EXPECT_EQ(board.text(), "desk 25 %  panel off");
}

/// Keys of the window relight as `lightwell relight` does; the saved file has the light in the
/// window.
TEST(LightKeys, RelightThePictureAndSaveIt) {
  const TemporaryFolder folder;
  ViewOptions options;
  const Scene scene = channel_room();
  options.cameras = scene.cameras;
  options.materials = scene.materials;
  options.width = options.height = 200;
  options.screenshot_folder = folder.path();
  WalkWindow window(room(), options);
  const auto tap = [&](const char* key) {
    window.press(key);
    window.release(key);
  };
  const double exposure = window.look().exposure_ev;
  for (const char* key : {"bracketright", "minus", "minus", "minus", "bracketright", "backslash"}) {
    tap(key);
  }
  EXPECT_EQ(window.look().exposure_ev, exposure) << "a chosen channel takes + and -";
  EXPECT_NE(window.status().find("desk 50 %  [panel off]"), std::string::npos) << window.status();
  const SolvedScene wanted = relit(room(), {"0.5", "off"});
  const BandArray E = window.solved().solution.irradiance();
  EXPECT_LT((E - wanted.solution.irradiance()).abs().maxCoeff(), 1e-6f * E.maxCoeff());
  window.tick(0.01);

  window.press("Control_L");
  tap("s");
  window.release("Control_L");
  const auto file = folder.path() / "lightwell-1.vtp";
  ASSERT_TRUE(std::filesystem::exists(file)) << window.message();
  EXPECT_TRUE((read_solution(file).solution.irradiance() == E).all());
  EXPECT_EQ(window.look().camera.position, scene.cameras[0].position) << "S alone walks";
}

TEST(LightKeys, SayWhenThereAreNoChannels) {
  SolvedScene plain = room();
  plain.solution.channels.clear();
  ViewOptions options;
  options.cameras = channel_room().cameras;
  WalkWindow window(plain, options);
  window.press("bracketright");
  EXPECT_NE(window.message().find("--channels"), std::string::npos);
}

}  // namespace
}  // namespace lightwell::light_board_test
