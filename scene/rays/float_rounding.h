#pragma once

#include <limits>

namespace lightwell {

/// Rounding of a coordinate, metres, that is converted to float about the middle of a box with the
/// given diagonal, metres. (It is at most half as large; twice that is left for the sum of two.)
inline double float_rounding(double diagonal) {
  return 0.5 * diagonal * double{std::numeric_limits<float>::epsilon()};
}

}  // namespace lightwell
