#pragma once

#include "radiosity/solve.h"

namespace lightwell {

/// Direct light of the same scene and mesh, without channels and with a column for each channel;
/// both the same object where light is not kept apart.
struct DirectLightSums {
  const DirectLight& all;
  const DirectLight& by_channel;
};

/// Finds the irradiance at vertices from the radiosity of patches: splits elements as
/// `options.refine` says, gathers to their vertices, and estimates the error; where
/// `options.accuracy` asks for less error, repeats with more rays or smaller elements until the
/// estimate meets the accuracy or more effort would not help. `solved` has the light of patches
/// and gets the refined mesh, the light of vertices and the seconds of each phase. Throws
/// InputError where light is not finite, Interrupted when progress says stop.
void illuminate_elements(const Scene& scene, const DirectLightSums& direct_light,
                         const SolveOptions& options, SolvedScene& solved, SolveReport* report);

}  // namespace lightwell
