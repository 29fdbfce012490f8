#pragma once

namespace lightwell {

/// The standard error that suffices at a point, mean of the bands: the larger of the two. Both 0:
/// no goal is set.
struct NoiseGoal {
  double irradiance = 0.0;  ///< W/m^2
  double share = 0.0;       ///< of the irradiance at the point
  /// Most rays for the goal, in multiples of those that are cast where no goal is set. Points that
  /// see the sky through a crack would take any number.
  int most_times = 16;

  bool is_set() const { return irradiance > 0.0 || share > 0.0; }
};

}  // namespace lightwell
