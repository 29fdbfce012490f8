#pragma once

#include <cstdint>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solution/solution.h"
#include "raytrace/pictures/image.h"
#include "raytrace/shading/render_options.h"

namespace lightwell {

/// Effort of a picture.
struct RenderReport {
  double seconds = 0.0;
  std::int64_t eye_rays = 0;   ///< pixel samples
  std::int64_t depth_cut = 0;  ///< branches that ended at max_depth
  /// Mean weight of cut branches per sample: the share of the picture that is missing, if the cut
  /// light is as bright as the rest.
  double cut_share = 0.0;
  /// All tiles, and tiles recalled from the journal, whose rays count too.
  int tiles = 0, recalled_tiles = 0;
};

/// Second pass: Whitted's recursive ray tracing (1980) over the radiosity solution. A pixel is the
/// mean radiance over its square, or over many samples with a lens, with motion or where the pixel
/// shows gloss (see SampleOptions). Pictures have the same bits for any number of threads.
///
/// Light is solved for one instant and moves with the surfaces; shadows and gathers are sampled in
/// time. Throws:
/// - InputError if anything moves and the middle of the shutter's interval is not
///   RigidMotion::rest_time, or as CameraRays does;
/// - std::invalid_argument as validate();
/// - Interrupted when progress says stop.
Image render(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
             const RadiositySolution& solution, const Camera& camera,
             const RenderOptions& options = {}, RenderReport* report = nullptr);

}  // namespace lightwell
