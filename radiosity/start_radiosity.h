#pragma once

#include "radiosity/solve.h"

namespace lightwell {

/// Patch radiosities of a solution, to start the solver of another from. Patches are compared one
/// by one: where they lie, which way they face, their area and surface; elements may differ.
/// Reflectances and emission do not matter. Throws InputError that says what differs.
BandArray start_radiosity(const PatchMesh& mesh, const SolvedScene& start);

/// The same of channels that have the same names in the same order, channels * bands columns; empty
/// if there are none such, or no start. The patches have been compared.
BandArray start_by_channel(const SolvedScene* start, const EmitterChannels& channels);

}  // namespace lightwell
