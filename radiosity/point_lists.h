#pragma once

#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/interpolated_vertices.h"

namespace lightwell {

/// The points of some vertices, with the random numbers that they have among `all`. Keeps
/// references to both.
GatherPoints points_of_vertices(const GatherPoints& all, const std::vector<int>& vertices);

/// One point of each of the `patches`, in the middle. Keeps references to both.
GatherPoints points_on_patches(const PatchMesh& mesh, const std::vector<int>& patches);

/// Direct light at all vertices, W/m^2, vertices x columns; that of the `unread` crumbs is the mean
/// of their records.
BandArray direct_beside(const LitScene& lit, const std::vector<InterpolatedVertex>& unread,
                        const GatherOptions& options);

}  // namespace lightwell
