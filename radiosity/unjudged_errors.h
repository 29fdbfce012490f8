#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Raises RadiositySolution::interpolation_error of the elements that refinement does not measure:
/// those of mirrors, glass and black surfaces, whose light no other surface receives, and of parts
/// lit by cracks (see judged_patches()). Each element has at least the RMS difference between
/// interpolated and gathered irradiance at four points inside, less the noise of these gathers (see
/// measure_inside()). Crumbs have the error of their records (see add_record_errors()), and round
/// shapes are left out. `radiosity` is the result
/// of gatherable_radiosity() for the solution; null: found here.
///
/// Does nothing without an error estimate, and where all patches count. The caster of `lit` is of
/// the solution's mesh; `gather` decides the shadow rays. Throws Interrupted when progress says
/// stop.
void add_unjudged_errors(const LitScene& lit, const GatherOptions& gather,
                         RadiositySolution& solution, const BandArray* radiosity = nullptr);

}  // namespace lightwell
