#include <fmt/format.h>

#include <utility>

#include "radiosity/solution/relight.h"
#include "radiosity/solution/solution_file.h"
#include "viewer/window/walk_window.h"

namespace lightwell {
namespace {

/// Returns the first free name of STEM-1.vtp, STEM-2.vtp ...
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const char* extension) {
  for (int i = 1;; ++i) {
    std::filesystem::path file = folder / fmt::format("{}-{}{}", stem, i, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

}  // namespace

void WalkWindow::choose_channel(int step) {
  if (!lights_.has_channels()) {
    return say("the light was not kept apart in channels; solve with --channels per-luminaire");
  }
  lights_.choose(step);
  update_text();
  changed_ = true;
}

void WalkWindow::switch_channel() {
  if (!lights_.is_chosen()) return choose_channel(1);
  lights_.switch_chosen();
  relight_now();
}

void WalkWindow::next_colour() {
  if (!lights_.is_chosen()) return choose_channel(1);
  say(lights_.next_colour());
  relight_now();
}

void WalkWindow::light_up(int steps) {
  if (!lights_.is_chosen()) return expose(steps / 3.0);
  lights_.dim(steps);
  relight_now();
}

void WalkWindow::relight_now() {
  cues_.stop();
  relight_to(lights_.scales());
}

void WalkWindow::relight_to(const std::vector<Spectrum>& scales) {
  leave_sketch();  // whose light is not kept apart in channels
  still_.discard();
  if (!own_) {
    own_ = std::make_unique<SolvedScene>(view_->solved());
    relight(*own_, scales);
    view_->follow(*own_);
  } else {
    relight(*own_, scales);
    view_->light_changed();
  }
  pointer_.light_changed(*view_, true);
  update_pointer();
  update_text();
}

void WalkWindow::next_cue() {
  if (!cues_.has_cues()) return say("there are no cues; --cues FILE gives them");
  cues_.go(solved().solution);
}

void WalkWindow::previous_cue() {
  if (!cues_.has_cues()) return next_cue();
  cues_.back(solved().solution);
}

void WalkWindow::switch_cues() {
  if (!cues_.has_cues()) return next_cue();
  cues_.switch_playing(solved().solution);
}

void WalkWindow::fade(double seconds) {
  const std::string before = cues_.text();
  if (const auto scales = cues_.advance(seconds, solved().solution)) {
    lights_.follow(*scales);
    relight_to(*scales);
  } else if (cues_.text() != before) {
    update_text();
    changed_ = true;
  }
}

void WalkWindow::save_solution() {
  if (preparing_ || (live_ && live_state_.phase != LivePhase::done)) {
    return say("the light is still arriving; Enter stops, gathers a solution and saves it");
  }
  const std::string scene =
      std::filesystem::path(solved().solution.provenance.scene_file).stem().string();
  const std::filesystem::path file =
      options_.solution_file.empty()
          ? free_name(options_.screenshot_folder, scene.empty() ? "lightwell" : scene, ".vtp")
          : options_.solution_file;
  try {
    write_solution(file, solved());
    say("saved " + file.string());
  } catch (const std::exception& error) {
    say(error.what());
  }
}

}  // namespace lightwell
