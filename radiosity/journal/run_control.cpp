#include "radiosity/journal/run_control.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "radiosity/processes/processes.h"

namespace lightwell {

double RunControl::time_left() const {
  return seconds_left ? seconds_left() : std::numeric_limits<double>::infinity();
}

bool RunControl::is_time_up() const {
  return !(time_left() > 0.0);
}

bool RunControl::has_limit() const {
  return std::isfinite(time_left());
}

RunControl RunControl::with_share(double share) const {
  RunControl result = *this;
  if (!seconds_left) return result;
  const double allowed = share * time_left();
  const auto start = std::chrono::steady_clock::now();
  result.seconds_left = [left = seconds_left, allowed, start] {
    const double spent =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::min(left(), allowed - spent);
  };
  return result;
}

std::int64_t RunControl::least(std::int64_t value) const {
  return processes ? processes->least(value) : value;
}

RunControl RunControl::stopping_in_time() const {
  RunControl result = *this;
  if (!seconds_left) return result;
  result.progress = [run = *this](std::string_view phase, double share) {
    const bool goes_on = !run.progress || run.progress(phase, share);
    return goes_on && !run.is_time_up();
  };
  return result;
}

}  // namespace lightwell
