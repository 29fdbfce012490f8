#include "viewer/window/live_solve.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/sanitizers.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/window/comes_true.h"
#include "viewer/window/walk_window.h"

namespace lightwell::live_solve_test {
namespace {

using namespace std::chrono_literals;

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.progressive.emplace();
  options.gather.rays = 64;
  options.refine.tolerance = 0.0;
  options.error_points = 32;
  return options;
}

/// The first shooters are the emitters, with the most unshot power. Before the first shot vertices
/// have the ambient term alone.
TEST(LiveSolve, LightArrivesShotByShot) {
  const Scene scene = channel_room();
  LiveSolve live(scene, quick(), {});
  EXPECT_EQ(live.light().irradiance.maxCoeff(), 0.0f);
  EXPECT_GT(live.light().ambient.minCoeff(), 0.0f);
  EXPECT_DOUBLE_EQ(live.light().unshot_share, 1.0);
  double unshot = 2.0;
  for (const int shots : {1, 2, 10, 110}) {
    live.shoot(shots);
    const LiveLight light = live.light();
    EXPECT_EQ(light.shots, shots);
    EXPECT_LT(light.unshot_share, unshot);
    EXPECT_GT(light.irradiance.maxCoeff(), 0.0f);
    unshot = light.unshot_share;
  }
}

/// Unshot light is the emission of lamps before the first shot, and falls with every shot.
TEST(LiveSolve, UnshotLightIsWhatPatchesAreStillToGive) {
  const Scene scene = channel_room();
  LiveSolve live(scene, quick(), {});
  const SolvedScene dark = live.dark();
  const PatchMesh& mesh = dark.mesh;
  const Eigen::ArrayXf first = live.light().unshot;
  ASSERT_EQ(first.size(), mesh.patch_count());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const double M = luminous(scene.bands, mesh.emission.row(p).transpose());
    EXPECT_NEAR(first[p], M, 1e-5 * M) << p;
  }
  const auto lumens = [&](const Eigen::ArrayXf& unshot) {
    return (mesh.area * unshot.cast<double>()).sum();
  };
  live.shoot(50);
  EXPECT_LT(lumens(live.light().unshot), 0.9 * lumens(first));
}

/// A note names the light that shots leave out, until the solution includes that light.
TEST(LiveSolve, SaysThatMirrorsSendTheirLightLater) {
  const Scene scene = channel_room();  // it has a mirror
  Scene without = scene;
  for (Material& material : without.materials) material.specular.setZero();
  const LiveSolve matt(without, quick(), {});
  EXPECT_EQ(text_of(matt.state()).find("mirrors"), std::string::npos);
  const LiveSolve polished(scene, quick(), {});
  LiveState state = polished.state();
  EXPECT_NE(text_of(state).find("mirrors and glass"), std::string::npos) << text_of(state);
  state.phase = LivePhase::done;
  EXPECT_EQ(text_of(state).find("mirrors"), std::string::npos) << text_of(state);
}

TEST(LiveSolve, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = channel_room();
  const auto after = [&](int threads) {
    const ThreadLimit limit(threads);
    LiveSolve live(scene, quick(), {});
    live.shoot(130);
    return live.light().irradiance;
  };
  EXPECT_TRUE((after(1) == after(3)).all());
}

/// Shots down to the tolerance leave the light of solve_scene. Both differ by the unshot power
/// (1e-3 of all power), the noise of shot rays and that of 64 gather rays on each side; 5 % of the
/// mean at vertices bounds the sum.
TEST(LiveSolve, EndsAtTheSolution) {
  const Scene scene = test::two_lamps();
  SolveOptions options = quick();
  LiveSolve live(scene, options, {.version = "test"});
  live.shoot(1 << 20);
  EXPECT_LE(live.light().unshot_share, options.progressive->tolerance);
  const SolvedScene solved = live.finish();
  const EnergyBalance& energy = solved.solution.energy;
  EXPECT_NEAR(energy.absorbed + energy.escaped + energy.unshot, energy.emitted,
              1e-4 * energy.emitted);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  EXPECT_EQ(solved.solution.provenance.version, "test");
  EXPECT_EQ(solved.solution.provenance.scene_hash, scene_hash(scene));

  const SolvedScene wanted = solve_scene(scene, options);
  ASSERT_EQ(solved.mesh.vertex_count(), wanted.mesh.vertex_count());
  const auto mean = wanted.solution.irradiance().mean();
  const auto difference =
      (solved.solution.irradiance() - wanted.solution.irradiance()).abs().mean();
  EXPECT_LT(difference, 0.05f * mean);
  // The light shown meanwhile is the same, received shot by shot instead of gathered.
  const auto shown = (live.light().irradiance - wanted.solution.irradiance()).abs().mean();
  EXPECT_LT(shown, 0.1f * mean);
}

