#pragma once

#include "mesh/geometry/cut_size.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Latitude-longitude elements of a sphere's outside, ordered by patch. Cells near the poles are
/// shared by fewer patches, so that no patch is much narrower than the others.
struct SphereElements {
  int rings = 0, sectors = 0;
  std::vector<Eigen::Vector3d> position{};    ///< on the exact sphere; the first two are the poles
  std::vector<std::array<int, 4>> corners{};  ///< counter-clockwise from outside; poles: [3] = -1
  std::vector<double> area{};                 ///< r^2 dphi d(cos theta): exact
  std::vector<int> first_element{0};          ///< patches + 1
  std::vector<int> element{};                 ///< at ring * sectors + sector
};

SphereElements sphere_elements(const Sphere& sphere, const CutSize& size);

/// Where a direction from a sphere's centre meets its grid: the cell, and the place in it in angle.
struct SphereGridPoint {
  int ring = 0, sector = 0;
  double u = 0.0;  ///< [0,1] along the sector, with longitude
  double v = 0.0;  ///< [0,1] across the ring, from its southern to its northern edge
};
SphereGridPoint sphere_grid_point(const SphereGrid& grid, const Eigen::Vector3d& direction);

/// Unit direction of the place.
Eigen::Vector3d sphere_direction(const SphereGrid& grid, const SphereGridPoint& grid_point);

/// Weights of the outside element's corners (in its own order): bilinear in angle.
Eigen::Array4f sphere_weights(const SphereGrid& grid, const SphereGridPoint& grid_point);

/// The grid that the elements of a scene-wide facet belong to; nullptr for a polygon.
const SphereGrid* sphere_grid_of(const PatchMesh& mesh, int facet);

}  // namespace lightwell
