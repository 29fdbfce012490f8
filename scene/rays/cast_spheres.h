#pragma once

#include "scene/rays/embree_queries.h"

namespace lightwell {

/// The spheres of a ray caster, as Embree's callbacks find them. Exact, in double precision.
struct SphereSet {
  std::vector<Sphere> spheres;
  std::vector<int> group;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of Embree's coordinates
  double rounding = 0.0;                             // of Embree's coordinates, metres
};

/// The nearest root of |o + t d - c| = r above 0, also beyond the ray's t_max; for a ray that
/// starts on this sphere the root at its own origin is the one of smaller magnitude and does not
/// count. Negative: none.
double sphere_root(const Sphere& sphere, const Ray& ray, bool starts_here);

/// A geometry of Embree's, not yet committed, over `set`, which must outlive it.
RTCGeometry sphere_geometry(RTCDevice device, SphereSet& set);

}  // namespace lightwell
