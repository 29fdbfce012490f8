#include "scene/io/interchange/interchange_materials.h"

#include <fmt/format.h>

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/default_material.h"
#include "scene/io/foreign_path.h"
#include "scene/io/glossy.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

// Names of properties, which the library defines in macros of several arguments.
constexpr const char* diffuse_key = "$clr.diffuse";
constexpr const char* specular_key = "$clr.specular";
constexpr const char* specular_factor_key = "$mat.shinpercent";
constexpr const char* exponent_key = "$mat.shininess";
constexpr const char* reflective_key = "$clr.reflective";
constexpr const char* reflectivity_key = "$mat.reflectivity";
constexpr const char* emissive_key = "$clr.emissive";
constexpr const char* opacity_key = "$mat.opacity";
constexpr const char* index_key = "$mat.refracti";

// The kinds of picture that are used, in the library's terms.
constexpr std::initializer_list<aiTextureType> color_pictures = {aiTextureType_DIFFUSE,
                                                                 aiTextureType_BASE_COLOR};
constexpr std::initializer_list<aiTextureType> glow_pictures = {aiTextureType_EMISSIVE,
                                                                aiTextureType_EMISSION_COLOR};
constexpr std::initializer_list<aiTextureType> normal_pictures = {aiTextureType_NORMALS,
                                                                  aiTextureType_NORMAL_CAMERA};
constexpr std::initializer_list<aiTextureType> height_pictures = {aiTextureType_HEIGHT};
constexpr std::initializer_list<aiTextureType> opacity_pictures = {aiTextureType_OPACITY};
constexpr std::initializer_list<aiTextureType> other_pictures = {
    aiTextureType_SPECULAR,         aiTextureType_SHININESS, aiTextureType_REFLECTION,
    aiTextureType_METALNESS,        aiTextureType_LIGHTMAP,  aiTextureType_DISPLACEMENT,
    aiTextureType_DIFFUSE_ROUGHNESS};

std::optional<Spectrum> color_of(const aiMaterial& from, const char* key) {
  aiColor3D color;
  if (from.Get(key, 0, 0, color) != aiReturn_SUCCESS) return std::nullopt;
  Spectrum result(3);
  result << color.r, color.g, color.b;
  if (!result.isFinite().all()) return std::nullopt;
  return result.max(0.0f);
}

std::optional<float> number_of(const aiMaterial& from, const char* key) {
  float value = 0.0f;
  if (from.Get(key, 0, 0, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
  return value;
}

TextureWrap wrap_of(const aiMaterial& from, const char* key, aiTextureType type) {
  int mode = aiTextureMapMode_Wrap;
  from.Get(key, static_cast<unsigned>(type), 0, mode);
  if (mode == aiTextureMapMode_Mirror) return TextureWrap::mirror;
  return mode == aiTextureMapMode_Wrap ? TextureWrap::repeat : TextureWrap::clamp;
}

// The first picture of the material among some types.
std::optional<ImportedPicture> picture_of(const aiMaterial& from,
                                          std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    aiString name;
    if (from.Get(AI_MATKEY_TEXTURE(type, 0), name) != aiReturn_SUCCESS || name.length == 0)
      continue;
    ImportedPicture picture{.name = name.C_Str()};
    from.Get(AI_MATKEY_UVWSRC(type, 0), picture.uv_set);
    picture.image.wrap = {wrap_of(from, _AI_MATKEY_MAPPINGMODE_U_BASE, type),
                          wrap_of(from, _AI_MATKEY_MAPPINGMODE_V_BASE, type)};
    aiUVTransform t;
    from.Get(AI_MATKEY_UVTRANSFORM(type, 0), t);
    if (std::isfinite(t.mScaling.x * t.mScaling.y * t.mTranslation.x * t.mTranslation.y)) {
      // With v upwards v' = s v + t; with v downwards v' = s v + 1 - s - t.
      picture.image.placement << t.mScaling.x, 0.0, t.mTranslation.x, 0.0, t.mScaling.y,
          1.0 - static_cast<double>(t.mScaling.y) - static_cast<double>(t.mTranslation.y);
    }
    return picture;
  }
  return std::nullopt;
}

int first_uv_set(const aiMaterial& from) {
  for (const auto& types :
       {color_pictures, normal_pictures, height_pictures, opacity_pictures, glow_pictures}) {
    if (const auto picture = picture_of(from, types)) return picture->uv_set;
  }
  return 0;
}

}  // namespace

