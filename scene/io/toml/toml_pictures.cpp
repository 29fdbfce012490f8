#include "scene/io/toml/toml_pictures.h"

#include <fmt/format.h>

#include "scene/errors.h"

namespace lightwell {
namespace {

// A picture and its placement on surfaces by a table.
struct Laid {
  Picture picture{};
  SurfaceTexture image{};
  std::optional<TomlValue> cutoff{};
};

Laid read_laid(const TomlValue& value, PictureCode code, bool is_mask, PictureFiles& pictures) {
  Laid laid;
  std::optional<TomlValue> file;
  if (value.is_table()) {
    const TomlTable table = is_mask ? value.table({"file", "wrap", "filter", "cutoff"})
                                    : value.table({"file", "wrap", "filter"});
    file = table.require("file");
    if (const auto wrap = table.find("wrap")) {
      const std::string mode = wrap->one_of({"repeat", "mirror", "clamp"});
      laid.image.wrap.fill(mode == "mirror"  ? TextureWrap::mirror
                           : mode == "clamp" ? TextureWrap::clamp
                                             : TextureWrap::repeat);
    }
    if (const auto filter = table.find("filter")) {
      laid.image.is_smooth = filter->one_of({"smooth", "nearest"}) == "smooth";
    }
    laid.cutoff = table.find("cutoff");
  } else {
    file = value;
  }
  const auto path = (value.file().parent_path() / file->name()).lexically_normal();
  std::optional<Picture> picture;
  try {
    picture = pictures.picture(path, code);
  } catch (const InputError& error) {
    file->fail(fmt::format("cannot be used: {}", error.what()));
  }
  if (!picture) {
    file->fail(
        fmt::format("is '{}', which is no PNG or JPEG; save it as one", path.filename().string()));
  }
  laid.picture = std::move(*picture);
  return laid;
}

}  // namespace

void read_toml_pictures(const TomlTable& table, const TomlBands& bands, PictureFiles& pictures,
                        bool has_reflectance, Material& material) {
  if (const auto texture = table.find("texture")) {
    if (material.dielectric) {
      texture->fail("contradicts 'glass': a clear surface has no colour of its own; remove one");
    }
    if (!bands.bands.wavelengths_nm.empty()) {
      texture->fail("is red, green and blue, but the scene's bands are wavelengths; remove it");
    }
    if (!has_reflectance) material.reflectance = Spectrum::Ones(3) - material.specular;
    Laid laid = read_laid(*texture, PictureCode::srgb, false, pictures);
    laid.image.picture = laid.picture.color;
    material.texture = {.image = laid.image, .factor = material.reflectance};
    material.reflectance *= laid.picture.mean.color.cast<float>();
  }
  if (const auto mask = table.find("mask")) {
    for (const char* other :
         {"radiance", "exitance", "power", "luminance", "luminous_exitance", "lumens"}) {
      if (table.has(other)) mask->fail("does not go with an emission: lamps have no holes");
    }
    Laid laid = read_laid(*mask, PictureCode::linear, true, pictures);
    laid.image.picture = laid.picture.alpha ? laid.picture.alpha : laid.picture.color;
    material.mask = Mask{.image = laid.image};
    if (laid.cutoff) {
      constexpr double least = 1e-3;
      material.mask->cutoff = static_cast<float>(laid.cutoff->number_within(least, 1.0));
    }
  }
}

}  // namespace lightwell
