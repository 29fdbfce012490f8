#pragma once

#include "mesh/facets/facet_mesh.h"

namespace lightwell {

/// The general way of mesh_facet, for any polygon and any contact lines.
FacetMesh free_mesh(const FacetPlane& plane, const FacetOutline& outline,
                    const std::vector<Eigen::Vector3d>& points, const CutSize& size);

}  // namespace lightwell
