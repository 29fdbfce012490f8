#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/processes/processes.h"
#include "scene/progress.h"
#include "scene/scene.h"
#include "scene/stopwatch.h"

namespace lightwell {

/// The switches that every sub-command has.
struct CommonOptions {
  bool quiet = false;          ///< no progress, notes or report; errors and requested values only
  bool json = false;           ///< standard output is one JSON object
  bool verbose = false;        ///< print the effective options
  bool strict = false;         ///< what a reader leaves out, approximates or misses is an error
  bool inside_folder = false;  ///< scenes may name files in their own folder only
  int threads = 0;             ///< 0: one per core
  std::vector<std::string> command_line{};  ///< argv
};

/// Lines of text for a terminal: plain_text() of each, since names and files may hold what
/// terminals obey.
std::string plain_lines(std::string_view text);

/// Silences standard output and print_error(): for all processes of a run but the first.
void be_silent();

/// Prints to standard error. A failure, such as a full disk behind a log file, is left out: no
/// place remains that would report the failure.
void print_error(std::string_view text);

/// Progress and messages on standard error. A terminal shows one line that is redrawn (phase,
/// percent, time left); a file or pipe gets one line per finished phase.
class Console {
 public:
  explicit Console(const CommonOptions& options);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  const CommonOptions& options() const { return options_; }
  /// Processes of this run; null if there is only this one.
  Processes* processes() const { return processes_; }
  void set_processes(Processes* processes) { processes_ = processes; }
  /// True in the process that writes files: the only one, or the first.
  bool is_first() const { return !processes_ || processes_->is_first(); }
  /// A callback that shows the phase and share, and returns false once interrupt_requested(). Where
  /// the first of several processes ends the run, the callback throws in the others.
  /// The callback is valid during the console's life.
  Progress progress();
  /// Shows that work without progress of its own has begun. On a file or pipe there is a line only
  /// if the work takes more than a second.
  void begin(std::string_view phase);
  /// Shows beside the progress how much of a limited time is left; see RunControl::seconds_left.
  void show_time_left(std::function<double()> seconds_left) {
    time_left_ = std::move(seconds_left);
  }
  /// Ends the progress line, if one is being drawn.
  void finish_phase();
  /// Prints a line, unless --quiet was given.
  void say(std::string_view line);
  /// Prints the reader's notes: assumptions, repairs and dropped parts of the scene file.
  void say_notes(const Scene& scene);
  /// Prints a line if --verbose was given.
  void say_verbose(std::string_view line);

 private:
  void show(std::string_view phase, double share);

  CommonOptions options_;
  Processes* processes_ = nullptr;
  bool on_terminal_ = false;
  void draw(const std::string& line);

  std::function<double()> time_left_{};
  std::string phase_{};
  bool is_without_progress_ = false;
  Stopwatch phase_time_{};
  bool has_said_early_end_ = false;
  double last_drawn_ = 0.0;  // seconds into the phase
  struct Start {
    double share = 0.0, seconds = 0.0;
  };
  Start start_{};  // of the time-left estimate; work recalled from a checkpoint lies before
};

}  // namespace lightwell
