#include "viewer/walk_window.h"

#include <fmt/format.h>
#include <vtkInteractorStyle.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include "radiosity/vtk_messages.h"
#include "raytrace/image.h"
#include "viewer/x_display.h"

namespace lightwell {
namespace {

constexpr unsigned long frame_milliseconds = 15;
/// A drawing that takes longer slows the walk instead of jumping.
constexpr double longest_step = 0.25;
constexpr double message_duration = 4.0;     ///< seconds
constexpr double drag_degrees = 120.0;       ///< a drag across the whole window
constexpr double wheel_share = 0.03;         ///< of the scene's diagonal per click
constexpr double exposure_step = 1.0 / 3.0;  ///< stops a key press, as on cameras

constexpr const char* help_lines =
    "W S  Up Down      walk\n"
    "A D  Left Right   step aside\n"
    "Q E               turn\n"
    "Space C           up, down\n"
    "Shift             run\n"
    "mouse drag        look around\n"
    "mouse wheel       move along the view\n"
    "1 ... 9           go to a camera\n"
    "R                 back to the start\n"
    "F                 see the whole scene\n"
    "+ -               exposure, 1/3 stop\n"
    "0                 expose for this view\n"
    "V                 illuminance in false colours\n"
    "M                 mesh\n"
    "X                 look through unlit surfaces\n"
    "P  F12            save a picture\n"
    "H  ?              this list\n"
    "Esc               close\n"
    "\n"
    "Mirrors are drawn as if matte, glass as a veil:\n"
    "what they show depends on the eye, and is left\n"
    "to the rendered picture.";

/// Hands what happens in the window on, and keeps VTK's own keys (w, s, e, q, p ...) from acting.
class WalkStyle : public vtkInteractorStyle {
 public:
  static WalkStyle* New() {
    auto* style = new WalkStyle;
    style->InitializeObjectBase();
    return style;
  }
  void set_window(WalkWindow* window) { walk_ = window; }

  void OnChar() override {}
  void OnKeyPress() override {
    if (const char* key = Interactor->GetKeySym()) walk_->press(key);
  }
  void OnKeyRelease() override {
    if (const char* key = Interactor->GetKeySym()) walk_->release(key);
  }
  // A key released while another window has the keyboard is never reported.
  void OnLeave() override { walk_->release_all(); }
  void OnLeftButtonDown() override { dragging_ = true; }
  void OnLeftButtonUp() override { dragging_ = false; }
  void OnMiddleButtonDown() override {}
  void OnMiddleButtonUp() override {}
  void OnRightButtonDown() override { dragging_ = true; }
  void OnRightButtonUp() override { dragging_ = false; }
  void OnMouseMove() override {
    const int* now = Interactor->GetEventPosition();
    const int* before = Interactor->GetLastEventPosition();
    if (dragging_) walk_->drag(now[0] - before[0], before[1] - now[1]);
  }
  void OnMouseWheelForward() override { walk_->wheel(1); }
  void OnMouseWheelBackward() override { walk_->wheel(-1); }
  void OnTimer() override {
    const auto now = std::chrono::steady_clock::now();
    walk_->tick(std::chrono::duration<double>(now - last_tick_).count());
    last_tick_ = now;
  }

