#pragma once

#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "scene/io/lighting_design.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {

/// Reads the tables [[grids]], [[areas]], [maintenance], [energy] and [report] that a document has,
/// in place of those of `design`. The surfaces and cameras of `scene` must be complete.
void read_toml_design(const TomlValue& document, const Scene& scene, LightingDesign& design);

/// Returns the surfaces that a pattern, or an array of patterns, names by their own names or by
/// those of their materials: indices into Scene::surfaces, rising. Throws InputError for a pattern
/// that matches nothing, and for an empty array.
std::vector<int> matching_surfaces(const TomlValue& patterns, const Scene& scene);

/// Photometric files by path and lamp set, so that each is read once.
using LuminaireFiles = std::map<std::pair<std::filesystem::path, int>, SharedLuminaireFile>;

/// Appends watts, luminous height and photometric file of a [[lamps]] table to the design.
void read_toml_lamp_design(const TomlValue& lamp, LuminaireFiles& files, LightingDesign& design);

}  // namespace lightwell
