#include "mesh/facets/reflex_corners.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

namespace lightwell {
namespace {

using Eigen::Vector3d;

double corner_angle(const FacetMesh& mesh, const std::array<int, 4>& c, int corner) {
  const int count = c[3] < 0 ? 3 : 4;
  const Vector3d& at = mesh.position[c[corner]];
  const Vector3d a = mesh.position[c[(corner + 1) % count]] - at;
  const Vector3d b = mesh.position[c[(corner + count - 1) % count]] - at;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

std::vector<char> split_reflex_corners(FacetMesh& mesh) {
  // Bounds between a straight boundary (180 degrees) and an inner point (360), with room for cells
  // that are not quite flat.
  constexpr double least = 200.0 * std::numbers::pi / 180.0;
  constexpr double most = 350.0 * std::numbers::pi / 180.0;
  std::vector<double> angle(mesh.position.size(), 0.0);
  for (const auto& c : mesh.corners) {
    for (int i = 0; i < (c[3] < 0 ? 3 : 4); ++i) angle[c[i]] += corner_angle(mesh, c, i);
  }
  std::vector<char> split(mesh.position.size(), 0);
  for (auto& c : mesh.corners) {
    for (int i = 0; i < (c[3] < 0 ? 3 : 4); ++i) {
      const int v = c[i];
      if (v >= static_cast<int>(angle.size()) || !(angle[v] > least && angle[v] < most)) continue;
      if (split[v]) {
        c[i] = static_cast<int>(mesh.position.size());
        mesh.position.push_back(Vector3d(mesh.position[v]));
        split.push_back(1);
      }
      split[v] = 1;
    }
  }
  return split;
}

}  // namespace lightwell
