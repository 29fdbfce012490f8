#include "viewer/window/still.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "raytrace/render.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/channel_room.h"
#include "viewer/export/appearance.h"
#include "viewer/window/walk_window.h"

namespace lightwell::still_test {
namespace {

using namespace std::chrono_literals;

class StillTest : public testing::Test {
 protected:
  static const Scene& scene() {
    static const Scene room = channel_room();
    return room;
  }
  static const SolvedScene& solved() {
    static const SolvedScene solution = solve_by_channel(scene());
    return solution;
  }
  ViewOptions options() const {
    ViewOptions options;
    options.cameras = scene().cameras;
    options.materials = scene().materials;
    options.scene = &scene();
    options.width = options.height = 60;
    options.screenshot_folder = folder_.path();
    return options;
  }
  static bool tick_until(WalkWindow& window, StillPhase phase) {
    for (int i = 0; i < 6000 && window.still().phase() != phase; ++i) {
      window.tick(0.01);
      std::this_thread::sleep_for(5ms);
    }
    return window.still().phase() == phase;
  }
  /// A view with enough pixels for more than one strip.
  ViewOptions large_view() const {
    ViewOptions large = options();
    large.width = 640;
    large.height = 480;
    return large;
  }
  /// Starts a picture and waits for its first strip.
  static void start_still(WalkWindow& window) {
    window.tick(0.01);
    window.press("r");
    window.release("r");
    for (int i = 0; i < 60000 && window.still().rows() == 0; ++i) {
      window.tick(0.001);
      std::this_thread::sleep_for(1ms);
    }
  }
  TemporaryFolder folder_{};
};

/// The finished picture in the window has the bits of the second pass at the window's exposure.
TEST_F(StillTest, IsThePictureThatRenderMakes) {
  WalkWindow window(solved(), options());
  window.tick(0.01);
  window.press("r");
  window.release("r");
  EXPECT_EQ(window.still().phase(), StillPhase::rendering);
  ASSERT_TRUE(tick_until(window, StillPhase::shown));
  const ElementCaster caster(solved().mesh);
  const DirectLight direct_light(scene(), solved().mesh);
  const Image wanted =
      render(scene(), caster, direct_light, solved().solution, window.look().camera);
  EXPECT_TRUE((window.still().image().radiance == wanted.radiance).all());
  EXPECT_EQ(window.still().picture(),
            display_colors(wanted.radiance, solved().solution.bands, window.look().metered_scale));
  window.press("p");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "lightwell-1.png")) << window.message();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "lightwell-1.exr")) << window.message();
  EXPECT_EQ(read_exr(folder_ / "lightwell-1.exr").width, 60);
}

TEST_F(StillTest, IsThrownAwayWhenTheCameraMoves) {
  WalkWindow window(solved(), options());
  window.tick(0.01);
  window.press("r");
  window.release("r");
  ASSERT_TRUE(tick_until(window, StillPhase::shown));
  window.drag(5, 0);
  EXPECT_EQ(window.still().phase(), StillPhase::none);
  window.press("r");
  window.release("r");
  window.press("r");
  EXPECT_EQ(window.still().phase(), StillPhase::none) << "R again cancels";
}

/// Strips arrive from the top down, with the bits of the whole picture.
TEST_F(StillTest, ShowsWhatIsThereWhileItGoesOn) {
  WalkWindow window(solved(), large_view());
  start_still(window);
  const Still& still = window.still();
  ASSERT_EQ(still.phase(), StillPhase::rendering) << "a first strip, and not all at once";
  const int rows = still.rows();
  EXPECT_GT(rows, 0);
  EXPECT_LT(rows, 480);
  std::vector<std::uint8_t> first(still.picture().begin(),
                                  still.picture().begin() + 3 * 640 * rows);
  ASSERT_TRUE(tick_until(window, StillPhase::shown));
  EXPECT_EQ(still.rows(), 480);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), still.picture().begin()));
  EXPECT_EQ(still.picture(), display_colors(still.image().radiance, solved().solution.bands,
                                            window.look().metered_scale));
}

TEST_F(StillTest, ThrowsStripsAwayWhenTheCameraMoves) {
  WalkWindow window(solved(), large_view());
  start_still(window);
  window.drag(5, 0);
  EXPECT_EQ(window.still().phase(), StillPhase::none);
  EXPECT_EQ(window.still().rows(), 0);
}

TEST_F(StillTest, NeedsTheScene) {
  ViewOptions without = options();
  without.scene = nullptr;
  WalkWindow window(solved(), without);
  window.press("r");
  EXPECT_NE(window.message().find("scene"), std::string::npos);
}

}  // namespace
}  // namespace lightwell::still_test
