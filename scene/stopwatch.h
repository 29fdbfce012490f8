#pragma once

#include <chrono>

namespace lightwell {

/// A clock that starts with its construction: wall time.
class Stopwatch {
 public:
  /// Seconds since the start.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Seconds since the start, and starts again.
  double lap() {
    const double since = seconds();
    start_ = std::chrono::steady_clock::now();
    return since;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace lightwell
