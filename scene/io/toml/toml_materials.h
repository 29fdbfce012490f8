#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/io/pictures/picture_mean.h"
#include "scene/io/toml/toml_spectra.h"
#include "scene/scene.h"

namespace lightwell {

/// A [materials.NAME] table. Its `power` becomes an exitance once the area is known
/// (spread_power()).
struct TomlMaterial {
  Material material{};
  std::optional<Spectrum> power{};  ///< W per band over all surfaces of the material
};

/// Reads a [materials.NAME] table, pictures through `pictures`. Throws InputError naming file,
/// line, key and remedy, also if reflectance + specular exceed 1 in a band.
TomlMaterial read_toml_material(const TomlValue& value, const std::string& name,
                                const TomlBands& bands, PictureFiles& pictures);

/// Sets the emission of every material given by its power: M = power / area, with both sides
/// counted where both emit. `materials` correspond to the first materials of the scene. Materials
/// that neither a surface nor `others` uses add a note.
void spread_power(const std::vector<TomlMaterial>& materials, std::span<const int> others,
                  Scene& scene);

}  // namespace lightwell