 private:
  WalkWindow* walk_ = nullptr;
  bool dragging_ = false;
  std::chrono::steady_clock::time_point last_tick_ = std::chrono::steady_clock::now();
};

vtkSmartPointer<vtkTextActor> make_text(double x, double y, int size, bool framed) {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text->GetPositionCoordinate()->SetValue(x, y);
  vtkTextProperty* property = text->GetTextProperty();
  property->SetFontSize(size);
  property->SetColor(0.95, 0.95, 0.95);
  property->SetBackgroundColor(0.05, 0.05, 0.05);
  property->SetBackgroundOpacity(framed ? 0.8 : 0.45);
  return text;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

double walking_speed(double scene_diagonal) {
  constexpr double room = 7.0;  ///< m
  const double pace = 0.2 * std::min(scene_diagonal, room);
  return scene_diagonal > room ? pace * std::sqrt(scene_diagonal / room) : pace;
}

const char* walk_help() {
  return help_lines;
}

WalkWindow::WalkWindow(const SolvedScene& solved, const ViewOptions& options)
    : solved_(solved),
      options_(options),
      view_(solved_, options_),
      walk_(view_.start_camera(), view_.up_axis(), walking_speed(view_.bounds().diagonal())),
      status_text_(make_text(0.01, 0.015, 13, false)),
      help_text_(make_text(0.03, 0.97, 14, true)),
      window_(vtkSmartPointer<vtkRenderWindow>::New()),
      interactor_(vtkSmartPointer<vtkRenderWindowInteractor>::New()) {
  help_text_->SetInput(help_lines);
  help_text_->GetTextProperty()->SetFontFamilyToCourier();
  help_text_->GetTextProperty()->SetVerticalJustificationToTop();
  help_text_->VisibilityOff();
  view_.renderer()->AddViewProp(status_text_);
  view_.renderer()->AddViewProp(help_text_);
  say("H shows the keys");

  const std::string scene =
      std::filesystem::path(solved_.solution.provenance.scene_file).filename().string();
  window_->SetWindowName(scene.empty() ? "Lightwell" : ("Lightwell - " + scene).c_str());
  window_->SetSize(std::max(1, options_.width), std::max(1, options_.height));
  window_->SetMultiSamples(4);
  window_->AddRenderer(view_.renderer());
  interactor_->SetRenderWindow(window_);
  vtkNew<WalkStyle> style;
  style->set_window(this);
  interactor_->SetInteractorStyle(style);
  change(current_look());
}

// The style points at this object.
WalkWindow::~WalkWindow() {
  interactor_->SetInteractorStyle(nullptr);
}

vtkRenderWindowInteractor* WalkWindow::interactor() const {
  return interactor_;
}

void WalkWindow::run() {
  const VtkMessages messages;
  window_->Render();
  // A processor that plays graphics card has no power to spare for four samples a pixel.
  const std::string driver = window_->ReportCapabilities();
  for (const char* software : {"llvmpipe", "softpipe", "SWR", "SwiftShader"}) {
    if (driver.find(software) != std::string::npos) window_->SetMultiSamples(0);
  }
  interactor_->Initialize();
  report_held_keys_once(window_->GetGenericDisplayId());
  interactor_->CreateRepeatingTimer(frame_milliseconds);
  interactor_->Start();
}

WalkKeys WalkWindow::held_keys() const {
  const auto any = [&](std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return held_.count(key); });
  };
  return {.forward = any({"w", "up", "kp_up"}),
          .back = any({"s", "down", "kp_down"}),
          .left = any({"a", "left", "kp_left"}),
          .right = any({"d", "right", "kp_right"}),
          .up = any({"space", "prior"}),
          .down = any({"c", "next"}),
          .turn_left = any({"q"}),
          .turn_right = any({"e"}),
          .run = any({"shift_l", "shift_r"})};
}

void WalkWindow::press(const std::string& key_symbol) {
  const std::string key = lower_case(key_symbol);
  // A key held down reports again and again; switches act once.
  if (!held_.insert(key).second) return;
  Look look = current_look();
  if (key == "escape") {
    interactor_->TerminateApp();
  } else if (key.size() == 1 && key[0] >= '1' && key[0] <= '9') {
    const auto index = static_cast<std::size_t>(key[0] - '1');
    if (index < options_.cameras.size()) {
      go_to(options_.cameras[index]);
      say(options_.cameras[index].name);
    } else {
      say(fmt::format("the scene has {} cameras", options_.cameras.size()));
    }
  } else if (key == "r") {
    go_to(view_.start_camera());
  } else if (key == "f") {
    const int* size = window_->GetSize();
    walk_.place(frame_all(view_.bounds(), walk_.camera().direction, view_.up_axis(),
                          std::max(1, size[0]), std::max(1, size[1])));
    change(current_look());
  } else if (key == "plus" || key == "equal" || key == "kp_add") {
    look.exposure_ev += exposure_step;
    change(look);
  } else if (key == "minus" || key == "kp_subtract") {
    look.exposure_ev -= exposure_step;
    change(look);
  } else if (key == "0") {
    look.metered_scale = view_.meter(walk_.camera());
    look.exposure_ev = options_.exposure_ev;
    change(look);
  } else if (key == "v") {
    look.illuminance = !look.illuminance && !look.interpolation_error;
    look.interpolation_error = false;
    change(look);
  } else if (key == "m") {
    look.mesh = !look.mesh;
    change(look);
  } else if (key == "x") {
    look.unlit = !look.unlit;
    change(look);
  } else if (key == "p" || key == "f12") {
    save_screenshot();
  } else if (key == "h" || key == "question") {
    help_ = !help_;
    help_text_->SetVisibility(help_);
    changed_ = true;
  }
}

void WalkWindow::release(const std::string& key_symbol) {
  const std::string key = lower_case(key_symbol);
  held_.erase(key);
  // With Shift let go first, the key reports its other symbol.
  if (key == "plus") held_.erase("equal");
  if (key == "equal") held_.erase("plus");
  if (key == "slash") held_.erase("question");
}

void WalkWindow::drag(int right, int down) {
  const double per_pixel =
      drag_degrees * std::numbers::pi / 180.0 / std::max(1, window_->GetSize()[0]);
  walk_.look(right * per_pixel, -down * per_pixel);
  change(current_look());
}

void WalkWindow::wheel(int clicks) {
  walk_.dolly(clicks * wheel_share * view_.bounds().diagonal());
  change(current_look());
}

void WalkWindow::tick(double seconds) {
  const bool walked = walk_.advance(held_keys(), std::min(seconds, longest_step));
  const int* size = window_->GetSize();
  if (walked || size[0] != drawn_width_ || size[1] != drawn_height_) change(current_look());
  if (!message_.empty()) {
    message_seconds_ -= seconds;
    if (message_seconds_ <= 0.0) say("");
  }
  if (!changed_) return;
  changed_ = false;
  drawn_width_ = size[0];
  drawn_height_ = size[1];
  const VtkMessages messages;  // text that finds no room in a tiny window complains
  window_->Render();
}

Look WalkWindow::current_look() const {
  const int* size = window_->GetSize();
  Look look = view_.look();
  look.camera = fit_to_window(walk_.camera(), std::max(1, size[0]), std::max(1, size[1]));
  return look;
}

void WalkWindow::go_to(const Camera& camera) {
  walk_.place(camera);
  Look look = current_look();
  look.metered_scale = view_.meter(camera);
  change(look);
}

void WalkWindow::change(const Look& look) {
  view_.set_look(look);
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
  const Look& look = view_.look();
  std::string text = look.illuminance ? "illuminance" : fmt::format("{:+.1f} EV", look.exposure_ev);
  if (!message_.empty()) text += "   " + message_;
  status_text_->SetInput((" " + text + " ").c_str());
}

void WalkWindow::save_screenshot() {
  std::filesystem::path file;
  for (int i = 1; file.empty() || std::filesystem::exists(file); ++i) {
    file = options_.screenshot_folder / fmt::format("lightwell-{}.png", i);
  }
  const int* size = window_->GetSize();
  const int width = std::max(1, size[0]), height = std::max(1, size[1]);
  // A renderer belongs to one window; the picture gets one of its own, without the text.
  try {
    SolutionView picture(solved_, options_);
    picture.set_look(view_.look());
    write_png(file, width, height, draw_offscreen(picture, width, height));
    say("saved " + file.string());
  } catch (const std::exception& e) {
    say(e.what());
  }
}

}  // namespace lightwell
