// Pictures of roughness, metal, coat and transparency of glTF's materials.
#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "scene/io/glossy.h"
#include "scene/io/gltf/gltf_materials.h"
#include "scene/io/gltf/gltf_values.h"
#include "scene/io/sheets.h"
#include "scene/material_at.h"

namespace lightwell {
namespace {}  // namespace

std::optional<ShareTexture> GltfMaterials::share_picture(const std::optional<JsonObject>& owner,
                                                         const char* key, int number, float factor,
                                                         const JsonObject& from) {
  const auto info = owner ? owner->object(key) : std::nullopt;
  if (!info || !follows(*info, key, from)) return std::nullopt;
  const auto picture = linear_picture(*info, from);
  if (!picture) return std::nullopt;
  constexpr int alpha = 3;
  if (number == alpha && !picture->alpha) return std::nullopt;
  // Several materials often share a picture.
  std::shared_ptr<const Texture>& shown = channels_[{*info->index("index"), number}];
  if (!shown) shown = number == alpha ? picture->alpha : channel_of(*picture->color, number);
  return ShareTexture{.image = laid_on(*info, shown), .factor = factor};
}

std::optional<Picture> GltfMaterials::linear_picture(const JsonObject& info,
                                                     const JsonObject& from) {
  const auto texture = info.index("index");
  if (!texture) info.fail("lacks the index of a texture");
  const auto known = linear_pictures_.find(*texture);
  if (known != linear_pictures_.end()) return known->second;
  // texture_mean() remarks on pictures that cannot be used.
  std::optional<Picture> picture;
  remarks_.attempt("Pictures that are missing or damaged became a grey of 0.5", from.name(),
                   [&] { picture = file_.texture_picture(*texture, PictureCode::linear, info); });
  return linear_pictures_.emplace(*texture, std::move(picture)).first->second;
}

// Pictures of one material, each empty if it has none that is laid over the surface.
GltfMaterials::SharePictures GltfMaterials::share_pictures(const JsonObject& from,
                                                           float metal_factor) {
  const auto pbr = from.object("pbrMetallicRoughness");
  const auto clear = from.extension("KHR_materials_clearcoat");
  const auto roughness = static_cast<float>(share_or(pbr, "roughnessFactor", 1.0));
  SharePictures pictures{.even_alpha = roughness * roughness, .even_metal = metal_factor};
  constexpr int red = 0, green = 1, blue = 2, alpha = 3;
  // The square of the roughness is GGX's alpha.
  pictures.roughness = share_picture(pbr, "metallicRoughnessTexture", green, roughness, from);
  pictures.metal = share_picture(pbr, "metallicRoughnessTexture", blue, metal_factor, from);
  if (pictures.metal) pictures.even_metal *= pictures.metal->image.picture->mean()[0];
  const auto cover = static_cast<float>(share_or(clear, "clearcoatFactor", 0.0));
  pictures.is_clear_coat = double{cover} >= mostly_clear && pictures.even_metal < least_metallic;
  if (pictures.is_clear_coat) {
    const auto of_coat = static_cast<float>(share_or(clear, "clearcoatRoughnessFactor", 0.0));
    pictures.even_alpha = of_coat * of_coat;
    pictures.coat = share_picture(clear, "clearcoatTexture", red, cover, from);
    pictures.roughness = share_picture(clear, "clearcoatRoughnessTexture", green, of_coat, from);
    pictures.clear_share = pictures.coat ? 1.0f : cover;
  } else {
    pictures.coat = share_picture(from.extension("KHR_materials_specular"), "specularTexture",
                                  alpha, 1.0f, from);
  }
  pictures.translucency = share_picture(from.extension("KHR_materials_diffuse_transmission"),
                                        "diffuseTransmissionTexture", alpha, 1.0f, from);
  if (pictures.roughness) pictures.roughness = squared(*pictures.roughness);
  return pictures;
}

// `base` is the mean colour.
void GltfMaterials::set_pattern_of(const JsonObject& from, const Spectrum& base, bool is_closed,
                                   Material& material) {
  if (from.extension("KHR_materials_pbrSpecularGlossiness") ||
      from.extension("KHR_materials_unlit")) {
    return;
  }
  const SharePictures pictures = share_pictures(from, metal_factor_of(from));
  if (material.dielectric) {
    if (!pictures.roughness) return;
    SurfacePattern of_glass{.mirrored = material.specular};
    of_glass.roughness = pictures.roughness;
    return set_pattern(material, of_glass);
  }
  const bool is_glossy = pictures.roughness
                             ? is_glossy_in_parts(*pictures.roughness)
                             : pictures.even_alpha <= static_cast<float>(glossy_alpha);
  const bool has_metal = is_glossy && double{pictures.even_metal} >= least_metallic;
  const auto texture = base_texture(from);
  const bool varies = is_glossy && (pictures.roughness || pictures.metal || pictures.coat ||
                                    (has_metal && texture));
  if (!varies && !pictures.translucency) return;
  const auto volume = from.extension("KHR_materials_volume");
  const bool is_sheet =
      !is_closed && !((volume ? volume->number_or("thicknessFactor", 0.0) : 0.0) > 0.0);
  const float straight = is_sheet ? static_cast<float>(clear_share(from)) : 0.0f;
  const auto [scattered, hue] = diffusely_passed(from);
  const float most_scattered =
      pictures.translucency
          ? static_cast<float>(share_or(from.extension("KHR_materials_diffuse_transmission"),
                                        "diffuseTransmissionFactor", 0.0))
          : scattered;
  const Spectrum color = texture ? texture->factor : base;
  material.texture = texture;
  SurfacePattern pattern{.translucency = pictures.translucency};
  pattern.base = (1.0f - straight) * color;
  pattern.behind_base = (1.0f - most_scattered) * pattern.base;
  if (!pictures.translucency) pattern.base = pattern.behind_base;
  if (most_scattered > 0.0f) pattern.passed = (1.0f - straight) * most_scattered * hue;
  if (straight > 0.0f) pattern.straight = straight * base;
  pattern.mirrored = Spectrum::Zero(base.size());
  material.coat.reset();
  if (is_glossy) set_gloss(from, pictures, color, has_metal, material, pattern);
  if (pattern.passed.size() > 0 || straight > 0.0f) material.one_sided = false;
  set_pattern(material, pattern);
}

// Coat and metal of a pattern of the diffuse colour `color`.
void GltfMaterials::set_gloss(const JsonObject& from, const SharePictures& pictures,
                              const Spectrum& color, bool has_metal, Material& material,
                              SurfacePattern& pattern) {
  pattern.roughness = pictures.roughness;
  const float share = pictures.roughness ? pictures.roughness->image.picture->mean()[0] : 1.0f;
  material.specular_roughness = roughness_of(double{pictures.even_alpha * share});
  std::optional<CoatLayer> layer = coat_layer(from);
  if (pictures.is_clear_coat) {
    layer = CoatLayer{.share = Spectrum::Constant(color.size(), pictures.clear_share)};
  }
  // An even mixture of metal and paint has no coat, as one without pictures.
  const bool has_paint = pictures.metal ? double{pictures.even_metal} < 1.0 - least_metallic
                                        : double{pictures.even_metal} < least_metallic;
  if (layer && has_paint) {
    material.coat = Coat{.index_of_refraction = layer->index};
    pattern.mirrored = layer->share;
    pattern.coat = pictures.coat;
  }
  if (!has_metal) return;
  pattern.metal = pictures.metal ? *pictures.metal : even_share(pictures.even_metal);
  pattern.metal_color = color;
  pattern.metal_shows_texture = material.texture.has_value();
}

}  // namespace lightwell
