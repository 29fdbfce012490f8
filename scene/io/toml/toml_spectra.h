#pragma once

#include <vector>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/spectrum_file.h"
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
/// Reads the hue of daylight, which the table states by at most one of these keys, grey by default:
/// `color`, an emission; `cct`, of CIE daylight, 4000 to 25 000 K; `spectrum`, the name of a CIE
/// illuminant, "D50", "D55", "D65" or "D75", or a file of a spectrum (.csv or .spdx). RGB bands get
/// the chromaticity of a spectrum (CIE 1931), without what lies outside their gamut.
Spectrum read_toml_daylight_colour(const TomlTable& table, const TomlBands& bands);
/// Hue of a luminaire by the spectra in its file: their powers in the bands, each by the flux of
/// its emitter. Throws InputError at `file` if a spectrum does not cover the bands, or has no light
/// in them.
Spectrum toml_colour_of_spectra(const TomlValue& file, const std::vector<EmitterSpectrum>& spectra,
                                const TomlBands& bands);
/// Reads a share in [0,1]: a number, a number for each band, or a spectrum.
Spectrum read_toml_share(const TomlValue& value, const TomlBands& bands);
/// The same at `key` of a table; without the key `otherwise` in every band.
Spectrum read_toml_share_or(const TomlTable& table, const char* key, const TomlBands& bands,
                            float otherwise);

}  // namespace lightwell
