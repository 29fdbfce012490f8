#include "scene/environment_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lightwell {

using std::numbers::pi;

Eigen::Vector3d map_direction(double across, double down) {
  const double longitude = 2.0 * pi * (across - 0.5), polar = pi * down;
  return {-std::sin(polar) * std::sin(longitude), std::cos(polar),
          std::sin(polar) * std::cos(longitude)};
}

Eigen::Vector2d map_position(const Eigen::Vector3d& direction) {
  return {0.5 + std::atan2(-direction.x(), direction.z()) / (2.0 * pi),
          std::acos(std::clamp(direction.y(), -1.0, 1.0)) / pi};
}

Eigen::Matrix3d to_map_around(const Eigen::Vector3d& up, const Eigen::Vector3d& middle) {
  Eigen::Matrix3d to_map;
  to_map << up.cross(middle).transpose(), up.transpose(), middle.transpose();
  return to_map;
}

EnvironmentMap::EnvironmentMap(int width, int height, BandArray radiance)
    : width_(width), height_(height), radiance_(std::move(radiance)) {
  if (width < 1 || height < 1 || radiance_.rows() != std::int64_t{width} * height ||
      radiance_.cols() < 1) {
    throw std::invalid_argument("an environment map needs width x height pixels");
  }
  if (!radiance_.isFinite().all() || (radiance_ < 0.0f).any()) {
    throw std::invalid_argument(
        "the radiance of an environment map must be finite and not below 0");
  }
  // FNV-1a over words instead of bytes.
  hash_ = 0xcbf29ce484222325ull;
  const auto add = [this](std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ull; };
  add(static_cast<std::uint64_t>(width));
  add(static_cast<std::uint64_t>(height));
  for (std::ptrdiff_t i = 0; i < radiance_.size(); ++i) {
    add(std::bit_cast<std::uint32_t>(radiance_.data()[i]));
    hash_ ^= hash_ >> 32;
  }
}

Spectrum EnvironmentMap::at(const Eigen::Vector3d& direction) const {
  const Eigen::Vector2d place = map_position(direction);
  const double x = place.x() * width_ - 0.5;
  const double y = std::clamp(place.y() * height_ - 0.5, 0.0, height_ - 1.0);
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(y);
  const auto across = static_cast<float>(x - column), down = static_cast<float>(y - row);
  const int left = (column + width_) % width_, right = (column + 1 + width_) % width_;
  const int below = std::min(row + 1, height_ - 1);
  return ((1.0f - down) * ((1.0f - across) * pixel(left, row) + across * pixel(right, row)) +
          down * ((1.0f - across) * pixel(left, below) + across * pixel(right, below)))
      .transpose();
}

}  // namespace lightwell
