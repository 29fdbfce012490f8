#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// A sampled direction towards a lamp.
struct LampSample {
  const Emitter* emitter = nullptr;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double distance = 0.0;                                 ///< m
  double density = 0.0;                                  ///< probability density, 1/sr
};

/// Sampled directions towards the emitters of DirectLight, for rough surfaces. A highlight sampled
/// by the lobe alone is noisy, since few directions of the lobe meet a small lamp (Veach & Guibas
/// 1995).
///
/// The probability of an emitter is proportional to its approximate irradiance at the point, or to
/// its power if there are more than `most_weighed` emitters. Points of polygons are uniform in
/// area, points of spheres uniform in solid angle.
class LampSamples {
 public:
  static constexpr int most_weighed = 64;  ///< a draw takes less time than its shadow ray

  explicit LampSamples(const DirectLight& direct_light);

  /// Draws a direction from a point on a facet by three numbers in [0,1). Empty if the drawn lamp
  /// sends no light to the point or is the facet itself. Visibility is not tested.
  std::optional<LampSample> draw(const Eigen::Vector3d& from, int facet, double which, double u,
                                 double v) const;
  /// Probability density of draw(), 1/sr, in the direction of a point on the lit side of a facet; 0
  /// if the facet is no emitter of DirectLight.
  double density(const Eigen::Vector3d& from, const Eigen::Vector3d& point, int facet) const;

 private:
  double density_of(double share, const Emitter& emitter, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& direction, double distance) const;
  double weight(std::size_t emitter, const Eigen::Vector3d& from) const;
  double chance(std::size_t emitter, const Eigen::Vector3d& from) const;
  std::size_t drawn(const Eigen::Vector3d& from, double which) const;

  const std::vector<Emitter>& emitters_;
  std::vector<double> share_{};  // per emitter: share of the total power
  std::vector<double> cdf_{};    // running sum of share_
  std::vector<int> of_facet_{};  // emitter per facet; -1: none
};

}  // namespace lightwell
