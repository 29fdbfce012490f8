#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/parts/part_rays.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/scene_parts.h"
#include "scene/scene.h"

namespace lightwell {

/// Sets ScenePart::is_lit_by_cracks. `arrivals` has an entry for each patch.
void mark_lit_by_cracks(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                        const std::vector<PartRayEnds>& arrivals, SceneParts& parts);

}  // namespace lightwell
