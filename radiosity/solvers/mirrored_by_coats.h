#pragma once

#include "scene/bands.h"

namespace lightwell {

/// What coats mirror of arriving light over mean_mirrored() of it, per column. Coats mirror less of
/// steep light and more of grazing light than of even light. Light that arrived or was lost beyond
/// what was sent has been mirrored on its way.
struct MirroredByCoats {
  explicit MirroredByCoats(Eigen::Index columns)
      : beyond(Eigen::ArrayXd::Zero(columns)), by_coats(beyond) {}

  /// Counts light that arrives at a surface which mirrors the share `mirrored` of even light.
  void arrive(const Eigen::ArrayXd& light, const Eigen::ArrayXd& mirrored, bool is_coat) {
    beyond += light;
    (is_coat ? by_coats : beyond) +=
        is_coat ? Eigen::ArrayXd(light * mirrored) : Eigen::ArrayXd(-light * mirrored);
  }

  /// The ratio; 1 without light on coats. Between about that of the steepest light and four.
  Spectrum of_mean() const {
    constexpr double least = 0.25, most = 4.0;
    return (by_coats > 0.0).select((beyond / by_coats).max(least).min(most), 1.0).cast<float>();
  }

  Eigen::ArrayXd beyond;    ///< light that arrived, was lost, or was sent (negative)
  Eigen::ArrayXd by_coats;  ///< share of the light on coats that they would mirror if it were even
};

}  // namespace lightwell
