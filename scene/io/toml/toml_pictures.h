#pragma once

#include "scene/io/pictures/picture_mean.h"
#include "scene/io/toml/toml_spectra.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {

/// Reads the keys `texture`, `mask` and `relief` of a [materials.NAME] table: a file's name, or a
/// table { file, wrap, filter } (and `cutoff` for a mask; `kind`, `scale` and `depth` for relief).
/// A texture multiplies the material's reflectance, which is 1 unless `has_reflectance`. Throws
/// InputError naming file, line, key and remedy.
void read_toml_pictures(const TomlTable& table, const TomlBands& bands, PictureFiles& pictures,
                        bool has_reflectance, Material& material);

/// Reads the keys `roughness_texture`, `metal_texture`, `coat_texture`, `opacity_texture` and
/// `translucent_texture`: pictures by which the roughness and the shares of `material`, which is
/// complete but for its emission, vary (see SurfacePattern). Throws InputError as
/// read_toml_pictures().
void read_toml_pattern(const TomlTable& table, const TomlBands& bands, PictureFiles& pictures,
                       Material& material);

/// Reads the key `emission_texture`: a picture that multiplies the material's emission, which
/// becomes the mean of the picture. Throws InputError as read_toml_pictures().
void read_toml_emission_texture(const TomlTable& table, const TomlBands& bands,
                                PictureFiles& pictures, Material& material);

}  // namespace lightwell
