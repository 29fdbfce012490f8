#include "mesh/patches/inset.h"

#include <algorithm>
#include <limits>

#include "mesh/patches/mesh_bounds.h"

namespace lightwell {

double least_inset(const PatchMesh& mesh) {
  if (mesh.vertex_count() == 0) return 0.0;
  constexpr double roundings = 16.0;
  return roundings * std::numeric_limits<float>::epsilon() * 0.5 * mesh_bounds(mesh).diagonal();
}

Eigen::Vector3d inset(const Eigen::Vector3d& point, const Eigen::Vector3d& center, double share,
                      double least) {
  constexpr double most = 0.5;
  const Eigen::Vector3d way = center - point;
  const double length = way.norm();
  if (share * length < least) share = std::min(most, least / length);
  return share * way;
}

}  // namespace lightwell
