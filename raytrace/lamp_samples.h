#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// A direction in which a lamp lies.
struct LampSample {
  const Emitter* emitter = nullptr;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double distance = 0.0;                                 ///< m
  double density = 0.0;                                  ///< 1/sr
};

/// Directions towards the emitters of DirectLight, for rough surfaces: a highlight that is left to
/// the lobe's own directions is noise, since few of them find a small lamp (Veach & Guibas 1995).
/// An emitter is drawn by about what it would send to the place, one of more than `most_weighed` by
/// its power; a polygon's points evenly by area, a sphere's by solid angle.
class LampSamples {
 public:
  static constexpr int most_weighed = 64;  ///< so that a draw takes less time than its shadow ray

  explicit LampSamples(const DirectLight& direct_light);

  /// From a place on a facet; three numbers in [0,1). Nothing where the lamp drawn sends no light
  /// to it. What lies between is not looked at.
  std::optional<LampSample> draw(const Eigen::Vector3d& from, int facet, double which, double u,
                                 double v) const;
  /// Density of draw() in the direction of a place on the lit side of a facet; 0 if that is none of
  /// DirectLight's emitters.
  double density(const Eigen::Vector3d& from, const Eigen::Vector3d& point, int facet) const;

 private:
  double density_of(double share, const Emitter& emitter, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& direction, double distance) const;
  double weight(std::size_t emitter, const Eigen::Vector3d& from) const;
  double chance(std::size_t emitter, const Eigen::Vector3d& from) const;
  std::size_t drawn(const Eigen::Vector3d& from, double which) const;

  const std::vector<Emitter>& emitters_;
  std::vector<double> share_{};  // of all power
  std::vector<Eigen::Vector3d> center_{};
  std::vector<double> cdf_{};    // its running sum
  std::vector<int> of_facet_{};  // emitter of a facet; -1: none
};

}  // namespace lightwell
