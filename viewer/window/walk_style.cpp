#include "viewer/window/walk_style.h"

#include <vtkRenderWindowInteractor.h>

#include <chrono>
#include <cstdlib>

#include "viewer/window/walk_window.h"

namespace lightwell {
namespace {

/// Largest movement of a click, pixels: a hand trembles.
constexpr int click_reach = 3;

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
  // The release of a key is not reported while another window has the keyboard.
  void OnLeave() override {
    walk_->release_all();
    walk_->pointer_left();
  }
  void OnLeftButtonDown() override { begin_drag(); }
  void OnLeftButtonUp() override {
    const bool was_click = dragging_ && !has_moved_;
    dragging_ = false;
    if (was_click) walk_->click(start_[0], start_[1]);
  }
  void OnMiddleButtonDown() override {}
  void OnMiddleButtonUp() override {}
  void OnRightButtonDown() override { begin_drag(); }
  void OnRightButtonUp() override { dragging_ = false; }
  void OnMouseMove() override {
    const int* now = Interactor->GetEventPosition();
    const int* before = Interactor->GetLastEventPosition();
    if (!dragging_) return walk_->hover(now[0], now[1]);
    has_moved_ |=
        std::abs(now[0] - start_[0]) > click_reach || std::abs(now[1] - start_[1]) > click_reach;
    walk_->drag(now[0] - before[0], before[1] - now[1]);
  }
  void OnMouseWheelForward() override { walk_->wheel(1); }
  void OnMouseWheelBackward() override { walk_->wheel(-1); }
  void OnTimer() override {
    const auto now = std::chrono::steady_clock::now();
    walk_->tick(std::chrono::duration<double>(now - last_tick_).count());
    last_tick_ = now;
  }

 private:
  void begin_drag() {
    const int* now = Interactor->GetEventPosition();
    start_[0] = now[0];
    start_[1] = now[1];
    dragging_ = true;
    has_moved_ = false;
  }

  WalkWindow* walk_ = nullptr;
  bool dragging_ = false, has_moved_ = false;
  int start_[2] = {0, 0};
  std::chrono::steady_clock::time_point last_tick_ = std::chrono::steady_clock::now();
};

}  // namespace

vtkSmartPointer<vtkInteractorStyle> make_walk_style(WalkWindow* window) {
  const auto style = vtkSmartPointer<WalkStyle>::New();
  style->set_window(window);
  return style;
}

}  // namespace lightwell
