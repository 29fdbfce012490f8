#pragma once

#include <memory>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solution/solution.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/shading/irradiance_records.h"
#include "raytrace/shading/render_options.h"

namespace lightwell {

/// Records of the indirect light of what a camera sees, for Pass::automatic. Null where the
/// solution's own light is as good:
/// - its estimate says so, or says nothing;
/// - the noise of the records of the widest grid is more than that estimate, as where much of the
///   light comes through a solid pane, which few rays of a record meet.
///
/// Places are sought on grids of pixels, from wide to narrow ones: a place that no record covers
/// gets a record, whose radius is a share of the harmonic mean of the distances to what the place
/// sees (Ward, Rubinstein & Clear 1988), but at least 0.8 of a step of the narrowest grid, or less
/// where the picture shows places around in finer detail. What is seen by way of smooth mirrors and
/// glass gets records as well. A last round covers the places
/// that narrowed records have left. Grids that do not fit into limited time are left out.
/// RecordNeighbours keep a record in the open from serving in a room that stands on the same
/// ground. E is that of PixelGather with RenderOptions::gather_rays.
std::shared_ptr<const IrradianceRecords> find_records(const LitScene& lit,
                                                      const RadiositySolution& solution,
                                                      const Camera& camera, const CameraRays& rays,
                                                      const RenderOptions& options);

}  // namespace lightwell
