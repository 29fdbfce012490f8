#pragma once

#include "scene/io/lighting_design.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {

/// The [[grids]] of a native file over surfaces of the scene, which are there by now.
std::vector<CalculationGrid> read_toml_grids(const TomlValue& grids, const Scene& scene);

/// Adds watts and luminous height of a [[lamps]] table to the design.
void read_toml_lamp_design(const TomlValue& lamp, LightingDesign& design);

}  // namespace lightwell
