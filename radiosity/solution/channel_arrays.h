#pragma once

#include "radiosity/solution/solution.h"

namespace lightwell {

class SolutionArrays;
struct PolyData;

/// Adds the channels of a solution as arrays: names, scales and energies, and the light of channel
/// c with scale 1 as `channel_c_...`. Adds nothing for a solution without channels.
void add_channels(PolyData& data, const RadiositySolution& solution);

/// Reads the channels, if there are any. Precondition: bands and mesh are read. Throws InputError
/// if an array is missing, of another size, or holds values that no channel can have.
void read_channels(const SolutionArrays& in, const PatchMesh& mesh, RadiositySolution& solution);

}  // namespace lightwell