int InterchangeMaterials::of(unsigned number, bool is_closed) {
  const auto [entry, is_new] =
      index_of_.emplace(std::pair(number, is_closed), static_cast<int>(scene_.materials.size()));
  if (!is_new) return entry->second;
  const aiMaterial& from = *file_.scene().mMaterials[number];
  std::string name = from.GetName().C_Str();
  if (name.empty()) name = fmt::format("material {}", number + 1);
  Material material = read(from, name, is_closed);
  // Only glass depends on the body that it covers.
  const auto other = index_of_.find({number, !is_closed});
  if (other != index_of_.end() && !material.dielectric) return entry->second = other->second;
  scene_.materials.push_back(std::move(material));
  return entry->second;
}

int InterchangeMaterials::uv_set(unsigned number) const {
  return first_uv_set(*file_.scene().mMaterials[number]);
}

Material InterchangeMaterials::read(const aiMaterial& from, const std::string& name,
                                    bool is_closed) {
  Material material = default_material(scene_.bands);
  material.name = name;
  if (const auto diffuse = color_of(from, diffuse_key)) {
    if ((*diffuse > 1.0f).any()) remarks_.add("Colours beyond 1 were cut off in", name);
    material.reflectance = diffuse->min(1.0f);
  }
  lay_on_picture(from, material);
  set_mirror(from, material);
  limit_shares(material);
  set_emission(from, material);
  set_relief(from, material);
  set_opacity(from, is_closed, material);
  set_mask(from, material);
  if (picture_of(from, other_pictures)) {
    remarks_.add("Pictures of gloss, metal and height steps were left out in", name);
  }
  return material;
}

// The share `reflectivity` of the surface is a mirror of the colour `reflective`; the rest is
// diffuse. The highlight of Phong's model is no mirror, unless the surface has nothing else.
void InterchangeMaterials::set_mirror(const aiMaterial& from, Material& material) {
  const double exponent = number_of(from, exponent_key).value_or(0.0f);
  const auto reflective = color_of(from, reflective_key);
  const float share = std::clamp(number_of(from, reflectivity_key).value_or(1.0f), 0.0f, 1.0f);
  // Reflectivity is a perfect mirror in COLLADA (1.4.1, 8-50); FBX files mean their gloss.
  const double alpha = file_.is_fbx() && exponent > 0.0 ? alpha_of_exponent(exponent) : 0.0;
  if (reflective && share > 0.0f && (*reflective > 0.0f).any()) {
    scale_shares(Spectrum::Constant(3, 1.0f - share), material);
    add_highlight(material, share * reflective->min(1.0f), alpha);
    return;
  }
  const auto specular = color_of(from, specular_key);
  if (!specular || !(*specular > 0.0f).any()) return;
  const float strength = std::max(number_of(from, specular_factor_key).value_or(1.0f), 0.0f);
  if (!(strength > 0.0f)) return;
  if ((material.reflectance > 0.0f).any()) {
    remarks_.add("Specular colours describe a highlight, no mirror, and were left out in",
                 material.name);
    return;
  }
  add_highlight(material, (file_.is_fbx() ? strength : 1.0f) * specular->min(1.0f),
                exponent > 0.0 ? alpha_of_exponent(exponent) : 0.0);
}

// A picture stands in place of the colour.
void InterchangeMaterials::lay_on_picture(const aiMaterial& from, Material& material) {
  auto named = picture_of(from, color_pictures);
  if (!named) return;
  const auto picture = open(*named, PictureCode::srgb, material.name);
  if (!picture) {
    // A COLLADA material has a picture or a colour.
    if (!file_.is_fbx()) material.reflectance.setConstant(0.5f);
    return;
  }
  const bool is_cut = picture_of(from, opacity_pictures).has_value();
  named->image.picture = picture->shown(is_cut);
  material.texture = {.image = named->image, .factor = Spectrum::Ones(3)};
  material.reflectance = picture->mean_shown(is_cut).cast<float>();
}

void InterchangeMaterials::set_emission(const aiMaterial& from, Material& material) {
  const auto radiance = color_of(from, emissive_key);
  const auto scaled = [](const Spectrum& color) -> Spectrum {
    return static_cast<float>(std::numbers::pi) * color;
  };
  if (radiance) material.emission = scaled(*radiance);
  auto named = picture_of(from, glow_pictures);
  const auto picture = named ? open(*named, PictureCode::srgb, material.name) : std::nullopt;
  if (!picture) return;
  // COLLADA has a picture in place of a colour, and FBX a picture times a factor.
  const bool is_black = !radiance || !(*radiance > 0.0f).any();
  const Spectrum factor = scaled(is_black ? Spectrum(Spectrum::Ones(3)) : *radiance);
  material.emission = factor * picture->mean.color.cast<float>();
  if (!material.is_emitter()) return;
  if (named->uv_set != first_uv_set(from)) {
    return remarks_.add(
        "Pictures of emission with texture coordinates of their own were taken as "
        "their mean in",
        material.name);
  }
  named->image.picture = picture->color;
  material.emission_texture = {.image = named->image, .factor = factor};
}

