// A window that is closed in each phase before and while light arrives: the work ends at its next
// report, whatever the phase. Times from the request to the end are printed.
#include "viewer/window/preparation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "scene/errors.h"
#include "scene/progress.h"
#include "scene/sky.h"
#include "tests/viewer/channel_room.h"

namespace lightwell::preparation_test {
namespace {

LiveViewOptions quick() {
  LiveViewOptions live;
  live.solve.mesh.max_patch_size = 0.25;
  live.solve.progressive.emplace();
  live.solve.gather.rays = 64;
  live.solve.error_points = 32;
  return live;
}

/// Phases in the order of their first reports, and how many reports came after a request to end.
class Phases {
 public:
  void report(std::string_view phase) {
    const std::lock_guard lock(mutex_);
    if (seen_.empty() || seen_.back() != phase) seen_.emplace_back(phase);
    if (is_asked_) ++late_;
    ++reports_;
  }
  void ask() {
    const std::lock_guard lock(mutex_);
    is_asked_ = true;
  }
  std::vector<std::string> seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }
  int late() const {
    const std::lock_guard lock(mutex_);
    return late_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> seen_{};
  bool is_asked_ = false;
  int reports_ = 0, late_ = 0;
};

std::vector<std::string> phases_of_preparation(const Scene& scene) {
  Phases phases;
  Preparation preparation(scene, quick(), [&](std::string_view phase, double) {
    phases.report(phase);
    return true;
  });
  EXPECT_NE(preparation.take().solve, nullptr);
  return phases.seen();
}

/// The hook asks for the end at the first report of a phase. No other report comes then: the report
/// itself says stop.
TEST(Preparation, EndsAtTheReportOfEachPhase) {
  const Scene scene = channel_room();
  const std::vector<std::string> phases = phases_of_preparation(scene);
  ASSERT_FALSE(phases.empty());
  for (const std::string& wanted : phases) {
    Phases seen;
    std::atomic<Preparation*> preparation{nullptr};
    bool is_asked = false;
    Preparation made(scene, quick(), [&](std::string_view phase, double) {
      while (!preparation) std::this_thread::yield();
      seen.report(phase);
      if (phase == wanted && !is_asked) {
        is_asked = true;
        seen.ask();
        preparation.load()->cancel();
      }
      return true;
    });
    preparation = &made;
    EXPECT_THROW(made.take(), Interrupted) << wanted;
    EXPECT_EQ(seen.seen().back(), wanted);
    EXPECT_EQ(seen.late(), 0) << wanted;
  }
}

TEST(Preparation, SaysWhatItDoesInPlainWords) {
  const Scene scene = channel_room();
  std::atomic<Preparation*> preparation{nullptr};
  std::string during;
  std::string last;
  Preparation made(scene, quick(), [&](std::string_view, double) {
    while (!preparation) std::this_thread::yield();
    last = preparation.load()->status();
    if (during.empty() && last != "looking at the scene") during = last;
    return true;
  });
  preparation = &made;
  EXPECT_NE(made.take().solve, nullptr);
  EXPECT_TRUE(made.is_done());
  EXPECT_NE(during.find(plain_words("mesh")), std::string::npos) << during;
}

TEST(Preparation, ThrowsWhatStoppedIt) {
  Scene scene = channel_room();
  for (Material& material : scene.materials) material.emission.setZero();
  Preparation made(scene, quick());
  EXPECT_THROW(made.take(), InputError);
}

/// Shooting finishes the present step at most; gathering ends at its next report.
TEST(LiveThread, EndsInEachPhaseAfterItsPresentStep) {
  const Scene scene = channel_room();
  for (const std::string wanted : {"shoot", "gather", "refine"}) {
    Phases seen;
    std::atomic<bool> is_reached{false}, may_go_on{false};
    LiveViewOptions options = quick();
    auto live = std::make_unique<LiveSolve>(scene, options.solve, Provenance{});
    live->start([&](std::string_view phase, double) {
      seen.report(phase);
      if (phase == wanted && !is_reached) {
        is_reached = true;
        while (!may_go_on) std::this_thread::yield();
      }
      return true;
    });
    if (wanted != "shoot") live->stop_shooting();
    while (!is_reached && live->state().phase < LivePhase::done) std::this_thread::yield();
    ASSERT_TRUE(is_reached) << wanted << " was never reported";
    seen.ask();
    live->ask_to_end();
    may_go_on = true;
    live.reset();
    EXPECT_EQ(seen.late(), 0) << wanted;
  }
}

}  // namespace
}  // namespace lightwell::preparation_test
