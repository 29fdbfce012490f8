#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scene/bands.h"

namespace lightwell {

/// Unit direction of a position in a map's picture: shares of its width and height, from the top
/// left corner (see EnvironmentMap).
Eigen::Vector3d map_direction(double across, double down);
/// Position of a unit direction in a map's picture, the inverse of map_direction().
Eigen::Vector2d map_position(const Eigen::Vector3d& direction);
/// Rotation to a map with `up` at the top and `middle`, a unit direction on the horizon, in the
/// middle.
Eigen::Matrix3d to_map_around(const Eigen::Vector3d& up, const Eigen::Vector3d& middle);

/// Radiance from all directions, W/(m^2 sr), as a picture over longitude and latitude in Mitsuba's
/// layout. Rows run from +y (top) to -y. The middle of the picture is +z; a quarter of the width to
/// the right of the middle is -x, seen from within.
class EnvironmentMap {
 public:
  /// `radiance`: width * height rows from the top left corner on, a column per band. Throws
  /// std::invalid_argument if the sizes differ or a value is below 0 or not finite.
  EnvironmentMap(int width, int height, BandArray radiance);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Radiance in a unit direction, bilinear between the middles of pixels.
  Spectrum at(const Eigen::Vector3d& direction) const;
  /// Hash of size and pixels, equal for equal pictures.
  std::uint64_t hash() const { return hash_; }

 private:
  auto pixel(int x, int y) const { return radiance_.row(std::int64_t{y} * width_ + x); }

  int width_ = 0, height_ = 0;
  BandArray radiance_;
  std::uint64_t hash_ = 0;
};

}  // namespace lightwell
