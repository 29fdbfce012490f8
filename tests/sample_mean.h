#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightwell::test {

/// Mean of samples and its standard error, as if the samples were independent.
struct SampleMean {
  double value = 0.0, standard_error = 0.0;
};

/// Precondition: at least two samples.
inline SampleMean mean_of(const std::vector<double>& samples) {
  double sum = 0.0, squares = 0.0;
  for (const double sample : samples) {
    sum += sample;
    squares += sample * sample;
  }
  const auto n = static_cast<double>(samples.size());
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0))};
}

}  // namespace lightwell::test
