#pragma once

#include <memory>
#include <vector>

#include "radiosity/journal/run_control.h"
#include "radiosity/openings/portals.h"

namespace lightwell {

/// find_openings(), whose edges the processes of the run share. No journal keeps them.
std::vector<Opening> find_openings(const Scene& scene, const RunControl& run);

/// narrow_openings(), whose openings the processes of the run share. No journal keeps the result.
std::vector<Opening> narrow_openings(const ElementCaster& caster, std::vector<Opening> openings,
                                     const RunControl& run);

/// find_portals(), with narrow openings that the processes of the run find together.
std::shared_ptr<const Portals> find_portals(const ElementCaster& caster,
                                            const std::vector<float>& brightness,
                                            const std::vector<Opening>& openings,
                                            const RunControl& run);

}  // namespace lightwell
