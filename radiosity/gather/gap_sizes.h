#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Greatest width of a gap as a share of gap_sizes(). (Elements that were refined in a gap are
/// small, and still larger than the width over which light falls off.)
///
/// Points that are read by themselves, such as probes, are in gaps of up to half of that size, the
/// length of an unrefined element. Light falls off within about the gap's width, so that longer
/// elements show too much of it, and reflect that to and fro: 5 cm below a board of 0.6 m x 1.2 m,
/// half again the light. Vertices with as many gaps would take twice the time in an office.
inline constexpr double widest_gap = 0.15, widest_gap_at_readings = 0.5;

/// Greatest cosine between the normals of surfaces that face each other.
inline constexpr double facing = -0.5;

/// Per element, the size, metres, that the width of a gap is compared with: that of the element's
/// patch, or twice that of its facet where the patch reaches over many smaller facets. The mesh has
/// a vertex at each corner of a facet, so such a patch shows light that varies from facet to facet.
/// (A patch of one facet has two elements along its edge by default, so twice their size.)
std::vector<float> gap_sizes(const PatchMesh& mesh);

}  // namespace lightwell
