// A first look by virtual lights: made in a thread, shown until the solve has better light.
#include "viewer/window/preview.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "raytrace/virtual_lights/sketch.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/window/comes_true.h"
#include "viewer/window/walk_window.h"

namespace lightwell::preview_test {
namespace {

using namespace std::chrono_literals;

LiveViewOptions quick() {
  LiveViewOptions live;
  live.solve.mesh.max_patch_size = 0.5;
  live.solve.progressive.emplace();
  live.solve.gather.rays = 64;
  live.solve.refine.tolerance = 0.0;
  live.solve.error_points = 32;
  return live;
}

ViewOptions small_window() {
  ViewOptions options;
  options.cameras = channel_room().cameras;
  options.width = options.height = 120;
  return options;
}

void tap(WalkWindow& window, const char* key) {
  window.press(key);
  window.release(key);
}

TEST(Preview, IsTheSketchOfTheScene) {
  const Scene scene = channel_room();
  Preview preview(scene, {.scene_file = "room.toml"});
  ASSERT_TRUE(test::comes_true([&] { return preview.is_ready(); }));
  const std::optional<SolvedScene> taken = preview.take();
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE((taken->solution.irradiance() == sketch_scene(scene).solution.irradiance()).all());
  EXPECT_EQ(taken->solution.provenance.scene_file, "room.toml");
  EXPECT_FALSE(preview.take().has_value());
}

/// The hook cancels at the first report of each phase: the report itself says stop, so that no
/// other follows and no sketch is left.
TEST(Preview, EndsAtTheReportOfEachPhase) {
  const Scene scene = channel_room();
  for (const std::string wanted : {"mesh", "photons", "virtual lights", "sketch"}) {
    std::atomic<Preview*> preview{nullptr};
    std::atomic<int> seen{0}, late{0};
    {
      Preview made(scene, {}, [&](std::string_view phase, double) {
        while (!preview) std::this_thread::yield();
        if (seen > 0) ++late;
        if (phase != wanted) return true;
        ++seen;
        preview.load()->cancel();
        return true;
      });
      preview = &made;
      EXPECT_TRUE(test::comes_true([&] { return seen > 0; })) << wanted << " was never reported";
      EXPECT_FALSE(made.is_ready()) << wanted;
      EXPECT_FALSE(made.take().has_value()) << wanted;
    }
    EXPECT_EQ(late, 0) << wanted;
  }
}

TEST(Preview, GivesWayToShotsWhenLittleIsToCome) {
  LiveState state{.unshot_share = 0.5};
  EXPECT_FALSE(surpasses_sketch(state));
  state.unshot_share = 0.01;
  EXPECT_TRUE(surpasses_sketch(state));
  state.lacks_specular = true;
  EXPECT_FALSE(surpasses_sketch(state)) << "shots lack the light by way of mirrors";
}

/// The preparation waits at its first report until the window has shown the sketch. Then shots
/// arrive unseen until they surpass it, and the solution follows.
TEST(PreviewWindow, IsLitBeforeTheSolveIsPrepared) {
  const Scene scene = test::two_lamps();
  std::atomic<bool> may_go_on{false};
  Preparation preparation(scene, quick(), [&](std::string_view, double) {
    while (!may_go_on) std::this_thread::yield();
    return true;
  });
  WalkWindow window(sketch_scene(scene), preparation, small_window());
  window.tick(0.01);
  EXPECT_TRUE(window.shows_sketch());
  EXPECT_NE(window.status().find("first look"), std::string::npos) << window.status();
  EXPECT_GT(window.solved().solution.irradiance().maxCoeff(), 0.0f);
  tap(window, "n");
  EXPECT_NE(window.message().find("prepared"), std::string::npos) << "nothing can shoot yet";
  may_go_on = true;
  const int vertices = window.solved().mesh.vertex_count();
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return !window.shows_sketch();
  })) << window.status();
  EXPECT_NE(window.solved().mesh.vertex_count(), vertices) << "the mesh of the solve";
  EXPECT_EQ(window.status().find("first look"), std::string::npos) << window.status();
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return window.status().find("solved in") != std::string::npos;
  })) << window.status();
  EXPECT_GT(window.solved().solution.direct_irradiance.maxCoeff(), 0.0f);
}

/// A sketch that comes while patches shoot is shown; keys that ask for the shots themselves show
/// these.
TEST(PreviewWindow, ShowsTheShotsThatKeysAskFor) {
  const Scene scene = test::two_lamps();
  for (const char* const key : {"n", "z", "b"}) {
    LiveSolve live(scene, quick().solve, {});
    Preview preview(scene, {});
    WalkWindow window(live, live.dark(), small_window());
    window.expect(preview);
    EXPECT_FALSE(window.shows_sketch());
    live.set_paused(true);
    live.start();
    EXPECT_TRUE(test::comes_true([&] {
      window.tick(0.01);
      return window.shows_sketch();
    }));
    const int vertices = window.solved().mesh.vertex_count();
    tap(window, key);
    EXPECT_FALSE(window.shows_sketch()) << key;
    EXPECT_EQ(window.solved().mesh.vertex_count(), live.dark().mesh.vertex_count());
    EXPECT_NE(window.solved().mesh.vertex_count(), vertices);
  }
}

/// A lamp cannot be dimmed in the sketch, whose light is not kept apart.
TEST(PreviewWindow, ShowsTheShotsOfADimmedLamp) {
  const Scene scene = channel_room();
  SolveOptions solving = quick().solve;
  solving.channels = channels_per_luminaire(scene);
  LiveSolve live(scene, solving, {});
  Preview preview(scene, {});
  WalkWindow window(live, live.dark(), small_window());
  window.expect(preview);
  live.set_paused(true);
  live.start();
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return window.shows_sketch();
  }));
  tap(window, "bracketright");
  EXPECT_TRUE(window.shows_sketch()) << "choosing a channel changes no light";
  tap(window, "backslash");
  EXPECT_FALSE(window.shows_sketch());
  EXPECT_EQ(window.solved().solution.channels[0].scale.maxCoeff(), 0.0f);
}

/// Shots lack the light of a mirror to the end, so the sketch stays until the solution.
TEST(PreviewWindow, KeepsTheLightOfMirrorsUntilTheSolution) {
  const Scene scene = channel_room();
  Preparation preparation(scene, quick());
  WalkWindow window(sketch_scene(scene), preparation, small_window());
  bool was_solved = false;
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    was_solved = window.status().find("solved in") != std::string::npos;
    return !window.shows_sketch();
  })) << window.status();
  EXPECT_TRUE(was_solved) << window.status();
}

}  // namespace
}  // namespace lightwell::preview_test
