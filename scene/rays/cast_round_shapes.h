#pragma once

#include "scene/rays/embree_queries.h"
#include "scene/round_shape.h"

namespace lightwell {

/// The round shapes of a ray caster, in double precision, for Embree's callbacks.
struct RoundShapeSet {
  std::vector<RoundShape> shapes;
  std::vector<int> group;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // origin of Embree's coordinates, metres
  double rounding = 0.0;                             // bound for Embree's coordinates, metres
};

/// Smallest t > 0 at which a ray meets a shape, also beyond the ray's t_max. For a ray that starts
/// on the shape, the ray's own origin does not count. Negative if there is none.
double round_root(const RoundShape& shape, const Ray& ray, bool starts_here);

/// Makes an Embree geometry of `set`, not yet committed. `set` must outlive the geometry.
RTCGeometry round_geometry(RTCDevice device, RoundShapeSet& set);

}  // namespace lightwell
