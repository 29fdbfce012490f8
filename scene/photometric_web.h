#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// A direction drawn from a distribution of intensity, and its weight.
struct DrawnDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double weight =
      0.0;  ///< value over density, sr; the mean weight is the integral over all directions
};

/// A measured distribution of luminous intensity, type C (CIE 121; IES LM-75). gamma is the angle
/// from the nadir, C the azimuth of the half-plane. In the luminaire's own frame gamma = 0 is -z, C
/// = 0 is +x and C = 90 is +y: counter-clockwise seen from above.
///
/// Values are linear in gamma and in C between the measured angles, as in lighting programs. Below
/// the first gamma and beyond the last there is no light.
class PhotometricWeb {
 public:
  PhotometricWeb() = default;

  /// `values` has a row for each plane and a column for each gamma. Angles are in degrees. gamma
  /// rises strictly within [0, 180]. Planes start at 0 and rise strictly to below 360; the first
  /// follows the last again. A single plane holds for all azimuths.
  ///
  /// Throws std::invalid_argument if the angles break these rules, or a value is negative or not
  /// finite.
  PhotometricWeb(std::vector<double> planes, std::vector<double> gammas,
                 const Eigen::ArrayXXd& values);

  /// Value in a direction of the luminaire's frame, of any length above 0.
  double at(const Eigen::Vector3d& direction) const;
  /// Integral of the values over all directions: lumens where the values are candela.
  double integral() const { return integral_; }
  /// Largest measured value.
  double peak() const { return values_.size() > 0 ? values_.maxCoeff() : 0.0; }
  /// Random direction with a density that follows the values, from numbers `u`, `v` in [0,1).
  DrawnDirection draw(double u, double v) const;

  const std::vector<double>& planes() const { return planes_; }
  const std::vector<double>& gammas() const { return gammas_; }
  const Eigen::ArrayXXd& values() const { return values_; }

 private:
  double along(Eigen::Index plane, Eigen::Index interval, double t) const;
  double at_angles(double gamma, double plane) const;
  void tabulate();

  std::vector<double> planes_{}, gammas_{};
  Eigen::ArrayXXd values_{};
  double integral_ = 0.0;
  // Table for draw(): cumulative light of cells of equal size in gamma and in C.
  static constexpr int bands_of_gamma = 360, sectors = 72;
  std::vector<double> row_cdf_{}, cell_cdf_{};
};

}  // namespace lightwell