TEST(LiveSolve, WhatIsEndedEarlySaysSo) {
  const Scene scene = test::two_lamps();
  LiveSolve live(scene, quick(), {});
  live.shoot(20);
  const double unshot = live.light().unshot_share;
  const SolvedScene solved = live.finish();
  EXPECT_EQ(solved.solution.outcome, Outcome::max_sweeps_reached);
  EXPECT_NEAR(solved.solution.energy.unshot / solved.solution.energy.emitted, unshot, 1e-6);
}

/// Channels are columns of the same shots: the sum of light is the same, and the light of a dimmed
/// lamp is scaled by the lamp's factor, before the solution and after.
TEST(LiveSolve, DimsALampWhileItsLightArrives) {
  const Scene scene = channel_room();
  SolveOptions options = quick();
  LiveSolve together(scene, options, {});
  options.channels = channels_per_luminaire(scene);
  LiveSolve apart(scene, options, {});
  together.shoot(60);
  apart.shoot(60);
  SolvedScene whole = together.dark();
  show_light(together.light(), true, whole);
  SolvedScene shown = apart.dark();
  EXPECT_EQ(shown.solution.channels.size(), 2u);
  show_light(apart.light(), true, shown);
  const BandArray E = whole.solution.irradiance();
  const float rounding = 1e-4f * E.maxCoeff();  // of sums in another order
  EXPECT_LT((shown.solution.irradiance() - E).abs().maxCoeff(), rounding);

  const auto dimmed = [&](const LiveLight& light, const char* desk, const char* panel) {
    SolvedScene scene_of = relit(apart.dark(), {desk, panel});
    show_light(light, true, scene_of);
    return scene_of;
  };
  const SolvedScene desk = dimmed(apart.light(), "on", "off");
  const SolvedScene panel = dimmed(apart.light(), "off", "0.5");
  EXPECT_LT((desk.solution.irradiance() + 2.0f * panel.solution.irradiance() - E).abs().maxCoeff(),
            rounding);
  EXPECT_GT(desk.solution.irradiance().maxCoeff(), 0.0f);
  for (int i = 0; i < panel.mesh.patch_count(); ++i) {
    const float scale = panel.solution.patch_channel[i] == 1 ? 0.5f : 0.0f;
    EXPECT_EQ(panel.mesh.emission(i, 0), scale * panel.solution.full_emission(i, 0));
  }

  const SolvedScene solved = apart.finish();
  ASSERT_EQ(solved.solution.channels.size(), 2u);
  const BandArray sum =
      solved.solution.channels[0].direct_irradiance + solved.solution.channels[1].direct_irradiance;
  EXPECT_LT((sum - solved.solution.direct_irradiance).abs().maxCoeff(), rounding);
}

TEST(LiveSolve, RefusesASceneWithoutLight) {
  Scene scene = test::two_lamps();
  for (Material& material : scene.materials) material.emission.setZero();
  EXPECT_THROW(LiveSolve(scene, quick(), {}), InputError);
}

TEST(LiveThread, PausesStepsAndEnds) {
  const Scene scene = test::two_lamps();
  LiveSolve live(scene, quick(), {});
  live.set_paused(true);
  live.start();
  EXPECT_TRUE(test::comes_true([&] { return live.take_light().has_value(); }));
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(live.state().shots, 0);
  EXPECT_EQ(live.state().phase, LivePhase::paused);
  for (int shots = 1; shots < 4; ++shots) {
    live.step_once();
    EXPECT_TRUE(test::comes_true([&] { return live.state().shots == shots; }));
    EXPECT_TRUE(test::comes_true([&] {
      const auto light = live.take_light();
      return light && light->shots == shots;
    })) << "every step is shown";
  }
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(live.state().shots, 3);
  live.set_paused(false);
  EXPECT_TRUE(test::comes_true([&] { return live.state().shots > 3; }));
  live.stop_shooting();
  std::optional<SolvedScene> solved;
  EXPECT_TRUE(test::comes_true([&] {
    solved = live.take_solution();
    return solved.has_value();
  }));
  EXPECT_EQ(live.state().phase, LivePhase::done);
}

