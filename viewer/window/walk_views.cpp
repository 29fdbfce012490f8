#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/window/walk_window.h"

namespace lightwell {
namespace {

constexpr double record_every = 0.1;  ///< s, between cameras of a path

}  // namespace

bool WalkWindow::advance(double seconds) {
  if (playing_) return play(seconds);
  WalkKeys keys = held_keys();
  if (walking_) keys.up = keys.down = false;
  const Eigen::Vector3d before = walk_.camera().position;
  bool moved = walk_.advance(keys, seconds);
  if (moved && pivot_ && walk_.camera().position != before) {
    pivot_.reset();  // a step ends the orbit
    update_text();
  }
  if (walking_) moved |= walk_on_foot(before, seconds);
  record(seconds);
  return moved;
}

bool WalkWindow::walk_on_foot(const Eigen::Vector3d& before, double seconds) {
  const Obstacles obstacles{
      view_->caster(), view_->kinds(), {.glass = true, .unlit = view_->look().unlit}};
  const Eigen::Vector3d way = walk_.camera().position - before;
  Eigen::Vector3d eye = before;
  if (way.norm() > 0.0) eye = physics_.move(obstacles, eye, way);
  eye = physics_.settle(obstacles, eye, seconds);
  walk_.move_eye_to(eye);
  // A thousandth of a step's height a second is too slow to see: drawing can rest.
  return (eye - before).norm() > 1e-3 * physics_.body().step * seconds;
}

void WalkWindow::switch_walking() {
  walking_ = !walking_;
  physics_.stand_still();
  pivot_.reset();
  const double unit = solved().solution.metres_per_unit;
  say(walking_ ? fmt::format("on foot, eyes {:.3g} {} high", physics_.body().eye_height / unit,
                             solved().solution.unit_name)
               : "flying");
}

void WalkWindow::jump() {
  if (walking_) physics_.jump();
}

void WalkWindow::switch_orbit() {
  if (std::exchange(pivot_, std::nullopt)) return say("");
  const auto [width, height] = size();
  const VisibleHit seen =
      visible_hit_at_pixel(view_->caster(), view_->kinds(), view_->look().camera, 0.5 * width,
                           0.5 * height, {.unlit = view_->look().unlit});
  const Bounds& bounds = view_->bounds();
  pivot_ = seen ? seen.position : Eigen::Vector3d(0.5 * (bounds.low + bounds.high));
  walking_ = false;
  say("drag goes around what is in the middle");
}

void WalkWindow::keep_bookmark(int digit) {
  views_.bookmarks[static_cast<std::size_t>(digit - 1)] = view_->look().camera;
  say(fmt::format("kept as bookmark {}", digit));
  keep_views();
}

void WalkWindow::keep_views() {
  if (options_.bookmark_file.empty()) return;
  try {
    write_views(options_.bookmark_file, views_);
  } catch (const std::exception& error) {
    say(error.what());
  }
}

void WalkWindow::switch_recording() {
  playing_ = false;
  recording_ = !recording_;
  path_seconds_ = 0.0;
  if (recording_) {
    recorded_ = {{0.0}, {view_->look().camera}};
    return say("walk; J ends the path");
  }
  views_.path = std::move(recorded_);
  keep_views();
  say(fmt::format("a path of {:.1f} s; Y plays it", views_.path.duration()));
}

void WalkWindow::record(double seconds) {
  if (!recording_) return;
  path_seconds_ += seconds;
  if (path_seconds_ - recorded_.seconds.back() < record_every) return;
  recorded_.seconds.push_back(path_seconds_);
  const auto [width, height] = size();
  recorded_.cameras.push_back(fit_to_window(walk_.camera(), width, height));
  update_text();
  changed_ = true;
}

void WalkWindow::switch_playing() {
  if (views_.path.empty() || recording_) return say("there is no path yet; J records one");
  playing_ = !playing_;
  path_seconds_ = 0.0;
  pivot_.reset();
  say("");
}

bool WalkWindow::play(double seconds) {
  path_seconds_ += seconds;
  Camera camera = views_.path.at(path_seconds_);
  camera.width = walk_.camera().width;
  camera.height = walk_.camera().height;
  // The walker's own angle of view stays: a path gives position and direction.
  camera.fov_degrees = walk_.camera().fov_degrees;
  walk_.place(camera);
  if (path_seconds_ >= views_.path.duration()) playing_ = false;
  return true;
}

void WalkWindow::switch_still() {
  if (still_.phase() == StillPhase::rendering || still_.phase() == StillPhase::shown) {
    still_.discard();
    update_text();
    changed_ = true;
    return;
  }
  if (!options_.scene) return say("the ray-traced picture needs the scene");
  if (live_ && live_state_.phase != LivePhase::done) {
    return say("the light is still arriving; Enter ends that, then R can trace the picture");
  }
  const Look& look = view_->look();
  still_.begin(*options_.scene, solved(), look.camera, display_scale(look));
  changed_ = true;
}

void WalkWindow::advance_still() {
  if (still_.phase() != StillPhase::rendering) return;
  changed_ |= still_.advance();
  if (still_.phase() == StillPhase::shown) return say("ray-traced; P saves it as PNG and EXR");
  if (still_.phase() == StillPhase::failed) return say(still_.failure());
  update_text();
}

bool WalkWindow::save_still() {
  if (still_.phase() != StillPhase::shown) return false;
  std::filesystem::path png;
  for (int i = 1; png.empty() || std::filesystem::exists(png); ++i) {
    png = options_.screenshot_folder / fmt::format("lightwell-{}.png", i);
  }
  std::filesystem::path exr = png;
  exr.replace_extension(".exr");
  try {
    const Image& image = still_.image();
    write_png(png, image.width, image.height, still_.picture());
    write_exr(exr, image, solved().solution.bands);
    say(fmt::format("saved {} and {}", png.string(), exr.filename().string()));
  } catch (const std::exception& error) {
    say(error.what());
  }
  return true;
}

}  // namespace lightwell
