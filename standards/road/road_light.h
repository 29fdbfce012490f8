#pragma once

#include <Eigen/Core>
#include <vector>

#include "standards/road/road.h"

namespace lightwell {

/// Distances within which luminaires count (EN 13201-3): in mounting heights around a point, for
/// heights beyond see r_table.h, and in metres ahead of an eye.
inline constexpr double heights_around_point = 5.0, farthest_glare = 500.0;
/// Height of drivers' eyes and of the points of upright figures above the road, m (EN 13201-3).
inline constexpr double road_eye_height = 1.5;

/// Luminaires of a road between two places along it.
class RoadLight {
 public:
  /// The luminaires of all rows with `from` <= x <= `to`, m; of each row one stands at x = 0, or
  /// half a spacing from there.
  RoadLight(const Road& road, double from, double to);

  /// Horizontal illuminance of new luminaires, lx, by those within 5 heights along and across:
  ///
  ///     E = sum I cos^3(gamma) / H^2
  double illuminance(const Eigen::Vector3d& point) const;

  /// Semi-cylindrical illuminance of new luminaires for a face that looks along `facing`, a level
  /// unit vector, lx (EN 13201-3):
  ///
  ///     E_sc = sum I (1 + cos a) sin(e) / (pi d^2)     a: between facing and light in plan,
  ///                                                    e: between the light and the vertical
  double semicylindrical(const Eigen::Vector3d& point, const Eigen::Vector3d& facing) const;

  /// Vertical illuminance of new luminaires on a plane that looks along `facing`, lx.
  double vertical(const Eigen::Vector3d& point, const Eigen::Vector3d& facing) const;

  /// Luminance of a point of the road for an eye, cd/m^2, by new luminaires from 5 heights before
  /// the point to 12 beyond it and 5 to either side:
  ///
  ///     L = sum I r(tan gamma, beta) / H^2
  double luminance(const RTable& surface, const Eigen::Vector3d& point,
                   const Eigen::Vector3d& eye) const;

  /// Equivalent veiling luminance at an eye that looks along `way` (+1 or -1 times x), 1 degree
  /// downwards, cd/m^2, of new luminaires up to 500 m ahead and below the screen, a plane that
  /// rises by 20 degrees before the eye (CIE 146:2002, for an age of 23 years):
  ///
  ///     L_v = sum 9.86 (1 + (23/66.4)^4) E / theta^2                        1.5 < theta <= 60
  ///           sum (10 / theta^3 + 5 (1 + (23/62.5)^4) / theta^2) E          0.1 <= theta <= 1.5
  double veiling_luminance(const Eigen::Vector3d& eye, double way) const;

 private:
  struct Placed {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  };

  double intensity(const Placed& luminaire, const Eigen::Vector3d& way) const;
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& point, Visit&& visit) const;

  std::shared_ptr<const LuminaireFile> file_{};
  double flux_factor_ = 1.0, height_ = 0.0;
  std::vector<Placed> placed_{};
};

/// Threshold increment f_TI in percent of a veiling luminance before a road of mean luminance
/// `mean`, both of new luminaires, cd/m^2 (EN 13201-3):
///
///     f_TI = 65 L_v / L_m^0.8     up to 5 cd/m^2
///     f_TI = 95 L_v / L_m^1.05    above
double threshold_increment(double veiling, double mean);

}  // namespace lightwell
