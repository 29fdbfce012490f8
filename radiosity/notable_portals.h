#pragma once

#include <memory>
#include <span>

#include "radiosity/illuminate_elements.h"
#include "radiosity/openings/portals.h"

namespace lightwell {

/// The portals, among `sources.openings`, through which light comes that matters for errors (see
/// notable_openings()); null if there are none. `patches` has the light of patches, and
/// `irradiances` is what errors in each part are relative to, W/m^2, the mean of bands. Throws
/// Interrupted when progress says stop.
std::shared_ptr<const Portals> find_notable_portals(const GatherSources& sources,
                                                    const SolvedScene& patches,
                                                    std::span<const double> irradiances,
                                                    const RunControl& run);

}  // namespace lightwell
