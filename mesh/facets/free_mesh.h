#pragma once

#include "mesh/facets/facet_mesh.h"

namespace lightwell {

/// Meshes any polygon with any contact lines by triangulation; see mesh_facet(). Returns an empty
/// mesh if nothing lies inside, or if creases had to be cut where lines cross.
FacetMesh free_mesh(const FacetPlane& plane, const FacetOutline& outline,
                    const std::vector<Eigen::Vector3d>& points, const FacetSize& size);

}  // namespace lightwell
