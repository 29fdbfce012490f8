#include "viewer/window/walk_window.h"

#include <fmt/format.h>
#include <vtkInteractorStyle.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "raytrace/pictures/image.h"
#include "viewer/window/vtk_messages.h"
#include "viewer/window/walk_style.h"
#include "viewer/window/x_display.h"

namespace lightwell {
namespace {

constexpr unsigned long frame_milliseconds = 15;
/// Longest time step of a walk, s. Time beyond the step does not count: after a long
/// drawing the walk slows instead of jumping, and the body has not fallen meanwhile.
constexpr double longest_step = 0.25;
constexpr double message_duration = 4.0;  ///< s
constexpr double drag_degrees = 120.0;    ///< angle of a drag across the whole window
constexpr double wheel_share = 0.03;      ///< share of the scene's diagonal per click of the wheel

bool is_inside(const Bounds& bounds, const Eigen::Vector3d& point) {
  return (point.array() > bounds.low.array()).all() && (point.array() < bounds.high.array()).all();
}

}  // namespace

std::string window_title(const std::string& scene) {
  return scene.empty() ? "Lightwell" : "Lightwell - " + scene;
}

namespace {

std::string white_text(const WhitePoint& white) {
  switch (white.kind) {
    case WhitePoint::Kind::as_lit:
      return "colours as lit";
    case WhitePoint::Kind::automatic:
      return "white by the light in view";
    case WhitePoint::Kind::black_body:
      break;
  }
  return fmt::format("white by {:g} K", white.kelvin);
}

}  // namespace

double walking_speed(double scene_diagonal) {
  constexpr double room = 7.0;  ///< m
  const double pace = 0.2 * std::min(scene_diagonal, room);
  return scene_diagonal > room ? pace * std::sqrt(scene_diagonal / room) : pace;
}

WalkWindow::WalkWindow(const SolvedScene& solved, const ViewOptions& options)
    : WalkWindow(&solved, nullptr, nullptr, options) {}

WalkWindow::WalkWindow(const SolvedScene* shown, std::unique_ptr<SolvedScene> own, LiveSolve* live,
                       const ViewOptions& options, const OpenWindow* opened)
    : options_(options),
      is_opened_(options.from_outside && !options.look_through),
      own_(std::move(own)),
      live_(live),
      view_(std::make_unique<SolutionView>(own_ ? *own_ : *shown, options_)),
      walk_(view_->start_camera(), view_->up_axis(), walking_speed(view_->bounds().diagonal())),
      physics_(walk_body(view_->bounds(), view_->up_axis(), options.eye_height), view_->up_axis()),
      walking_(options.walk),
      lights_(view_->solved().solution),
      cues_(options.cues),
      pointer_(options.scene, options.names),
      overlay_(text_scale_of(options)),
      window_(opened ? opened->window : vtkSmartPointer<vtkRenderWindow>::New()),
      interactor_(opened ? opened->interactor : vtkSmartPointer<vtkRenderWindowInteractor>::New()) {
  still_.add_to(view_->renderer());
  overlay_.add_to(view_->renderer());
  marks_.add_to(view_->renderer());
  say("H shows the keys");
  try {
    if (std::filesystem::exists(options_.bookmark_file)) {
      views_ = read_views(options_.bookmark_file);
    }
  } catch (const std::exception& error) {
    say(error.what());
  }

  const std::string scene =
      std::filesystem::path(solved().solution.provenance.scene_file).filename().string();
  window_->SetWindowName(window_title(scene).c_str());
  if (!opened) window_->SetSize(std::max(1, options_.width), std::max(1, options_.height));
  window_->SetMultiSamples(4);
  window_->AddRenderer(view_->renderer());
  interactor_->SetRenderWindow(window_);
  interactor_->SetInteractorStyle(make_walk_style(this));
  change(current_look());
}

// The interactor style keeps a pointer to this object.
WalkWindow::~WalkWindow() {
  interactor_->SetInteractorStyle(nullptr);
}

vtkRenderWindowInteractor* WalkWindow::interactor() const {
  return interactor_;
}

void WalkWindow::run() {
  const VtkMessages messages;
  window_->Render();
  // Software drivers are too slow for four samples a pixel.
  const std::string driver = window_->ReportCapabilities();
  for (const char* software : {"llvmpipe", "softpipe", "SWR", "SwiftShader"}) {
    if (driver.find(software) != std::string::npos) window_->SetMultiSamples(0);
  }
  interactor_->Initialize();
  report_held_keys_once(window_->GetGenericDisplayId());
  interactor_->CreateRepeatingTimer(frame_milliseconds);
  interactor_->Start();
  // Whatever still runs ends out of sight.
  hide_window(window_->GetGenericDisplayId(), window_->GetGenericWindowId());
  if (failure_) std::rethrow_exception(failure_);
}

void WalkWindow::close() {
  interactor_->TerminateApp();
}

std::pair<int, int> WalkWindow::size() const {
  const int* size = window_->GetSize();
  return {std::max(1, size[0]), std::max(1, size[1])};
}

void WalkWindow::drag(int right, int down) {
  const double per_pixel = drag_degrees * std::numbers::pi / 180.0 / size().first;
  if (pivot_) {
    walk_.orbit(*pivot_, 2.0 * right * per_pixel, -2.0 * down * per_pixel);
  } else {
    walk_.look(right * per_pixel, -down * per_pixel);
  }
  change(current_look());
}

void WalkWindow::wheel(int clicks) {
  walk_.dolly(clicks * wheel_share * view_->bounds().diagonal());
  change(current_look());
}

void WalkWindow::hover(int x, int y) {
  pointer_x_ = x;
  pointer_y_ = size().second - 1 - y;
  if (pointer_.is_probing()) update_pointer();
}

void WalkWindow::click(int x, int y) {
  pointer_.click(*view_, x + 0.5, size().second - 0.5 - y);
  update_pointer();
}

void WalkWindow::pointer_left() {
  pointer_x_ = -1;
  pointer_.leave();
  update_pointer();
}

void WalkWindow::tick(double seconds) {
  const bool walked = advance(std::min(seconds, longest_step));
  const auto [width, height] = size();
  const bool is_resized = width != drawn_width_ || height != drawn_height_;
  if (walked || is_resized) change(current_look());
  if (is_resized) {
    overlay_.set_help(help_ ? walk_help() : "", width, height);
    update_pointer();
  }
  watch();
  fade(seconds);
  advance_still();
  if (!message_.empty()) {
    message_seconds_ -= seconds;
    if (message_seconds_ <= 0.0) say("");
  }
  if (!changed_) return;
  changed_ = false;
  drawn_width_ = width;
  drawn_height_ = height;
  const VtkMessages messages;  // VTK warns of text that does not fit in a tiny window
  window_->Render();
}

Look WalkWindow::current_look() const {
  const auto [width, height] = size();
  Look look = view_->look();
  look.camera = fit_to_window(walk_.camera(), width, height);
  if (is_opened_ && is_inside(view_->bounds(), look.camera.position)) look.unlit = true;
  return look;
}

void WalkWindow::go_to(const Camera& camera) {
  walk_.place(camera);
  physics_.stand_still();
  pivot_.reset();
  playing_ = false;
  change(view_->metered(current_look(), camera));
}

void WalkWindow::go_to_start() {
  go_to(view_->start_camera());
}

void WalkWindow::show_all() {
  const auto [width, height] = size();
  walk_.place(
      frame_all(view_->bounds(), walk_.camera().direction, view_->up_axis(), width, height));
  Look look = current_look();
  // A closed room shows its black outside; without surfaces that get no light one sees into it.
  is_opened_ = is_opened_ || look.unlit;
  look.unlit = false;
  change(look);
}

void WalkWindow::expose(double stops) {
  Look look = current_look();
  look.exposure_ev += stops;
  change(look);
}

void WalkWindow::expose_for_view() {
  Look look = view_->metered(current_look(), walk_.camera());
  look.exposure_ev = options_.exposure_ev;
  change(look);
}

void WalkWindow::meter_unless_exposed() {
  const Look look = current_look();
  if (look.exposure_ev == options_.exposure_ev) change(view_->metered(look, look.camera));
}

void WalkWindow::switch_false_colours() {
  Look look = current_look();
  const bool is_shown = look.illuminance && look.measure == Measure::illuminance;
  look.illuminance = !is_shown && !look.interpolation_error;
  look.measure = Measure::illuminance;
  look.interpolation_error = false;
  change(look);
}

// The order is luminance, unshot light (only during the solving), picture.
void WalkWindow::switch_measure() {
  Look look = current_look();
  const bool is_solving = live_ && live_state_.phase < LivePhase::done;
  const bool is_shown = look.illuminance && !look.interpolation_error;
  if (is_shown && look.measure == Measure::luminance && is_solving) {
    look.measure = Measure::unshot;
  } else if (is_shown && look.measure != Measure::illuminance) {
    look.illuminance = false;
    look.measure = Measure::illuminance;
  } else {
    look.illuminance = true;
    look.measure = Measure::luminance;
  }
  look.interpolation_error = false;
  if (look.measure == Measure::unshot) leave_sketch();
  change(look);
}

// A temperature that the window began with takes the place of the automatic white.
void WalkWindow::switch_white() {
  using Kind = WhitePoint::Kind;
  Look look = view_->metered(current_look(), walk_.camera());
  const bool is_as_lit = look.white.kind == Kind::as_lit;
  const WhitePoint given =
      options_.white.kind == Kind::as_lit ? WhitePoint{.kind = Kind::automatic} : options_.white;
  look.white = is_as_lit ? given : WhitePoint{};
  change(look);
  say(white_text(look.white));
}

void WalkWindow::fit_range() {
  if (!view_->look().illuminance) return say("false colours are off; V or U shows them");
  still_.discard();
  view_->fit_range();
  say("scale fitted to this view");
}

void WalkWindow::switch_scaling() {
  Look look = current_look();
  if (!look.illuminance) return say("false colours are off; V or U shows them");
  const bool is_even = look.scaling != Scaling::classes && view_->measured_range().is_even();
  look.scaling = is_even ? Scaling::logarithmic : Scaling::linear;
  change(look);
  say(is_even ? "logarithmic scale" : "linear scale");
}

void WalkWindow::switch_classes() {
  Look look = current_look();
  const bool is_shown = view_->shows_classes();
  look.illuminance = true;
  look.measure = Measure::illuminance;
  look.interpolation_error = false;
  look.scaling = is_shown ? Scaling::given : Scaling::classes;
  change(look);
}

void WalkWindow::switch_mesh() {
  Look look = current_look();
  look.mesh = !look.mesh;
  change(look);
}

void WalkWindow::switch_unlit() {
  Look look = current_look();
  look.unlit = !look.unlit;
  is_opened_ = false;
  change(look);
}

void WalkWindow::switch_isolux() {
  Look look = current_look();
  look.isolux = !look.isolux;
  change(look);
}

void WalkWindow::switch_help() {
  help_ = !help_;
  const auto [width, height] = size();
  overlay_.set_help(help_ ? walk_help() : "", width, height);
  update_pointer();
}

void WalkWindow::switch_probe() {
  pointer_.switch_probe();
  update_pointer();
  say(pointer_.is_probing() ? "reading under the pointer" : "");
}

void WalkWindow::switch_measuring() {
  pointer_.switch_measuring();
  update_pointer();
}

void WalkWindow::forget_clicks() {
  pointer_.clear();
  update_pointer();
}

void WalkWindow::update_pointer() {
  const auto [width, height] = size();
  pointer_.leave();
  if (pointer_x_ >= 0) pointer_.hover(*view_, pointer_x_ + 0.5, pointer_y_ + 0.5);
  overlay_.set_cursor(pointer_.beside_pointer(*view_), pointer_x_, pointer_y_, width, height);
  overlay_.set_panel(help_ ? "" : pointer_.panel(*view_), width, height);
  marks_.set(pointer_.marks());
  changed_ = true;
}

void WalkWindow::change(const Look& look) {
  still_.discard();
  view_->set_look(look);
  if (pointer_.is_probing()) update_pointer();
  update_text();
  changed_ = true;
}

void WalkWindow::say(const std::string& message) {
  message_ = message;
  message_seconds_ = message_duration;
  update_text();
  changed_ = true;
}

void WalkWindow::update_text() {
  const Look& look = view_->look();
  const char* const measured = look.measure == Measure::illuminance ? "illuminance"
                               : look.measure == Measure::luminance ? "luminance"
                                                                    : "light still to come";
  status_ = look.illuminance ? measured : fmt::format("{:+.1f} EV", look.exposure_ev);
  if (view_->shows_classes()) status_ += " in classes of lighting standards";
  if (walking_) status_ += "   on foot";
  if (pivot_) status_ += "   orbiting";
  if (recording_) status_ += fmt::format("   recording {:.1f} s", path_seconds_);
  if (playing_) status_ += fmt::format("   playing {:.1f} s", path_seconds_);
  if (still_.phase() == StillPhase::rendering) {
    status_ += fmt::format("   ray-tracing {:.0f} %", 100.0 * still_.progress());
  }
  if (shows_sketch()) status_ += "   first look";
  if (preparing_) status_ += "   " + preparing_->status();
  if (live_) status_ += "   " + text_of(live_state_);
  if (cues_.has_cues()) status_ += "   " + cues_.text();
  if (lights_.has_channels()) status_ += "   " + lights_.text();
  if (!message_.empty()) status_ += "   " + message_;
  overlay_.set_status(status_, size().first);
}

void WalkWindow::replace_view(const SolvedScene& solved) {
  Look look = view_->look();
  if (look.measure == Measure::unshot) {
    look.illuminance = false;
    look.measure = Measure::illuminance;
  }
  window_->RemoveRenderer(view_->renderer());
  view_ = std::make_unique<SolutionView>(solved, options_);
  still_.add_to(view_->renderer());
  overlay_.add_to(view_->renderer());
  marks_.add_to(view_->renderer());
  window_->AddRenderer(view_->renderer());
  change(look);
}

void WalkWindow::save_screenshot() {
  if (save_still()) return;
  std::filesystem::path file;
  for (int i = 1; file.empty() || std::filesystem::exists(file); ++i) {
    file = options_.screenshot_folder / fmt::format("lightwell-{}.png", i);
  }
  const auto [width, height] = size();
  // A renderer belongs to one window, so the picture has a renderer of its own, without text.
  try {
    SolutionView picture(solved(), options_);
    picture.set_look(view_->look());
    write_png(file, width, height, draw_offscreen(picture, width, height));
    say("saved " + file.string());
  } catch (const std::exception& e) {
    say(e.what());
  }
}

}  // namespace lightwell
