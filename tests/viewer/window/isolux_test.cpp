#include "viewer/window/isolux.h"

#include <gtest/gtest.h>

#include "tests/viewer/solved_box.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/walk_window.h"
#include "viewer/window/x_display.h"

namespace lightwell::isolux_test {
namespace {

/// A wall 2 m wide with illuminance that rises linearly from left to right, seen from the front.
SolvedScene ramp() {
  SolvedQuads quads;
  const Eigen::Array3f dim = 0.0f * grey, bright = 2.0f * grey;
  quads.add({{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}}}, {dim, dim, bright, bright});
  return quads.solved();
}

ViewOptions options_at(std::vector<double> levels) {
  ViewOptions options;
  Camera camera = box_camera();
  camera.position = {1, 1, -3};
  options.cameras = {camera};
  options.width = 200;
  options.height = 150;
  options.isolux = std::move(levels);
  return options;
}

/// The line of 683 lx is vertical, in the middle of the picture, white on black. World +x is on the
/// left.
TEST(Isolux, LiesWhereTheLightHasThatValue) {
  const DisplayConnection display;
  const SolvedScene wall = ramp();
  const SolutionView with(wall, options_at({683.0})), without(wall, options_at({}));
  const auto lines = draw_offscreen(with, 200, 150), plain = draw_offscreen(without, 200, 150);
  int changed_beside = 0, changed_on = 0;
  for (int y = 20; y < 130; ++y) {
    for (int x = 0; x < 200; ++x) {
      const std::size_t i = 3 * (static_cast<std::size_t>(y) * 200 + x);
      const bool changed = std::abs(lines[i] - plain[i]) > 8;
      // The line is 3 pixels wide, its number some 40.
      changed_on += changed && std::abs(x - 100) <= 3;
      changed_beside += changed && std::abs(x - 100) > 25;
    }
  }
  EXPECT_GT(changed_on, 110);
  EXPECT_EQ(changed_beside, 0);
}

/// The back of the wall is not drawn and has no lines.
TEST(Isolux, IsNotSeenFromBehind) {
  const DisplayConnection display;
  const SolvedScene wall = ramp();
  ViewOptions options = options_at({683.0});
  options.cameras[0].position.z() = 3;
  options.cameras[0].direction.z() = -1;
  const SolutionView view(wall, options);
  for (const std::uint8_t byte : draw_offscreen(view, 200, 150)) ASSERT_EQ(byte, 0);
}

TEST(Isolux, KeySwitchesLinesAtTheStepsOfTheScale) {
  const SolvedScene wall = ramp();
  WalkWindow window(wall, options_at({}));
  EXPECT_FALSE(window.look().isolux);
  window.press("i");
  EXPECT_TRUE(window.look().isolux);
  window.tick(0.01);
  const WalkWindow with_levels(wall, options_at({100.0}));
  EXPECT_TRUE(with_levels.look().isolux);
}

}  // namespace
}  // namespace lightwell::isolux_test
