#include "scene/io/toml/toml_pictures.h"

#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/material_at.h"
#include "scene/rgb_basis.h"

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
    if (!has_reflectance) material.reflectance = 1.0f - material.specular;
    Laid laid = read_laid(*texture, table_of(*texture, {"file", "wrap", "filter"}),
                          PictureCode::srgb, pictures);
    const bool is_cut = table.has("mask");
    laid.image.picture = laid.picture.shown(is_cut);
    material.texture = {.image = laid.image, .factor = material.reflectance};
    material.reflectance *=
        RgbBasis(bands.bands).reflectance(laid.picture.mean_shown(is_cut).cast<float>());
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

namespace {

// A key of one share or roughness: a picture whose first channel counts, without sRGB's curve.
struct GivenShare {
  TomlValue value;
  std::optional<TomlTable> table{};
  ShareTexture share{};
};

std::optional<GivenShare> read_share(const TomlTable& table, const char* key,
                                     PictureFiles& pictures,
                                     std::initializer_list<const char*> keys = {"file", "wrap",
                                                                                "filter"}) {
  const auto value = table.find(key);
  if (!value) return std::nullopt;
  GivenShare given{.value = *value, .table = table_of(*value, keys)};
  Laid laid = read_laid(*value, given.table, PictureCode::linear, pictures);
  laid.image.picture = first_channel(*laid.picture.color);
  given.share.image = laid.image;
  return given;
}

std::optional<ShareTexture> share_of(const std::optional<GivenShare>& given) {
  return given ? std::optional(given->share) : std::nullopt;
}

// Refuses pictures whose material lacks what they vary.
void check_toml_pattern(const TomlTable& table, const Material& material) {
  const auto refuse = [&](const char* key, bool is_wrong, const char* why) {
    if (const auto value = table.find(key); value && is_wrong) value->fail(why);
  };
  refuse("roughness_texture",
         !material.mirrors() && !material.dielectric && !table.has("metal_texture"),
         "spreads what 'specular', 'coat', 'metal_texture' or 'glass' mirrors; give one, or remove "
         "it");
  refuse("metal_texture", !material.coat && material.mirrors(),
         "says where the surface is bare metal, and 'specular' or 'metal' that all of it mirrors; "
         "give the metal's colour as the key 'reflectance' of 'metal_texture', and remove the "
         "other");
  refuse("coat_texture", !material.coat, "says where a coat lies; give 'coat' too, or remove it");
  refuse("translucent_texture", !material.is_translucent(),
         "multiplies 'translucent'; give that too, or remove it");
  refuse("opacity_texture", material.one_sided,
         "lets light through to the other side, but sides is 'one'; remove one of the two keys");
  for (const char* key : {"metal_texture", "coat_texture", "opacity_texture"}) {
    refuse(key, material.dielectric.has_value(),
           "contradicts 'glass', of which only the roughness varies by a picture; remove one");
  }
  for (const char* other :
       {"radiance", "exitance", "power", "luminance", "luminous_exitance", "lumens"}) {
    refuse("opacity_texture", table.has(other),
           "does not go with an emission: lamps let no light straight through");
  }
}

}  // namespace

void read_toml_pattern(const TomlTable& table, const TomlBands& bands, PictureFiles& pictures,
                       Material& material) {
  if (table
          .present({"roughness_texture", "metal_texture", "coat_texture", "opacity_texture",
                    "translucent_texture"})
          .empty()) {
    return;
  }
  check_toml_pattern(table, material);
  const auto roughness = read_share(table, "roughness_texture", pictures);
  const auto metal =
      read_share(table, "metal_texture", pictures, {"file", "wrap", "filter", "reflectance"});
  ShareTexture alpha;
  if (roughness) {
    float& even =
        material.dielectric ? material.dielectric->roughness : material.specular_roughness;
    alpha = roughness->share;
    alpha.factor = even > 0.0f ? even : 1.0f;
    even = alpha.factor * alpha.image.picture->mean()[0];
  }
  SurfacePattern pattern = pattern_of(material);
  if (roughness) pattern.roughness = alpha;
  if (metal) {
    pattern.metal = metal->share;
    const auto color = metal->table ? metal->table->find("reflectance") : std::nullopt;
    pattern.metal_color =
        color ? read_toml_share(*color, bands) : constant_spectrum(bands.bands, 1.0f);
  }
  pattern.coat = share_of(read_share(table, "coat_texture", pictures));
  pattern.opacity = share_of(read_share(table, "opacity_texture", pictures));
  pattern.translucency = share_of(read_share(table, "translucent_texture", pictures));
  set_pattern(material, pattern, RgbBasis(bands.bands));
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
