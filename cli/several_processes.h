#pragma once

#include <optional>

#include "cli/checkpoint.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/report.h"
#include "cli/time_limit.h"

namespace lightwell {

// Steps of commands that share their work among several processes. In a single process none of them
// has an effect.

/// Checks that all processes have the same scene and options. Collective. Throws InputError that
/// names the processes that differ, and for a limited time, by which processes would decide
/// differently.
void agree_on(const Provenance& of, const TimeLimit& time, const Console& console);

/// The arguments in the first process; none in the others, whose work the first keeps.
CheckpointArguments of_first(const CheckpointArguments& arguments, const Console& console);

/// The answer of the first process, in all processes. Collective.
bool answer_of_first(bool mine, const Console& console);

/// Adds the work and the bytes of each process to the report of the first, and notes processes
/// without work on the console. Collective.
void add_traffic(int patches, const Feedback& feedback);

/// An InterruptEndsEarly, except with several processes: an early end is a decision by time.
class EarlyEnd {
 public:
  explicit EarlyEnd(const Console& console) {
    if (!console.processes()) on_interrupt_.emplace();
  }

 private:
  std::optional<InterruptEndsEarly> on_interrupt_{};
};

}  // namespace lightwell
