#pragma once

#include "scene/rays/embree_queries.h"

namespace lightwell {

/// The spheres of a ray caster, in double precision, for Embree's callbacks.
struct SphereSet {
  std::vector<Sphere> spheres;
  std::vector<int> group;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // origin of Embree's coordinates, metres
  double rounding = 0.0;                             // bound for Embree's coordinates, metres
};

/// Smallest root t > 0 of |o + t d - c| = r, also beyond the ray's t_max. For a ray that starts on
/// the sphere, the root of smaller magnitude is the ray's own origin and does not count. Negative
/// if there is none.
double sphere_root(const Sphere& sphere, const Ray& ray, bool starts_here);

/// Makes an Embree geometry of `set`, not yet committed. `set` must outlive the geometry.
RTCGeometry sphere_geometry(RTCDevice device, SphereSet& set);

}  // namespace lightwell
