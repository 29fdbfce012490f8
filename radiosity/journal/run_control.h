#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "scene/errors.h"
#include "scene/progress.h"

namespace lightwell {

class Journal;
class Processes;

/// Progress, interruption, journal, processes and time of a run. Only the time affects the result.
struct RunControl {
  Progress progress{};
  /// Journal of the same scene, which keeps finished work and recalls it in a resumed run. Null:
  /// nothing is kept.
  Journal* journal = nullptr;
  /// Processes that share the work of phases, each of which runs the same program. A journal is the
  /// first process's, and the time is not limited. Null: this process does all work.
  Processes* processes = nullptr;
  /// Seconds of wall time that are left, asked for again and again; empty: any time. Infinity means
  /// that there is no limit yet. When no time is left, solve_scene() ends with the best result that
  /// it has; other functions pay no attention.
  std::function<double()> seconds_left{};

  /// Seconds left; infinity without a limit.
  double time_left() const;
  bool is_time_up() const;
  /// True if the time is limited from now on.
  bool has_limit() const;
  /// This run with a `share` of the time that is left now.
  RunControl with_share(double share) const;
  /// The least value of all processes, for a decision that must be the same in all: to be called by
  /// all in the same order. The value itself without others.
  std::int64_t least(std::int64_t value) const;
  /// This run with a progress that says stop once the time is up.
  RunControl stopping_in_time() const;
};

/// Calls `work(run)` with a run that stops once the time is up. Returns false if the work was
/// stopped for that reason; what the work has changed until then is as the work leaves it. Throws
/// Interrupted if progress says stop.
template <class Work>
bool finishes_in_time(const RunControl& run, Work&& work) {
  try {
    std::forward<Work>(work)(run.stopping_in_time());
  } catch (const Interrupted&) {
    if (!run.is_time_up()) throw;
    return false;
  }
  return true;
}

}  // namespace lightwell