/// The destructor, called when the window closes, ends the thread in any phase.
TEST(LiveThread, EndsAtOnceWhateverItDoes) {
  const Scene scene = test::two_lamps();
  for (const auto wait : {0ms, 20ms, 200ms}) {
    for (const bool gathering : {false, true}) {
      auto live = std::make_unique<LiveSolve>(scene, quick(), Provenance{});
      live->start();
      if (gathering) live->stop_shooting();
      std::this_thread::sleep_for(wait);
      const auto start = std::chrono::steady_clock::now();
      live.reset();
      EXPECT_LT(std::chrono::steady_clock::now() - start, 5s * test::slowdown);
    }
  }
}

/// The window during a solve: light, keys, exposure meter, and a saved file that is a solution.
TEST(LiveWindow, ShowsPausesAndSaves) {
  const TemporaryFolder folder;
  const Scene scene = test::two_lamps();
  ViewOptions options;
  options.cameras = channel_room().cameras;
  options.width = options.height = 120;
  options.solution_file = folder.path() / "live.vtp";
  LiveSolve live(scene, quick(), {});
  WalkWindow window(live, live.dark(), options);
  const auto tap = [&](const char* key) {
    window.press(key);
    window.release(key);
  };
  EXPECT_GT(window.solved().solution.indirect_irradiance.minCoeff(), 0.0f) << "the ambient term";
  tap("b");
  EXPECT_EQ(window.solved().solution.irradiance().maxCoeff(), 0.0f);
  tap("b");
  live.set_paused(true);
  live.start();
  tap("n");
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return window.status().find("step 1,") != std::string::npos;
  })) << window.status();
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return window.solved().solution.direct_irradiance.maxCoeff() > 0.0f;
  }));
  EXPECT_NE(window.status().find("% still to come"), std::string::npos) << window.status();
  window.press("Control_L");
  tap("s");
  window.release("Control_L");
  EXPECT_NE(window.message().find("Enter"), std::string::npos) << "there is no solution yet";
  tap("Return");
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return std::filesystem::exists(options.solution_file);
  })) << window.status();
  const SolvedScene saved = read_solution(options.solution_file);
  EXPECT_NO_THROW(check_matches(scene, saved.solution));
  EXPECT_TRUE((saved.solution.irradiance() == window.solved().solution.irradiance()).all());
}

/// Keys dim a lamp while light arrives; the following solution has the same scale.
TEST(LiveWindow, KeepsALampDimmedInTheSolution) {
  const TemporaryFolder folder;
  const Scene scene = channel_room();
  ViewOptions options;
  options.solution_file = folder.path() / "dimmed.vtp";
  options.cameras = scene.cameras;
  options.width = options.height = 120;
  SolveOptions solving = quick();
  solving.channels = channels_per_luminaire(scene);
  LiveSolve live(scene, solving, {});
  WalkWindow window(live, live.dark(), options);
  const auto tap = [&](const char* key) {
    window.press(key);
    window.release(key);
  };
  const float before = window.solved().solution.irradiance().mean();
  tap("bracketright");
  tap("backslash");
  EXPECT_NE(window.status().find("[desk off]"), std::string::npos) << window.status();
  const float after = window.solved().solution.irradiance().mean();
  EXPECT_LT(after, before);
  live.start();
  tap("Return");
  EXPECT_TRUE(test::comes_true([&] {
    window.tick(0.01);
    return live.state().phase == LivePhase::done && !window.solved().solution.seconds.empty();
  }));
  const RadiositySolution& solved = window.solved().solution;
  ASSERT_EQ(solved.channels.size(), 2u);
  EXPECT_EQ(solved.channels[0].scale.maxCoeff(), 0.0f);
  EXPECT_TRUE((solved.direct_irradiance == solved.channels[1].direct_irradiance).all());
}

}  // namespace
}  // namespace lightwell::live_solve_test
