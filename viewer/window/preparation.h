#pragma once

#include <memory>
#include <string>

#include "viewer/window/live_solve.h"
#include "viewer/window/view.h"

namespace lightwell {

/// Needs of a window before the first light: a scene cut into patches, its lamps and its
/// daylight.
struct PreparedSolve {
  std::unique_ptr<LiveSolve> solve{};
  SolvedScene dark{};  ///< LiveSolve::dark(), with the channels' scales of the options
};

/// Makes a LiveSolve in a thread, so that a window can say meanwhile what is done. Reports go to
/// the Preparation, not to the progress of the options; after cancel() they say stop, also those of
/// the LiveSolve. Keeps a reference to the scene.
class Preparation {
 public:
  /// `watch`, for tests, is called in the thread with each progress report; its result is ignored.
  Preparation(const Scene& scene, const LiveViewOptions& live, const Progress& watch = {});
  /// Cancels what take() has not taken, and waits for the thread.
  ~Preparation();
  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Asks the thread to end at its next report.
  void cancel();
  bool is_done() const;
  /// The present step in plain words, such as "cutting surfaces into patches 40 %".
  std::string status() const;
  /// Waits for the thread. Throws what stopped it: Interrupted after cancel(), InputError where
  /// nothing emits light.
  PreparedSolve take();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace lightwell
