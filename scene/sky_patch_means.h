#pragma once

#include <Eigen/Core>

#include "scene/sky.h"
#include "scene/sky_patches.h"

namespace lightwell {

/// Means over the patches of the dome of the radiance of many skies.
///
/// Points of each patch stand 5 degrees apart at most, by the midpoint rule. About the sun,
/// radiance falls by e within some 1/3 radian (Perez et al. 1993, d = -3), so that the rule is off
/// by (3 h)^2 / 24 = 0.3 % there.
class SkyPatchMeans {
 public:
  explicit SkyPatchMeans(const SkyPatches& patches);

  /// Mean radiance of a sky over each patch of the dome, first band, W/(m^2 sr).
  Eigen::ArrayXd of(const Sky& sky) const;
  /// Irradiance that each patch of radiance 1 gives open level ground, sr.
  const Eigen::ArrayXd& on_ground() const { return on_ground_; }

 private:
  int points_;  // of each patch
  Eigen::Matrix3Xd towards_;
  Eigen::ArrayXd on_ground_;
};

}  // namespace lightwell