void InterchangeMaterials::set_relief(const aiMaterial& from, Material& material) {
  auto named = picture_of(from, normal_pictures);
  const bool is_of_normals = named.has_value();
  if (!named) named = picture_of(from, height_pictures);
  if (!named) return;
  if (named->uv_set != first_uv_set(from)) {
    remarks_.add("Relief on a second set of texture coordinates was left out in", material.name);
    return;
  }
  const auto picture = open(*named, PictureCode::linear, material.name);
  if (!picture) return;
  named->image.picture = picture->color;
  material.relief = is_of_normals || shows_normals(*picture->color)
                        ? relief_of_normals(named->image, 1.0)
                        : relief_of_heights(named->image, 1.0, DepthUnit::texel);
}

void InterchangeMaterials::set_opacity(const aiMaterial& from, bool is_closed, Material& material) {
  const float opacity = std::clamp(number_of(from, opacity_key).value_or(1.0f), 0.0f, 1.0f);
  if (opacity >= 1.0f || picture_of(from, opacity_pictures)) return;
  if (material.is_emitter()) {
    return remarks_.add("Lamps let no light through, so the opacity was left out in",
                        material.name);
  }
  if (opacity > 0.0f) return let_through(material, Spectrum::Constant(3, opacity));
  const float index = number_of(from, index_key).value_or(0.0f);
  const bool has_index = index > 1.0f && index <= highest_index;
  // Many programs write a COLLADA transparency of 0 for what is opaque.
  if (!file_.is_fbx() && !has_index) {
    return remarks_.add("An opacity of 0 without an index of refraction was read as 1 in",
                        material.name);
  }
  remarks_.add("Materials of no opacity were read as clear glass", material.name);
  const double used = has_index ? static_cast<double>(index) : 1.5;
  const Spectrum clear = Spectrum::Ones(3);
  Material glass = default_material(scene_.bands);
  glass.name = material.name;
  glass.reflectance.setZero();
  glass.dielectric =
      is_closed ? Dielectric{.index_of_refraction = static_cast<float>(used), .tint = clear}
                : thin_pane(used, clear);
  material = std::move(glass);
}

void InterchangeMaterials::set_mask(const aiMaterial& from, Material& material) {
  auto named = picture_of(from, opacity_pictures);
  if (!named || material.dielectric) return;
  if (material.is_emitter() || named->uv_set != first_uv_set(from)) {
    return remarks_.add(
        "Pictures of opacity were left out on lamps and on a second set of texture "
        "coordinates in",
        material.name);
  }
  const auto picture = open(*named, PictureCode::linear, material.name);
  if (!picture) return;
  named->image.picture = picture->alpha ? picture->alpha : picture->color;
  if (const auto even = even_opacity(*named->image.picture)) {
    return let_through(material, Spectrum::Constant(3, *even));
  }
  material.mask = Mask{.image = named->image};
}

std::optional<Picture> InterchangeMaterials::open(const ImportedPicture& picture, PictureCode code,
                                                  const std::string& material) {
  std::optional<Picture> result;
  remarks_.attempt("Pictures that cannot be read were left out", picture.name, [&] {
    result = read_picture_of(picture, code);
    if (!result) {
      remarks_.add("Pictures that are neither PNG nor JPEG were left out in", material);
    }
  });
  return result;
}

std::optional<Picture> InterchangeMaterials::read_picture_of(const ImportedPicture& picture,
                                                             PictureCode code) {
  if (const aiTexture* inside = file_.scene().GetEmbeddedTexture(picture.name.c_str())) {
    if (inside->mHeight != 0) return std::nullopt;  // bare texels, without a format
    const auto [entry, is_new] = embedded_.emplace(std::pair(picture.name, code), std::nullopt);
    if (is_new) {
      const auto* bytes = reinterpret_cast<const char*>(inside->pcData);
      entry->second = read_picture({bytes, inside->mWidth}, code, picture.name);
    }
    return entry->second;
  }
  if (const auto place = find_foreign_file(scene_.file.parent_path(), picture.name)) {
    return pictures_.picture(*place, code);
  }
  throw InputError(
      fmt::format("'{}' is missing, and no file of this name lies beside the scene", picture.name));
}

}  // namespace lightwell
