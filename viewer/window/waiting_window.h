#pragma once

#include <vtkSmartPointer.h>

#include <functional>
#include <optional>
#include <string>

#include "viewer/window/overlay.h"

class vtkRenderer;
class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace lightwell {

/// A window of the screen, before or while it shows a scene.
struct OpenWindow {
  vtkSmartPointer<vtkRenderWindow> window;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor;
};

/// An empty window with a status line.
class WaitingWindow {
 public:
  WaitingWindow(const std::string& title, int width, int height, double text_scale);
  ~WaitingWindow();
  WaitingWindow(const WaitingWindow&) = delete;
  WaitingWindow& operator=(const WaitingWindow&) = delete;

  /// Shows the window with the text that `status` returns, until it returns nothing (true) or the
  /// user closes the window or presses Escape (false), which hides the window at once.
  bool run(const std::function<std::optional<std::string>()>& status);
  /// The window, for what is shown next.
  const OpenWindow& opened() const { return opened_; }

 private:
  OpenWindow opened_;
  vtkSmartPointer<vtkRenderer> renderer_;
  Overlay overlay_;
};

}  // namespace lightwell
