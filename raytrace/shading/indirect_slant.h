#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solution/solution.h"
#include "scene/scene.h"

namespace lightwell {

/// Directions that a solution's indirect light comes from, for relief: at a vertex (vertices x 3,
/// in the rest pose)
///
///     s = int L (w - (w . n) n) dw / int L (w . n) dw,
///
/// so that a slope of the gradient h gets 1 - h . s of the surface's light. 0 at vertices of facets
/// without relief; empty if no facet has any. Rays from the middle of each element read the
/// solution; they come in pairs that lie opposite about the normal, so even light has no slant,
/// without noise.
BandArray indirect_slant(const Scene& scene, const ElementCaster& caster,
                         const DirectLight& direct_light, const RadiositySolution& solution,
                         int max_specular_depth);

}  // namespace lightwell
