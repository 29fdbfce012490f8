#include "scene/io/toml/toml_placement.h"

#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

// Cosine and sine, exact for quarter turns: a wall turned by 90 degrees stays parallel to the axes.
Eigen::Vector2d cos_sin(double degrees) {
  const double quarters = std::remainder(degrees, 360.0) / 90.0;
  if (quarters == std::round(quarters)) {
    const int q = (static_cast<int>(quarters) + 4) % 4;
    return {q == 0 ? 1.0 : q == 2 ? -1.0 : 0.0, q == 1 ? 1.0 : q == 3 ? -1.0 : 0.0};
  }
  const double angle = quarters * std::numbers::pi / 2.0;
  return {std::cos(angle), std::sin(angle)};
}

Eigen::Matrix3d turn_about(int axis, double degrees) {
  const Eigen::Vector2d cs = cos_sin(degrees);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(u, u) = m(v, v) = cs[0];
  m(v, u) = cs[1];
  m(u, v) = -cs[1];
  return m;
}

}  // namespace

Placement read_placement(const TomlTable& table, double metres_per_unit) {
  Placement placement;
  if (const auto scale = table.find("scale")) placement.scale = scale->positive();
  if (const auto rotate = table.find("rotate")) {
    const Eigen::Vector3d degrees = rotate->vector();
    placement.rotation =
        turn_about(2, degrees[2]) * turn_about(1, degrees[1]) * turn_about(0, degrees[0]);
  }
  if (const auto pivot = table.find("pivot")) {
    const Eigen::Vector3d p = pivot->vector();
    placement.offset = p - placement(p);
  }
  if (const auto translate = table.find("translate")) placement.offset += translate->vector();
  placement.scale *= metres_per_unit;
  placement.offset *= metres_per_unit;
  return placement;
}

}  // namespace lightwell
