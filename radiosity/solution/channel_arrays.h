#pragma once

#include "radiosity/solution/solution.h"

class vtkPolyData;

namespace lightwell {

class SolutionArrays;

/// The channels of a solution as arrays of its file: names, scales and energy, and for channel
/// number c its light with scale 1 as `channel_c_...`. Nothing for a solution without channels.
void add_channels(vtkPolyData* poly, const RadiositySolution& solution);

/// Reads them back, if there are any; bands and mesh have been read. Throws InputError if an array
/// is missing, of another size, or holds what no channel can.
void read_channels(const SolutionArrays& in, const PatchMesh& mesh, RadiositySolution& solution);

}  // namespace lightwell
