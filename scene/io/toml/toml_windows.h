#pragma once

#include <vector>

#include "scene/io/toml/toml_value.h"
#include "scene/io/window_states.h"

namespace lightwell {

/// Reads [[windows]]. The surfaces of `scene` must be complete; `materials` are those that states
/// may name.
OperatedWindows read_toml_windows(const TomlValue& windows, const Scene& scene,
                                  const std::vector<Material>& materials);

}  // namespace lightwell
