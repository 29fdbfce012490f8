#include "mesh/patches/mesh_bounds.h"

#include <limits>

namespace lightwell {

Bounds mesh_bounds(const PatchMesh& mesh) {
  Bounds bounds{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
                Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    bounds.low = bounds.low.cwiseMin(mesh.position(v));
    bounds.high = bounds.high.cwiseMax(mesh.position(v));
  }
  return bounds;
}

}  // namespace lightwell
