#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/console.h"

namespace lightwell {

/// Adds --time TIME to a command, after --checkpoint and the options of solves, beside some of
/// which it is refused. `seconds` stays 0 if the option is not given.
void add_time_limit(CLI::App& command, double& seconds, const std::string& group);

/// The time that a command may take, from the construction on.
class TimeLimit {
 public:
  /// `seconds` 0: any time.
  explicit TimeLimit(double seconds) : seconds_(seconds) {}

  /// Seconds of the limit; 0: none.
  double seconds() const { return seconds_; }
  /// Command-line option that repeats the limit, after a space; "" without one.
  std::string text() const;
  /// Returns RunControl::seconds_left for work that has to end when a `share` of the time is over:
  /// 0 once SIGINT has asked for an early end, infinity without a limit. The function refers to
  /// this object.
  std::function<double()> seconds_left(double share = 1.0) const;

 private:
  double seconds_;
  Stopwatch watch_{};
};

}  // namespace lightwell
