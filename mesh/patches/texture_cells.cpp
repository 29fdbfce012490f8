#include "mesh/patches/texture_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lightwell {

using Eigen::Vector3d;

TextureCell texture_cell(const std::array<Vector3d, 4>& corner, const CellGrid& grid, int i,
                         int j) {
  const double s = (i + 0.5) / grid.along, t = (j + 0.5) / grid.across;
  const Vector3d along = (1.0 - t) * (corner[1] - corner[0]) + t * (corner[2] - corner[3]);
  const Vector3d across = (1.0 - s) * (corner[3] - corner[0]) + s * (corner[2] - corner[1]);
  TextureCell cell{.middle = (1.0 - t) * ((1.0 - s) * corner[0] + s * corner[1]) +
                             t * ((1.0 - s) * corner[3] + s * corner[2])};
  cell.sides << along / grid.along, across / grid.across;
  cell.area = cell.sides.col(0).cross(cell.sides.col(1)).norm();
  return cell;
}

std::array<Vector3d, 4> corners_of(const PatchMesh& mesh, int element) {
  const auto& c = mesh.corners[element];
  const std::array<Vector3d, 3> p{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])};
  if (c[3] >= 0) return {p[0], p[1], p[2], mesh.position(c[3])};
  // A needle's cells are as wide as its picture needs along one direction alone.
  std::size_t first = 0;
  const auto squared_edge = [&](std::size_t i) { return (p[(i + 1) % 3] - p[i]).squaredNorm(); };
  for (const std::size_t i : {1u, 2u}) {
    if (squared_edge(i) < squared_edge(first)) first = i;
  }
  const Vector3d& last = p[(first + 2) % 3];
  return {p[first], p[(first + 1) % 3], last, last};
}

CellGrid cells_over(const FacetTextures& textures, int facet,
                    const std::array<Vector3d, 4>& corner) {
  const auto cells = [&](const Vector3d& one, const Vector3d& other) {
    constexpr double fewest = 4.0;
    const double texels =
        std::max(textures.texels_along(facet, one), textures.texels_along(facet, other));
    return static_cast<int>(std::clamp<double>(std::ceil(texels), fewest, most_texture_points));
  };
  return {.along = cells(corner[1] - corner[0], corner[2] - corner[3]),
          .across = cells(corner[3] - corner[0], corner[2] - corner[1])};
}

Eigen::Matrix<double, 3, 2> filter_of(const TextureCell& cell) {
  constexpr double reach = 0.5;
  return reach * cell.sides;
}

}  // namespace lightwell
