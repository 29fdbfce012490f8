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

/// Greatest width of a gap between surfaces that absorb the share `absorbed` of light, as a share
/// of the width between others. At each of steps of about the gap's width this share is lost, so
/// that light falls off within the width over the root of the share, by diffusion: between white
/// surfaces light is even, and elements show it. Surfaces that reflect 80 % or less count alike.
double widest_between(double absorbed);

/// Greatest cosine between the normals of surfaces that face each other.
inline constexpr double facing = -0.5;

/// Per element, the size, metres, that the width of a gap is compared with: that of the element's
/// patch, or twice that of its facet where the patch reaches over many smaller facets. The mesh has
/// a vertex at each corner of a facet, so such a patch shows light that varies from facet to facet.
/// (A patch of one facet has two elements along its edge by default, so twice their size.)
std::vector<float> gap_sizes(const PatchMesh& mesh);

/// Per facet, the largest share of light that a side of the facet absorbs or passes in any band.
std::vector<float> facet_absorptances(const PatchMesh& mesh);

}  // namespace lightwell
