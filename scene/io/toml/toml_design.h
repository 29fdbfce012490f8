#pragma once

#include "scene/io/lighting_design.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {

/// Reads the [[grids]] of a native file. The surfaces of `scene` must be complete.
std::vector<CalculationGrid> read_toml_grids(const TomlValue& grids, const Scene& scene);

/// Appends watts and luminous height of a [[lamps]] table to the design.
void read_toml_lamp_design(const TomlValue& lamp, LightingDesign& design);

}  // namespace lightwell
