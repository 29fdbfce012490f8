#pragma once

#include <vtkSmartPointer.h>

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "viewer/window/camera_path.h"
#include "viewer/window/cue_player.h"
#include "viewer/window/light_board.h"
#include "viewer/window/live_solve.h"
#include "viewer/window/marks.h"
#include "viewer/window/overlay.h"
#include "viewer/window/pointer_tools.h"
#include "viewer/window/preparation.h"
#include "viewer/window/preview.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/still.h"
#include "viewer/window/waiting_window.h"
#include "viewer/window/walk_body.h"
#include "viewer/window/walk_state.h"

class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace lightwell {

/// Returns the walking speed, m/s, for a scene of diagonal d, m: 0.2 d up to 7 m, and
/// 1.4 sqrt(d / 7 m) above. 1.4 m/s is a person's speed; the root makes a hall neither tedious nor
/// a blur.
double walking_speed(double scene_diagonal);

/// The title of a window that shows a scene file; empty: of no name.
std::string window_title(const std::string& scene);

/// Returns the list of keys that the window shows, in two columns.
std::string walk_help();

/// Behaviour of the window: keys and mouse change the look of a SolutionView.
class WalkWindow {
 public:
  WalkWindow(const SolvedScene& solved, const ViewOptions& options);
  /// Shows light during progressive refinement, then the solution. `begun` is live.dark(), possibly
  /// with dimmed channels. The caller calls live.start(). Keeps a reference to `live`.
  /// `opened` is a window that is on the screen already; null: a new one.
  WalkWindow(LiveSolve& live, SolvedScene begun, const ViewOptions& options,
             const OpenWindow* opened = nullptr);
  /// Shows a sketch until `preparation` is done and the light of shots, which this object then
  /// starts, surpasses the sketch. Keeps a reference to `preparation`.
  WalkWindow(SolvedScene sketched, Preparation& preparation, const ViewOptions& options,
             const OpenWindow* opened = nullptr);
  ~WalkWindow();
  WalkWindow(const WalkWindow&) = delete;
  WalkWindow& operator=(const WalkWindow&) = delete;

  /// Shows the sketch of `preview` once there is one, until the light of shots surpasses it. Keeps
  /// a reference to `preview`.
  void expect(Preview& preview);

  /// Opens the window and returns when the user closes the window. Throws what Preparation::take()
  /// throws.
  void run();

  // Events from the interactor style. `key` is an X key symbol, such as "w", "Left" or "F12".
  void press(const std::string& key);
  void release(const std::string& key);
  void release_all() { held_.clear(); }
  /// The mouse moved with a button held; pixels to the right and down.
  void drag(int right, int down);
  void wheel(int clicks);
  /// The pointer is at pixel (x, y), or was clicked there without a drag; y upwards, as in VTK.
  void hover(int x, int y);
  void click(int x, int y);
  void pointer_left();
  /// Advances walk, solving and ray-traced picture by `seconds`, and draws after a change.
  void tick(double seconds);

  const Look& look() const { return view_->look(); }
  const std::string& message() const { return message_; }
  const std::string& status() const { return status_; }
  const PointerTools& pointer() const { return pointer_; }
  bool is_walking() const { return walking_; }
  const Still& still() const { return still_; }
  /// The solution that is shown.
  const SolvedScene& solved() const { return view_->solved(); }
  /// True while a sketch is shown in place of the light of shots.
  bool shows_sketch() const { return preparing_ || solving_; }
  vtkRenderWindowInteractor* interactor() const;

 private:
  /// A line of help, and the keys that have the same effect.
  struct Key {
    const char* shown;
    const char* does;
    std::vector<std::string> symbols{};  ///< in lower case; empty: not handled by `act`
    void (WalkWindow::*act)() = nullptr;
  };
  static std::span<const Key> keys();
  friend std::string walk_help();

