#include "mesh/patches/element_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lightwell {

using Eigen::Vector3d;

ElementShape element_shape(const PatchMesh& mesh, int element) {
  const int n = mesh.corner_count(element);
  std::array<Vector3d, 4> corner;
  for (int i = 0; i < n; ++i) corner[i] = mesh.position(mesh.corners[element][i]);
  double least = std::numbers::pi, longest = 0.0, perimeter = 0.0;
  Vector3d twice_area = Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Vector3d ahead = corner[(i + 1) % n] - corner[i];
    const Vector3d behind = corner[(i + n - 1) % n] - corner[i];
    least = std::min(least, std::atan2(ahead.cross(behind).norm(), ahead.dot(behind)));
    longest = std::max(longest, ahead.norm());
    perimeter += ahead.norm();
    twice_area += (corner[i] - corner[0]).cross(corner[(i + 1) % n] - corner[0]);
  }
  const double unit = n == 3 ? 4.0 * std::numbers::sqrt3 : 4.0;
  const double area = 0.5 * twice_area.norm();
  return {.least_angle_degrees = least * 180.0 / std::numbers::pi,
          .aspect_ratio = area > 0.0 ? longest * perimeter / (unit * area)
                                     : std::numeric_limits<double>::infinity()};
}

ElementQuality element_quality(const PatchMesh& mesh) {
  ElementQuality quality;
  int below_10 = 0, below_20 = 0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.is_back[p]) continue;
    ++quality.patches;
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const ElementShape shape = element_shape(mesh, e);
      const double area = mesh.element_area[e];
      ++quality.elements;
      quality.area += area;
      quality.least_angle_degrees =
          std::min(quality.least_angle_degrees, shape.least_angle_degrees);
      quality.largest_aspect_ratio = std::max(quality.largest_aspect_ratio, shape.aspect_ratio);
      below_10 += shape.least_angle_degrees < 10.0 ? 1 : 0;
      below_20 += shape.least_angle_degrees < 20.0 ? 1 : 0;
      if (quality.smallest < 0 || area < mesh.element_area[quality.smallest]) quality.smallest = e;
      if (quality.largest < 0 || area > mesh.element_area[quality.largest]) quality.largest = e;
    }
  }
  const double count = std::max(1, quality.elements);
  quality.below_10_degrees = below_10 / count;
  quality.below_20_degrees = below_20 / count;
  return quality;
}

double scene_area(const Scene& scene) {
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) area += surface_area(surface);
  return area;
}

}  // namespace lightwell
