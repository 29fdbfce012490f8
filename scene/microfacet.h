#pragma once

#include <Eigen/Core>

namespace lightwell {

/// Smith's Lambda of GGX microfacets (Trowbridge & Reitz 1975; Walter et al. 2007), (sqrt(1 +
/// alpha^2 tan^2) - 1) / 2, for a direction at `cosine`, (0,1], to the surface's normal. A share 1
/// / (1 + Lambda) of the microfacets that face the direction is visible from it.
double ggx_lambda(double cosine, double alpha);

/// GGX's density of normals D, 1/sr, at `cosine` to the surface's normal:
/// a^2 / (pi (cos^2 (a^2 - 1) + 1)^2).
double ggx_normals(double cosine, double alpha);

/// Random normal of a microfacet as visible from `outwards` (unit, z > 0, about the normal +z),
/// with the density of visible normals, D(m) max(0, outwards.m) / (cos (1 + Lambda)). Heitz 2018,
/// "Sampling the GGX distribution of visible normals". `u`, `v` in [0,1).
Eigen::Vector3d ggx_visible_normal(const Eigen::Vector3d& outwards, double alpha, double u,
                                   double v);

}  // namespace lightwell
