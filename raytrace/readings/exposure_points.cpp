#include "raytrace/readings/exposure_points.h"

#include "raytrace/readings/probe_surface.h"

namespace lightwell {

std::vector<SurfacePoint> exposure_points(const ElementCaster& caster,
                                          std::span<const Probe> probes) {
  std::vector<SurfacePoint> points;
  for (const GatherPoint& point : probe_points(caster, probes)) {
    points.push_back({.position = point.position, .normal = point.normal, .facet = point.facet});
  }
  return points;
}

}  // namespace lightwell
