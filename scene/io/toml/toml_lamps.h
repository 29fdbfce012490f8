#pragma once

#include "scene/io/toml/toml_projectors.h"
#include "scene/io/toml/toml_spectra.h"
#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds the lamp of the `number`th [[lamps]] table to the scene. Paths of photometric files and
/// pictures are relative to the scene file.
void read_toml_lamp(const TomlValue& value, std::size_t number, const TomlBands& bands,
                    TomlProjectors& projectors, Scene& scene);

}  // namespace lightwell
