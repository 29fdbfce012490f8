#pragma once

#include <filesystem>
#include <map>
#include <utility>

#include "scene/io/lighting_design.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {

/// Reads the [[grids]] of a native file. The surfaces of `scene` must be complete.
std::vector<CalculationGrid> read_toml_grids(const TomlValue& grids, const Scene& scene);

/// Reads the [report] table of a native file.
ReportHeading read_toml_heading(const TomlValue& report);

/// Photometric files by path and lamp set, so that each is read once.
using LuminaireFiles = std::map<std::pair<std::filesystem::path, int>, SharedLuminaireFile>;

/// Appends watts, luminous height and photometric file of a [[lamps]] table to the design.
void read_toml_lamp_design(const TomlValue& lamp, LuminaireFiles& files, LightingDesign& design);

}  // namespace lightwell
