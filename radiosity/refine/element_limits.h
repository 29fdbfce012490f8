#pragma once

#include <cstdint>

#include "mesh/elements/refine_elements.h"
#include "radiosity/refine/refine_options.h"

namespace lightwell {

/// Throws InputError if `mesh` has more elements than `options` allow.
void require_room(const PatchMesh& mesh, const RefineOptions& options);

/// The least area of the leaves that make up the larger half of all area, m^2, one side counted.
/// Leaves of near_facets() alone count: those of a ground of kilometres would let none be split.
double typical_leaf_area(const RefinedElements& elements);

/// RefineOptions::max_elements, or its default for `elements` where none are given; no more than
/// RefineOptions::room.
std::int64_t most_elements(const RefinedElements& elements, const RefineOptions& options);

/// True if RefineOptions::room is what limits most_elements().
bool is_memory_short(const RefinedElements& elements, const RefineOptions& options);

}  // namespace lightwell
