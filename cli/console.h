#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// The switches that every sub-command has.
struct CommonOptions {
  bool quiet = false;    ///< no progress, no notes, no report; errors and asked-for values only
  bool json = false;     ///< standard output is one JSON object
  bool verbose = false;  ///< also say which options are in force
  int threads = 0;       ///< 0: one per core
  std::vector<std::string> command_line{};  ///< all words as they were typed
};

/// Seconds since it was made, or since the last lap.
class Stopwatch {
 public:
  double seconds() const;
  double lap();

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Talk: progress and messages, on standard error. A terminal gets one line that redraws itself
/// (phase, percent, time left), anything else one line per finished phase.
class Console {
 public:
  explicit Console(const CommonOptions& options);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  const CommonOptions& options() const { return options_; }
  /// Shows what it is called with, and says stop once an interrupt has arrived. Valid while the
  /// console lives.
  Progress progress();
  /// Ends the progress line, if one is being drawn.
  void finish_phase();
  /// A line for people; silent with --quiet.
  void say(std::string_view line);
  /// What the reader assumed, repaired or dropped.
  void say_notes(const Scene& scene);
  /// With --verbose only.
  void say_verbose(std::string_view line);

 private:
  void show(std::string_view phase, double share);

  CommonOptions options_;
  bool on_terminal_ = false;
  std::string phase_{};
  Stopwatch phase_time_{};
  double last_drawn_ = 0.0;  // seconds into the phase
  struct Start {
    double share = 0.0, seconds = 0.0;
  };
  Start start_{};  // from where on work is done at its own pace
};

}  // namespace lightwell
