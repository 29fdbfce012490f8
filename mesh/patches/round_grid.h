#pragma once

#include "mesh/geometry/cut_size.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Elements of the front of a round shape in rings and sectors (see RoundGrid), ordered by patch.
/// Patches where rings are short span more sectors, so that no patch is much narrower than the
/// others.
struct RoundElements {
  int rings = 0, sectors = 0;
  std::vector<Eigen::Vector3d> position{};    ///< on the exact shape
  std::vector<std::array<int, 4>> corners{};  ///< counter-clockwise from the front; poles: [3] = -1
  std::vector<double> area{};                 ///< exact, m^2
  std::vector<int> first_element{0};          ///< patches + 1
  std::vector<int> element{};  ///< element of (ring, sector) at ring * sectors + sector
};

/// Cuts a shape into patches: a sphere into at least two from pole to pole, and all shapes into at
/// least four around.
RoundElements round_elements(const RoundShape& shape, const CutSize& size);

/// A cell of a round shape's grid and a place in the cell.
struct RoundGridPoint {
  int ring = 0, sector = 0;
  double u = 0.0;  ///< [0,1] along the sector, with longitude
  double v = 0.0;  ///< [0,1] across the ring, from its southern to its northern edge
};
/// The place of the point on the shape that is nearest to `point`.
RoundGridPoint round_grid_point(const RoundGrid& grid, const Eigen::Vector3d& point);

/// The point of the exact shape at a place.
Eigen::Vector3d point_at(const RoundGrid& grid, const RoundGridPoint& place);

/// The point of a cell that u and v, [0,1], name such that even u and v give points even in area.
Eigen::Vector3d even_point(const RoundGrid& grid, int ring, int sector, double u, double v);

/// Weights of the front element's corners, in the order of PatchMesh::corners: bilinear in the
/// place.
Eigen::Array4f round_weights(const RoundGrid& grid, const RoundGridPoint& place);

/// True if the cells of a ring are triangles, whose northern (southern) edge is a point.
bool ends_north(const RoundGrid& grid, int ring);
bool ends_south(const RoundGrid& grid, int ring);

/// The grid that the elements of a scene-wide facet belong to; nullptr for a polygon.
const RoundGrid* round_grid_of(const PatchMesh& mesh, int facet);

/// Unit normal of the shape at the point nearest to `point`, on the side of the patch.
Eigen::Vector3d round_normal(const PatchMesh& mesh, const RoundGrid& grid, int patch,
                             const Eigen::Vector3d& point);

}  // namespace lightwell
