#pragma once

#include "mesh/geometry/cut_size.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Latitude-longitude elements of a sphere's outside, ordered by patch. Patches near the poles span
/// more sectors, so that no patch is much narrower than the others.
struct SphereElements {
  int rings = 0, sectors = 0;
  std::vector<Eigen::Vector3d> position{};    ///< on the exact sphere; the first two are the poles
  std::vector<std::array<int, 4>> corners{};  ///< counter-clockwise from outside; poles: [3] = -1
  std::vector<double> area{};                 ///< exact, m^2: r^2 dphi (cos theta_0 - cos theta_1)
  std::vector<int> first_element{0};          ///< patches + 1
  std::vector<int> element{};  ///< element of (ring, sector) at ring * sectors + sector
};

/// Cuts a sphere into at least two patches from pole to pole and at least four around.
SphereElements sphere_elements(const Sphere& sphere, const CutSize& size);

/// The cell of a sphere's grid that a direction from the centre meets, and the place in the cell in
/// angle.
struct SphereGridPoint {
  int ring = 0, sector = 0;
  double u = 0.0;  ///< [0,1] along the sector, with longitude
  double v = 0.0;  ///< [0,1] across the ring, from its southern to its northern edge
};
/// The place that `direction` (of any length) meets.
SphereGridPoint sphere_grid_point(const SphereGrid& grid, const Eigen::Vector3d& direction);

/// The unit direction of a place.
Eigen::Vector3d sphere_direction(const SphereGrid& grid, const SphereGridPoint& grid_point);

/// Weights of the outside element's corners, in the order of PatchMesh::corners: bilinear in angle.
Eigen::Array4f sphere_weights(const SphereGrid& grid, const SphereGridPoint& grid_point);

/// The grid that the elements of a scene-wide facet belong to; nullptr for a polygon.
const SphereGrid* sphere_grid_of(const PatchMesh& mesh, int facet);

}  // namespace lightwell
