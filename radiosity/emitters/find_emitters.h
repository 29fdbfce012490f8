#pragma once

#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/emitter.h"
#include "scene/scene.h"

namespace lightwell {

/// Boundary and holes of a facet, m.
std::vector<Loop> facet_loops(const PolygonMesh& mesh, const Facet& facet);

/// The emitting facets whose light is direct light (see DirectLight), as bright as in `mesh`, in
/// order of falling exitance. `facets` are scene_facets(scene). Pictures of `known` emitters of the
/// same scene are shared instead of made again.
std::vector<Emitter> find_emitters(const Scene& scene, const std::vector<FacetRef>& facets,
                                   const PatchMesh& mesh, std::span<const Emitter> known = {});

}  // namespace lightwell
