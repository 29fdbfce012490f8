#pragma once

#include <Eigen/Core>

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Placement of a shape: x -> scale * rotation * x + offset, in metres.
struct Placement {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    return scale * (rotation * p) + offset;
  }
  UvMap operator()(const UvMap& map) const {
    const Eigen::Matrix<double, 2, 3> gradient = map.gradient * rotation.transpose() / scale;
    return {.gradient = gradient, .offset = map.offset - gradient * offset};
  }
  NormalMap operator()(const NormalMap& map) const {
    const Eigen::Matrix3d gradient = rotation * map.gradient * rotation.transpose() / scale;
    return {.gradient = gradient, .offset = rotation * map.offset - gradient * offset};
  }
};

/// Reads the keys `scale`, `rotate` (degrees about x, then y, then z), `pivot` and `translate` of a
/// table in a file of `metres_per_unit`. Throws InputError.
Placement read_placement(const TomlTable& table, double metres_per_unit);

}  // namespace lightwell
