#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// What files hold in place of what is no number.
inline float finite_or_black(float value) {
  return std::isfinite(value) ? value : 0.0f;
}

/// What element_kinds says with every channel on, as it was solved: what one of them lights is lit,
/// even while it is off. Without channels, what it says.
std::vector<ElementKind> kinds_with_all_on(const SolvedScene& solved,
                                           const std::vector<Material>& materials);

/// What is seen outside of the scene; nothing without a sky.
std::optional<BakedSky> bake_sky(const SolvedScene& solved, const Scene& scene);

/// The light of each channel at the mesh's vertices that are listed.
std::vector<BakedChannel> bake_channels(const SolvedScene& solved,
                                        const std::vector<Material>& materials,
                                        const std::vector<int>& mesh_vertex);

}  // namespace lightwell
