#pragma once

#include <cmath>

namespace lightwell {

/// The smallest of 1, 2 and 5 times the powers of ten that is at least `least` > 0, to 1e-9: the
/// steps of scales that people read.
inline double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= least * (1.0 - 1e-9)) return step * power;
  }
  return 10.0 * power;
}

}  // namespace lightwell
