#pragma once

#include "mesh/element_caster.h"
#include "radiosity/direct_light.h"
#include "radiosity/solve.h"

namespace lightwell {

/// Relative RMS error of interpolated irradiance over the area that reflects: at
/// `options.error_points` random places, against gathers with twice the rays of the solution's or
/// more (see estimate_rays) and other random numbers. It holds the noise of both, so it errs on the
/// high side; what it is relative to, error_reference() says. `caster` is of the solution's mesh.
double estimate_error(const Scene& scene, const ElementCaster& caster,
                      const DirectLight& direct_light, const SolveOptions& options,
                      const RadiositySolution& solution);

}  // namespace lightwell
