#include "scene/io/toml/toml_pictures.h"

#include <fmt/format.h>

#include "scene/errors.h"

namespace lightwell {
namespace {

// A picture and its placement on surfaces by a table.
struct Laid {
  Picture picture{};
  SurfaceTexture image{};
};

// A picture's file, and its placement on surfaces by a table.
struct PlacedPicture {
  std::filesystem::path path{};
  std::optional<TomlValue> file{};
  SurfaceTexture image{};  // without a picture
};

// `value` is the file's name, or `table`.
PlacedPicture read_placement(const TomlValue& value, const std::optional<TomlTable>& table) {
  PlacedPicture placed;
  if (table) {
    placed.file = table->require("file");
    if (const auto wrap = table->find("wrap")) {
      const std::string mode = wrap->one_of({"repeat", "mirror", "clamp"});
      placed.image.wrap.fill(mode == "mirror"  ? TextureWrap::mirror
                             : mode == "clamp" ? TextureWrap::clamp
                                               : TextureWrap::repeat);
    }
    if (const auto filter = table->find("filter")) {
      placed.image.is_smooth = filter->one_of({"smooth", "nearest"}) == "smooth";
    }
  } else {
    placed.file = value;
  }
  placed.path = (value.file().parent_path() / placed.file->name()).lexically_normal();
  return placed;
}

// The picture that `read` finds; `kinds`: the formats that it knows.
template <class Read>
auto read_or_fail(const PlacedPicture& placed, const char* kinds, Read&& read) {
  try {
    if (auto picture = read(placed.path)) return *picture;
  } catch (const InputError& error) {
    placed.file->fail(fmt::format("cannot be used: {}", error.what()));
  }
  placed.file->fail(fmt::format("is '{}', which is no {}; save it as one",
                                placed.path.filename().string(), kinds));
}

Laid read_laid(const TomlValue& value, const std::optional<TomlTable>& table, PictureCode code,
               PictureFiles& pictures) {
  const PlacedPicture placed = read_placement(value, table);
  return {.picture = read_or_fail(
              placed, "PNG or JPEG",
              [&](const std::filesystem::path& path) { return pictures.picture(path, code); }),
          .image = placed.image};
}

// The table of a picture's placement, with further `keys`; empty: `value` is the file's name alone.
std::optional<TomlTable> table_of(const TomlValue& value, std::initializer_list<const char*> keys) {
  if (!value.is_table()) return std::nullopt;
  return value.table(keys);
}

Relief read_relief(const TomlValue& value, PictureFiles& pictures) {
  const auto table = table_of(value, {"file", "wrap", "filter", "kind", "scale", "depth"});
  const auto find = [&](const char* key) { return table ? table->find(key) : std::nullopt; };
  const auto kind = find("kind"), scale = find("scale"), depth = find("depth");
  const bool has_heights = kind && kind->one_of({"normal", "height"}) == "height";
  if (scale && has_heights) {
    scale->fail("goes with kind = \"normal\"; heights have a 'depth' in metres");
  }
  if (depth && !has_heights) {
    depth->fail("goes with kind = \"height\"; slopes of normals are multiplied by a 'scale'");
  }
  if (has_heights && !depth) {
    kind->fail("needs a 'depth', the metres by which white lies above black");
  }
  constexpr double most_depth = 1.0, most_scale = 10.0;
  Laid laid = read_laid(value, table, PictureCode::linear, pictures);
  laid.image.picture = laid.picture.color;
  if (has_heights) {
    return relief_of_heights(laid.image, depth->number_within(-most_depth, most_depth),
                             DepthUnit::metre);
  }
  const double factor = scale ? scale->number_within(-most_scale, most_scale) : 1.0;
  try {
    return relief_of_normals(laid.image, factor);
  } catch (const InputError& error) {
    value.fail(error.what());
  }
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
    Laid laid = read_laid(*texture, table_of(*texture, {"file", "wrap", "filter"}),
                          PictureCode::srgb, pictures);
    laid.image.picture = laid.picture.color;
    material.texture = {.image = laid.image, .factor = material.reflectance};
    material.reflectance *= laid.picture.mean.color.cast<float>();
  }
  if (const auto mask = table.find("mask")) {
    for (const char* other :
         {"radiance", "exitance", "power", "luminance", "luminous_exitance", "lumens"}) {
      if (table.has(other)) mask->fail("does not go with an emission: lamps have no holes");
    }
    const auto mask_table = table_of(*mask, {"file", "wrap", "filter", "cutoff"});
    Laid laid = read_laid(*mask, mask_table, PictureCode::linear, pictures);
    laid.image.picture = laid.picture.alpha ? laid.picture.alpha : laid.picture.color;
    material.mask = Mask{.image = laid.image};
    if (const auto cutoff = mask_table ? mask_table->find("cutoff") : std::nullopt) {
      constexpr double least = 1e-3;
      material.mask->cutoff = static_cast<float>(cutoff->number_within(least, 1.0));
    }
  }
  if (const auto relief = table.find("relief")) material.relief = read_relief(*relief, pictures);
}

void read_toml_emission_texture(const TomlTable& table, const TomlBands& bands,
                                PictureFiles& pictures, Material& material) {
  const auto texture = table.find("emission_texture");
  if (!texture) return;
  if (!bands.bands.wavelengths_nm.empty()) {
    texture->fail("is red, green and blue, but the scene's bands are wavelengths; remove it");
  }
  if (material.dielectric) texture->fail("contradicts 'glass', which does not shine; remove one");
  const PlacedPicture placed =
      read_placement(*texture, table_of(*texture, {"file", "wrap", "filter"}));
  const LightPicture light = read_or_fail(
      placed, "PNG, JPEG, EXR or HDR",
      [&](const std::filesystem::path& path) { return pictures.light(path, PictureCode::srgb); });
  material.emission_texture = {.image = placed.image,
                               .factor = light.brightest * material.emission};
  material.emission_texture->image.picture = light.color;
  material.emission = material.emission_texture->factor;
  material.emission.head<3>() *= light.color->mean();
}

}  // namespace lightwell
