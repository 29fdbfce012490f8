#pragma once

#include "radiosity/solve.h"

namespace lightwell {

/// Patch radiosities of the solution `start`, patches x bands, W/m^2, from which the solver of
/// another solve begins. Each patch of `start` must have the bounding box, side, area and surface
/// of the patch of `mesh` with the same number; elements, reflectances and emission may differ.
/// Throws InputError that names the first difference, or if a radiosity is not finite.
BandArray start_radiosity(const PatchMesh& mesh, const SolvedScene& start);

/// Patch radiosities of the channels of `start`, patches x (channels * bands), W/m^2. Empty if
/// `start` is null or its channels do not have the names of `channels` in the same order. The
/// patches must be the same (see start_radiosity).
BandArray start_by_channel(const SolvedScene* start, const EmitterChannels& channels);

}  // namespace lightwell
