#pragma once

#include <vtkSmartPointer.h>

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "viewer/solution_view.h"
#include "viewer/walk_state.h"

class vtkRenderWindow;
class vtkRenderWindowInteractor;
class vtkTextActor;

namespace lightwell {

/// Metres a second for a scene of this diagonal: a fifth of it up to 7 m, a person's 1.4 m/s there,
/// and growing with the root above, so that a hall is neither tedious nor a blur.
double walking_speed(double scene_diagonal);

/// The list of keys that the window shows.
const char* walk_help();

/// The window's behaviour: keys and mouse in, a SolutionView's look out.
class WalkWindow {
 public:
  WalkWindow(const SolvedScene& solved, const ViewOptions& options);
  ~WalkWindow();
  WalkWindow(const WalkWindow&) = delete;
  WalkWindow& operator=(const WalkWindow&) = delete;

  /// Opens the window and returns when it is closed.
  void run();

  // What the interactor style reports. `key` is an X key symbol, such as "w", "Left" or "F12".
  void press(const std::string& key);
  void release(const std::string& key);
  void release_all() { held_.clear(); }
  /// The mouse moved with its button held, pixels, y downwards.
  void drag(int right, int down);
  void wheel(int clicks);
  /// `seconds` went by: moves on, and draws if anything changed.
  void tick(double seconds);

  const Look& look() const { return view_.look(); }
  const std::string& message() const { return message_; }
  vtkRenderWindowInteractor* interactor() const;

 private:
  WalkKeys held_keys() const;
  /// The look from where the walk is now, in the window as large as it is now.
  Look current_look() const;
  void go_to(const Camera& camera);
  void save_screenshot();
  void say(const std::string& message);
  void change(const Look& look);
  void update_text();

  const SolvedScene& solved_;
  ViewOptions options_;
  SolutionView view_;
  WalkState walk_;
  std::set<std::string> held_;
  std::string message_;
  double message_seconds_ = 0.0;
  int drawn_width_ = 0, drawn_height_ = 0;
  bool help_ = false;
  bool changed_ = true;
  vtkSmartPointer<vtkTextActor> status_text_, help_text_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
};

}  // namespace lightwell
