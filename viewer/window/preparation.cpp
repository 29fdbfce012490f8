#include "viewer/window/preparation.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "radiosity/solution/relight.h"

namespace lightwell {

using Clock = std::chrono::steady_clock;

struct Preparation::State {
  bool take_report(std::string_view phase, double part) {
    if (watch) watch(phase, part);
    const std::lock_guard lock(mutex);
    if (step != phase) {
      step = phase;
      began = Clock::now();
    }
    share = part;
    return !cancelled;
  }

  std::string status() const {
    const std::lock_guard lock(mutex);
    if (step.empty()) return "looking at the scene";
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    constexpr double least_share = 0.05;
    const std::string left =
        share > least_share ? time_left(seconds * (1.0 - share) / share) : std::string();
    return fmt::format("{} {:.0f} %{}{}", plain_words(step), 100.0 * share,
                       left.empty() ? "" : ", ", left);
  }

  Progress watch{};
  std::atomic<bool> cancelled{false}, done{false};
  PreparedSolve made{};
  std::exception_ptr failure{};
  mutable std::mutex mutex{};  // guards the members below
  std::string step{};
  double share = 0.0;
  Clock::time_point began{};
  std::thread thread{};
};

Preparation::Preparation(const Scene& scene, const LiveViewOptions& live, const Progress& watch)
    : state_(std::make_shared<State>()) {
  state_->watch = watch;
  state_->thread = std::thread([state = state_, &scene, live] {
    try {
      SolveOptions options = live.solve;
      // The LiveSolve may outlive the Preparation, and keeps the reports' target alive.
      options.run.progress = [state](std::string_view phase, double share) {
        return state->take_report(phase, share);
      };
      state->made.solve = std::make_unique<LiveSolve>(scene, options, live.provenance);
      state->made.dark = state->made.solve->dark();
      if (live.scales) relight(state->made.dark, live.scales(state->made.dark.solution));
    } catch (...) {
      state->failure = std::current_exception();
    }
    state->done = true;
  });
}

Preparation::~Preparation() {
  if (state_->thread.joinable()) {
    cancel();
    state_->thread.join();
  }
  state_->made = {};  // whose options share the state
}

void Preparation::cancel() {
  state_->cancelled = true;
}

bool Preparation::is_done() const {
  return state_->done;
}

std::string Preparation::status() const {
  return state_->status();
}

PreparedSolve Preparation::take() {
  if (state_->thread.joinable()) state_->thread.join();
  if (state_->failure) std::rethrow_exception(state_->failure);
  return std::move(state_->made);
}

}  // namespace lightwell
