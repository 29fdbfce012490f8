#pragma once

#include "radiosity/illuminate_elements.h"

namespace lightwell {

/// The allowed error, relative to the mean irradiance; 0: no accuracy is requested. `patches` has
/// the light of patches.
double target_of(const Scene& scene, const SolveOptions& options, const SolvedScene& patches);

/// Refines, gathers and estimates with rising effort until the accuracy is reached, until more
/// effort would not help, or until the time is up: the work of illuminate_elements() for one
/// accuracy. Throws InputError if light is not finite, Interrupted when progress says stop.
void gather_to_accuracy(const Scene& scene, const GatherSources& sources,
                        const SolveOptions& options, SolvedScene& solved, SolveReport& report);

}  // namespace lightwell
