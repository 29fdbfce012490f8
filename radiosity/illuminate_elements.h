#pragma once

#include <vector>

#include "radiosity/openings/find_openings.h"
#include "radiosity/solve.h"

namespace lightwell {

/// Direct light of a scene and its mesh, and the openings that rays may be aimed at: all that
/// gathers take from a scene beside its surfaces. Both sums of direct light are the same object if
/// light is not kept apart by channels.
struct GatherSources {
  const DirectLight& all;                ///< all channels together
  const DirectLight& by_channel;         ///< columns for each channel
  const std::vector<Opening>& openings;  ///< of find_openings()
};

/// Finds the irradiance at vertices from the radiosity of patches.
///
/// 1. Splits elements by `options.refine`.
/// 2. Gathers to their vertices.
/// 3. Estimates the error.
///
/// With `options.accuracy` the steps are repeated with more rays or smaller elements until the
/// estimate meets the accuracy, or until more effort would not help.
///
/// If the time of `options.run` is limited, the errors to reach fall from 16 % to the accuracy (0.5
/// % if there is none), each stage as long as it fits into the time. Once the time is up, the last
/// stage that was finished counts. If there is none, or if a limit comes by surprise, the solution
/// is completed from what there is, with Outcome::cut_short.
///
/// `solved` has the light of
/// patches, and gets the refined mesh, the light of vertices and the seconds of each phase;
/// `report`, if given, gets the refinement, the accuracy and the rays. Throws InputError if light
/// is not finite, Interrupted when progress says stop.
void illuminate_elements(const Scene& scene, const GatherSources& sources,
                         const SolveOptions& options, SolvedScene& solved, SolveReport* report);

}  // namespace lightwell
