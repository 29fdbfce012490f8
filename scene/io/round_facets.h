#pragma once

#include "scene/scene.h"

namespace lightwell {

/// A cylinder, cone, truncated cone, disc or ring with its front away from the axis (along it, for
/// a disc or ring whose base is its outer circle), or with `inward` the other way. `axis` may have
/// any length > 0.
Frustum frustum_about(const Eigen::Vector3d& base, const Eigen::Vector3d& axis, double height,
                      double base_radius, double top_radius, bool inward);

/// A frustum moved by a transformation that keeps angles (see keeps_angles). Fronts stay on their
/// side of the surface, even where the transformation mirrors.
Frustum placed_frustum(const Frustum& frustum, const Eigen::Affine3d& transform);

/// The frustum as 32 facets of the same area, with the normals of the round shape; a disc or ring
/// as one facet of 32 corners.
PolygonMesh facets_of(const Frustum& frustum);

/// Replaces frustums that are better polygons by facets_of(), with a loss for each kind:
/// - those that shine, since emitters are sampled by their polygons;
/// - discs and rings that lie on polygons or on each other, where only polygons have an order.
void replace_by_facets(Scene& scene);

}  // namespace lightwell
