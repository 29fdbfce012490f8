#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace lightwell {

/// Length of the interval from 0 to `length` that none of the `parts` (from, to) covers.
inline double uncovered_length(double length, std::vector<std::pair<double, double>> parts) {
  std::sort(parts.begin(), parts.end());
  double reached = 0.0, missing = 0.0;
  for (const auto& [from, to] : parts) {
    if (from > reached) missing += std::min(from, length) - reached;
    reached = std::max(reached, std::min(to, length));
  }
  return missing + std::max(0.0, length - reached);
}

}  // namespace lightwell
