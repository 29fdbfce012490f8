#include "mesh/patches/texture_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lightwell {

using Eigen::Vector3d;

TextureCell texture_cell(const std::array<Vector3d, 4>& corner, int points, int i, int j) {
  const double s = (i + 0.5) / points, t = (j + 0.5) / points;
  const Vector3d along = (1.0 - t) * (corner[1] - corner[0]) + t * (corner[2] - corner[3]);
  const Vector3d across = (1.0 - s) * (corner[3] - corner[0]) + s * (corner[2] - corner[1]);
  TextureCell cell{.middle = (1.0 - t) * ((1.0 - s) * corner[0] + s * corner[1]) +
                             t * ((1.0 - s) * corner[3] + s * corner[2])};
  cell.sides << along / points, across / points;
  cell.area = cell.sides.col(0).cross(cell.sides.col(1)).norm();
  return cell;
}

std::array<Vector3d, 4> corners_of(const PatchMesh& mesh, int element) {
  const auto& c = mesh.corners[element];
  const Vector3d last = mesh.position(c[2]);
  if (c[3] < 0) return {mesh.position(c[0]), mesh.position(c[1]), last, last};
  return {mesh.position(c[0]), mesh.position(c[1]), last, mesh.position(c[3])};
}

int points_across(const FacetTextures& textures, int facet, const std::array<Vector3d, 4>& corner) {
  constexpr int fewest = 4;
  double longest = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Vector3d edge = corner[(i + 1) % 4] - corner[i];
    longest = std::max(longest, textures.texels_along(facet, edge));
  }
  return static_cast<int>(std::clamp<double>(std::ceil(longest), fewest, most_texture_points));
}

Eigen::Matrix<double, 3, 2> filter_of(const TextureCell& cell) {
  constexpr double reach = 0.5;
  return reach * cell.sides;
}

}  // namespace lightwell
