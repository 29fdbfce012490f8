#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/io/pictures/picture_mean.h"
#include "scene/io/spectrum_samples.h"
#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// The [bands] of a native file and their edges in nm.
struct TomlBands {
  Bands bands = rgb_bands();
  BandEdges edges = {{600.0, 700.0}, {500.0, 600.0}, {400.0, 500.0}};
};

/// Reads the [bands] table: kind "rgb", or "spectral" with equally wide bands. Throws InputError.
TomlBands read_toml_bands(const TomlValue& value);

/// Reads an emitted quantity, >= 0: a number, a number for each band, or a spectrum.
Spectrum read_toml_emission(const TomlValue& value, const TomlBands& bands);
/// Reads the key `colour`, whose ratios between bands count alone, of light that is given in
/// lumens; without the key the same in every band.
Spectrum read_toml_colour(const TomlTable& table, const TomlBands& bands);
/// Reads a share in [0,1]: a number, a number for each band, or a spectrum.
Spectrum read_toml_share(const TomlValue& value, const TomlBands& bands);

/// A [materials.NAME] table. Its `power` becomes an exitance once the area is known
/// (spread_power()).
struct TomlMaterial {
  Material material{};
  std::optional<Spectrum> power{};  ///< W per band over all surfaces of the material
  bool power_is_lumens = false;     ///< `power` was given as its lumens
};

/// Reads a [materials.NAME] table, pictures through `pictures`. Throws InputError naming file,
/// line, key and remedy, also if reflectance + specular exceed 1 in a band.
TomlMaterial read_toml_material(const TomlValue& value, const std::string& name,
                                const TomlBands& bands, PictureFiles& pictures);

/// Sets the emission of every material given by its power: M = power / area, with both sides
/// counted where both emit. `materials` correspond to the first materials of the scene. Unused
/// materials add a note.
void spread_power(const std::vector<TomlMaterial>& materials, Scene& scene);

}  // namespace lightwell
