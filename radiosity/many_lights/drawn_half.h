#pragma once

namespace lightwell {

/// One of two halves of a cluster, drawn by their weights.
struct DrawnHalf {
  int half = -1;  ///< 0 or 1; -1: both weights are 0
  double chance = 1.0;
  double u = 0.0;  ///< random number in [0,1) that is left for draws within the half
};

/// Draws a half for u in [0,1). Weights are not negative.
inline DrawnHalf draw_half(double first, double second, double u) {
  if (!(first + second > 0.0)) return {};
  const double share = first / (first + second);
  if (u < share) return {.half = 0, .chance = share, .u = u / share};
  return {.half = 1, .chance = 1.0 - share, .u = (u - share) / (1.0 - share)};
}

}  // namespace lightwell
