// Readings of `render`, of a ray-traced still in the window and of the window's picture off screen,
// in rooms of four materials.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "tests/temporary_folder.h"
#include "tests/viewer/four_materials.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/still.h"
#include "viewer/window/x_display.h"

namespace lightwell::white_balance_test {
namespace {

using namespace four_materials;

/// The window's ray-traced picture (key R) of the room's camera.
std::vector<std::uint8_t> still_of(const SolutionView& view, const Scene& scene,
                                   const SolvedScene& solved) {
  Still still;
  still.begin(scene, solved, scene.cameras.front(), display_scale(view.look()));
  while (still.phase() == StillPhase::rendering) {
    still.advance();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(still.phase(), StillPhase::shown) << still.failure();
  return still.picture();
}

/// One formula and one meter: what differs is the light, interpolated from the mesh in the window,
/// and direct light traced anew in `render`. Gathers of 256 rays at vertices 0.25 m apart have 2 %
/// of noise and interpolation, which is at most 0.02 * 255 / 2.2 = 2.3 bytes; rounding adds 0.5.
TEST(WhiteBalance, TheWindowShowsTheColoursOfRender) {
  const DisplayConnection display;
  std::printf(
      "| light | material | as lit: render | still | window | auto: render | still | window |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const auto& [light, text] : lights_of_materials()) {
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.write("room.toml", text + room_of_materials));
    const SolvedScene solved = solved_room(scene);
    const Camera& camera = scene.cameras.front();
    std::array<std::array<std::vector<std::uint8_t>, 3>, 2> pictures;
    for (const auto kind : {WhitePoint::Kind::as_lit, WhitePoint::Kind::automatic}) {
      ViewOptions options{
          .camera = camera, .cameras = scene.cameras, .width = room_width, .height = room_height};
      options.white.kind = kind;
      options.materials = scene.materials;
      options.scene = &scene;
      const SolutionView view(solved, options);
      auto& of_kind = pictures[kind == WhitePoint::Kind::automatic ? 1 : 0];
      of_kind[0] = rendered_room(scene, solved, kind);
      ASSERT_FALSE(of_kind[0].empty());
      of_kind[1] = still_of(view, scene, solved);
      ASSERT_EQ(of_kind[1].size(), of_kind[0].size());
      of_kind[2] = draw_offscreen(view, room_width, room_height);
    }
    for (std::size_t m = 0; m < materials.size(); ++m) {
      std::string row = fmt::format("| {} | {} |", light, materials[m]);
      for (const auto& of_kind : pictures) {
        const Rgb wanted = reading_of(of_kind[0], static_cast<int>(m));
        for (const auto& picture : of_kind) {
          const Rgb seen = reading_of(picture, static_cast<int>(m));
          row += " " + text_of(seen) + " |";
          for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], wanted[c], 3.0) << row;
        }
      }
      std::printf("%s\n", row.c_str());
    }
    // Under a warm lamp paper is orange as lit, and grey by the light in view: the walls around are
    // grey, so its colour is that of the light to a few bytes.
    const Rgb lit = reading_of(pictures[0][2], 0), balanced = reading_of(pictures[1][2], 0);
    if (std::string(light) == "lamp, 2700 K") {
      EXPECT_GT(lit[0] - lit[2], 40.0);
    }
    EXPECT_NEAR(balanced[0], balanced[2], 12.0) << light;
  }
}

}  // namespace
}  // namespace lightwell::white_balance_test
