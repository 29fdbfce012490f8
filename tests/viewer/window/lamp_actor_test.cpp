// Luminaires in the window.
#include "viewer/window/lamp_actor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/viewer/lamp_box.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/x_display.h"

namespace lightwell::lamp_actor_test {
namespace {

constexpr int width = 80, height = 60;

std::vector<int> middle_of(const SolutionView& view) {
  const auto picture = draw_offscreen(view, width, height);
  const auto at = picture.begin() + 3 * (width * (height / 2) + width / 2);
  return {at, at + 3};
}

/// The camera looks up at an opening far above white.
class LampActor : public testing::Test {
 protected:
  LampActor() {
    scene.lamps = {pendant({1, 1.2, 1})};
    options.camera = Camera{.position = {1, 0.3, 0.3},
                            .direction = Eigen::Vector3d(0, 0.9, 0.7).normalized(),
                            .up = Eigen::Vector3d(0, 0.7, -0.9).normalized(),
                            .fov_degrees = 40.0};
    options.width = width;
    options.height = height;
    options.scene = &scene;
  }

  const DisplayConnection display;
  Scene scene;
  ViewOptions options;
  const SolvedScene room = even_room();
};

TEST_F(LampActor, AnOpeningIsAsBrightAsItIs) {
  SolutionView view(room, options);
  EXPECT_EQ(middle_of(view), (std::vector<int>{255, 255, 255}));
  Look look = view.look();
  look.illuminance = true;
  look.measure = Measure::luminance;
  view.set_look(look);
  EXPECT_EQ(middle_of(view), (std::vector<int>{255, 237, 84})) << "the end of the scale";
}

TEST_F(LampActor, HiddenInIlluminanceAndWhereAsked) {
  scene.lamps[0].visible = false;
  const SolutionView without(room, options);
  const std::vector<int> wall = middle_of(without);
  EXPECT_LT(std::ranges::max(wall), 240) << "a wall of white under the mean light is 233";
  scene.lamps[0].visible = true;
  SolutionView view(room, options);
  Look look = view.look();
  look.illuminance = true;
  view.set_look(look);
  scene.lamps.clear();
  SolutionView bare(room, options);
  bare.set_look(look);
  EXPECT_EQ(middle_of(view), middle_of(bare));
}

}  // namespace
}  // namespace lightwell::lamp_actor_test
