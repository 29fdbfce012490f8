#include "scene/io/corner_maps.h"

#include <Eigen/Geometry>
#include <tuple>
#include <utility>

#include "scene/io/flat_loop.h"

namespace lightwell {
namespace {

// Tolerance of texture coordinates: a tenth of a texel in a picture of a thousand.
double uv_tolerance(const UvLoop& uv) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& at : uv) box.extend(at);
  return 1e-4 + 1e-3 * box.diagonal().norm();
}

// Linear map of corner values over the loop's plane, exact at three corners far from each other.
// The loop may have no area.
template <int size>
struct LinearMap {
  Eigen::Matrix<double, size, 3> gradient;
  Eigen::Matrix<double, size, 1> offset;
};

template <int size>
std::optional<LinearMap<size>> linear_over(
    const Loop& loop, const std::vector<Eigen::Matrix<double, size, 1>>& values) {
  if (values.size() != loop.size()) return std::nullopt;
  std::size_t one = 0, other = 0;
  double farthest = 0.0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const double distance = (loop[i] - loop[0]).squaredNorm();
    if (distance > farthest) std::tie(farthest, one) = std::pair(distance, i);
  }
  const Eigen::Vector3d a = loop[one] - loop[0];
  farthest = 0.0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const double distance = a.cross(loop[i] - loop[0]).squaredNorm();
    if (distance > farthest) std::tie(farthest, other) = std::pair(distance, i);
  }
  const Eigen::Vector3d b = loop[other] - loop[0], normal = a.cross(b);
  const double area = normal.squaredNorm();
  if (!(area > 0.0)) return std::nullopt;
  // Matrix that maps a to (1, 0), b to (0, 1), and the normal to 0.
  Eigen::Matrix<double, 2, 3> to_sides;
  to_sides << b.cross(normal).transpose() / area, normal.cross(a).transpose() / area;
  Eigen::Matrix<double, size, 2> sides;
  sides << values[one] - values[0], values[other] - values[0];
  LinearMap<size> map{.gradient = sides * to_sides, .offset = {}};
  map.offset = values[0] - map.gradient * loop[0];
  if (!map.gradient.allFinite() || !map.offset.allFinite()) return std::nullopt;
  return map;
}

// Largest deviation of unit normals from a linear map over a polygon.
constexpr double linear = 2e-3;

}  // namespace

bool agrees(const UvMap& map, const Loop& loop, const UvLoop& uv) {
  const double tolerance = uv_tolerance(uv);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!((map.at(loop[i]) - uv[i]).norm() <= tolerance)) return false;
  }
  return true;
}

NormalLoop bent_normals(const Loop& loop, const NormalLoop& normals) {
  if (normals.size() != loop.size()) return {};
  const Eigen::Vector3d flat = area_vector(loop).normalized();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& n : normals) sum += n.stableNormalized();
  const double side = sum.dot(flat) < 0.0 ? -1.0 : 1.0;
  constexpr double straight = 1.0 - 6e-6, grazing = 0.1;  // cosines of 0.2 and 84 degrees
  bool is_flat = true;
  NormalLoop unit;
  for (const Eigen::Vector3d& n : normals) {
    unit.push_back(side * n.stableNormalized());
    const double cosine = unit.back().dot(flat);
    if (!(cosine > grazing)) return {};
    is_flat = is_flat && cosine > straight;
  }
  return is_flat ? NormalLoop{} : unit;
}

bool agrees(const NormalMap& map, const Loop& loop, const NormalLoop& unit, double tolerance) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!((map.at(loop[i]) - unit[i]).norm() <= tolerance)) return false;
  }
  return true;
}

std::optional<NormalMap> map_of_unit_normals(const Loop& loop, const NormalLoop& unit) {
  const auto found = linear_over<3>(loop, unit);
  if (!found) return std::nullopt;
  const NormalMap map{.gradient = found->gradient, .offset = found->offset};
  return agrees(map, loop, unit, linear) ? std::optional(map) : std::nullopt;
}

std::optional<UvMap> uv_map_over(const Loop& loop, const UvLoop& uv) {
  const auto found = linear_over<2>(loop, uv);
  if (!found) return std::nullopt;
  const UvMap map{.gradient = found->gradient, .offset = found->offset};
  return agrees(map, loop, uv) ? std::optional(map) : std::nullopt;
}

std::optional<NormalMap> normal_map_over(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  return unit.empty() ? std::nullopt : map_of_unit_normals(loop, unit);
}

bool is_even(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  return unit.empty() || map_of_unit_normals(loop, unit);
}

}  // namespace lightwell
