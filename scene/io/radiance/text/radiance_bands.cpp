#include "scene/io/radiance/text/radiance_bands.h"

#include <Eigen/LU>

namespace lightwell {
namespace {

// X, Y and Z of a primary with Y = 1.
Eigen::Vector3d unit_primary(double x, double y) {
  return {x / y, 1.0, (1.0 - x - y) / y};
}

// Columns: X, Y and Z of R, G and B, which add up to RADIANCE's white, X = Y = 1 and Z = 1.0003.
Eigen::Matrix3d xyz_of_primaries() {
  const Eigen::Vector3d white = unit_primary(0.3333, 0.3333);
  Eigen::Matrix3d primaries;
  primaries << unit_primary(0.640, 0.330), unit_primary(0.290, 0.600), unit_primary(0.150, 0.060);
  const Eigen::Vector3d weights = primaries.inverse() * white;
  return primaries * weights.asDiagonal();
}

}  // namespace

Bands radiance_bands() {
  Bands bands = rgb_bands(radiance_lumens_per_watt);
  bands.xyz = xyz_of_primaries().cast<float>().array();
  return bands;
}

double radiance_luminance(const Spectrum& rgb) {
  static const Eigen::RowVector3d weights = xyz_of_primaries().row(1);
  return weights * rgb.matrix().cast<double>();
}

}  // namespace lightwell