  WalkWindow(const SolvedScene* shown, std::unique_ptr<SolvedScene> own, LiveSolve* live,
             const ViewOptions& options, const OpenWindow* opened = nullptr);
  WalkKeys held_keys() const;
  void press_digit(int digit);
  void keep_bookmark(int digit);
  /// Returns the look with the walk's current camera, fitted to the window's current size.
  Look current_look() const;
  void go_to(const Camera& camera);
  void go_to_start();
  void show_all();
  void expose(double stops);
  void brighter() { light_up(1); }
  void darker() { light_up(-1); }
  void expose_for_view();
  /// Meters again while light arrives, as long as the user has not changed the exposure.
  void meter_unless_exposed();
  void switch_false_colours();
  void switch_measure();
  void switch_white();
  void fit_range();
  void switch_scaling();
  void switch_classes();
  void switch_mesh();
  void switch_unlit();
  void switch_isolux();
  void switch_help();
  void switch_probe();
  void switch_measuring();
  void forget_clicks();
  void close();
  void save_screenshot();
  void say(const std::string& message);
  void change(const Look& look);
  void update_text();
  void update_pointer();
  std::pair<int, int> size() const;

  // Ways to move.
  bool advance(double seconds);
  bool walk_on_foot(const Eigen::Vector3d& before, double seconds);
  void switch_walking();
  void jump();
  void switch_orbit();
  void switch_recording();
  void switch_playing();
  void record(double seconds);
  bool play(double seconds);
  void keep_views();

  // The second pass.
  void switch_still();
  void advance_still();
  bool save_still();

  // Light channels.
  void next_channel() { choose_channel(1); }
  void previous_channel() { choose_channel(-1); }
  void choose_channel(int step);
  void switch_channel();
  void next_colour();
  /// Changes the chosen channel, or without a chosen channel the exposure, by thirds of a stop.
  void light_up(int steps);
  /// Shows the light as the keys have set it, which ends a fade.
  void relight_now();
  void relight_to(const std::vector<Spectrum>& scales);
  void save_solution();

  // Lighting cues.
  void next_cue();
  void previous_cue();
  void switch_cues();
  void fade(double seconds);

  // Progressive refinement.
  static std::unique_ptr<SolvedScene> begin(const LiveSolve& live, SolvedScene dark);
  void watch();
  void begin_solving(PreparedSolve prepared);
  void receive(LiveLight light);
  void show_sketch(SolvedScene sketched);
  void leave_sketch();
  std::unique_ptr<SolvedScene> show_instead(std::unique_ptr<SolvedScene> light);
  bool is_shooting() const;
  std::string nothing_to_solve() const;
  void show_arriving_light();
  void show_solution(SolvedScene solved);
  void switch_pause();
  void shoot_once();
  void switch_ambient();
  void stop_shooting();
  /// Shows another solution, which may have another mesh.
  void replace_view(const SolvedScene& solved);

  ViewOptions options_;
  bool is_opened_ = false;  // surfaces without light are left out as long as one is outside
  std::unique_ptr<SolvedScene> own_;  ///< copy whose light changes; null: the caller's is shown
  LiveSolve* live_;
  Preparation* preparing_ = nullptr;        ///< of the solve, while a sketch is shown
  Preview* preview_ = nullptr;              ///< a sketch that is to be shown
  std::unique_ptr<LiveSolve> prepared_{};   ///< the solve, if `preparing_` made it
  std::unique_ptr<SolvedScene> solving_{};  ///< light of shots while a sketch is shown instead
  std::exception_ptr failure_{};            ///< of the preparation
  std::unique_ptr<SolutionView> view_;
  WalkState walk_;
  WalkPhysics physics_;
  bool walking_ = false, recording_ = false, playing_ = false;
  std::optional<Eigen::Vector3d> pivot_{};  ///< centre of the orbit; empty: no orbit
  KeptViews views_{};
  CameraPath recorded_{};
  double path_seconds_ = 0.0;
  LightBoard lights_;
  CuePlayer cues_;
  PointerTools pointer_;
  LiveLight arrived_{};
  LiveState live_state_{};
  bool ambient_ = true, save_when_solved_ = false;
  std::set<std::string> held_;
  std::string message_, status_;
  double message_seconds_ = 0.0;
  int drawn_width_ = 0, drawn_height_ = 0;
  int pointer_x_ = -1, pointer_y_ = -1;  ///< from the left and from the top; -1: outside
  bool help_ = false;
  bool changed_ = true;
  Overlay overlay_;
  Marks marks_;
  Still still_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
};

}  // namespace lightwell
