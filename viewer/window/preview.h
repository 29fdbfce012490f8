#pragma once

#include <atomic>
#include <optional>
#include <thread>

#include "radiosity/solution/solution.h"
#include "scene/progress.h"
#include "scene/scene.h"
#include "viewer/window/live_solve.h"

namespace lightwell {

/// A first look at a scene, sketch_scene(), made in a thread of its own while the scene is made
/// ready to be solved and patches shoot. Keeps a reference to the scene.
class Preview {
 public:
  /// `provenance` is that of the sketch. `watch`, for tests, is called in the thread with each
  /// progress report; its result is ignored.
  Preview(const Scene& scene, const Provenance& provenance, const Progress& watch = {});
  /// Cancels the work, and waits until the thread's next report.
  ~Preview();
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  /// Asks the thread to end at its next report. There is no sketch then.
  void cancel() { cancelled_ = true; }
  /// True once there is a sketch to take(). Never true if the sketch failed: the solve of the same
  /// scene fails too, and says why.
  bool is_ready() const { return ready_ && !cancelled_; }
  /// Returns the sketch in the first call after it is ready; else nothing.
  std::optional<SolvedScene> take();

 private:
  std::atomic<bool> cancelled_{false}, ready_{false};
  SolvedScene made_{};  // written by the thread before ready_
  std::thread thread_;  // last, since the thread uses the other members
};

/// True once the light of shots, ambient term included, is nearer to the solution than a sketch is.
/// Never true in a scene with mirrors or glass: the sketch has the light that these pass on, and
/// shots lack it to the end.
bool surpasses_sketch(const LiveState& state);

}  // namespace lightwell
