#pragma once

#include <span>
#include <vector>

#include "radiosity/radiation/point_exposure.h"
#include "raytrace/readings/probe.h"

namespace lightwell {

/// The points at which sun and sky are measured for probes: on the facet that a probe lies on, or
/// in the air (see ProbeSurface).
std::vector<SurfacePoint> exposure_points(const ElementCaster& caster,
                                          std::span<const Probe> probes);

}  // namespace lightwell
