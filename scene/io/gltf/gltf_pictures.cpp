// Pictures of GltfMaterials: which, where and how they are laid over surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/io/gltf/gltf_materials.h"
#include "scene/io/gltf/gltf_values.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

const char* const unusable_pictures = "Pictures that are missing or damaged became a grey of 0.5";
const char* const unread_pictures = "Textures of a format that is not read became a grey of 0.5";

TextureWrap wrap_of(const JsonObject& sampler, const char* key) {
  constexpr std::size_t repeat = 10497, clamp = 33071, mirror = 33648;
  const std::size_t mode = sampler.index_or(key, repeat);
  if (mode != repeat && mode != clamp && mode != mirror) {
    sampler.fail(fmt::format("has the {} {}, which is none", key, mode));
  }
  return mode == clamp    ? TextureWrap::clamp
         : mode == mirror ? TextureWrap::mirror
                          : TextureWrap::repeat;
}

// KHR_texture_transform: scale, then rotation, then offset. Rotations are counter-clockwise as seen
// with v pointing down.
Eigen::Matrix<double, 2, 3> placement_of(const JsonObject& info) {
  Eigen::Matrix<double, 2, 3> placement = Eigen::Matrix<double, 2, 3>::Identity();
  const auto transform = info.extension("KHR_texture_transform");
  if (!transform) return placement;
  const auto offset = transform->numbers("offset", 2), scale = transform->numbers("scale", 2);
  const double turn = transform->number_or("rotation", 0.0);
  Eigen::Matrix2d linear;
  linear << std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn);
  if (!scale.empty()) linear = linear * Eigen::Vector2d(scale[0], scale[1]).asDiagonal();
  placement.leftCols<2>() = linear;
  if (!offset.empty()) placement.col(2) = Eigen::Vector2d(offset[0], offset[1]);
  return placement;
}

}  // namespace

void GltfMaterials::set_relief(const JsonObject& from, Material& material) {
  const auto info = from.object("normalTexture");
  if (!info) return;
  const auto base = BaseColor(from).info(), emissive = from.object("emissiveTexture");
  const auto& first = base ? base : emissive;
  if (first && coordinates_of(*first) != coordinates_of(*info)) {
    return remarks_.add("Normal maps with texture coordinates of their own were left out",
                        material.name);
  }
  remarks_.attempt("Normal maps that cannot be used were left out", material.name, [&] {
    const auto texture = info->index("index");
    if (!texture) info->fail("lacks the index of a texture");
    const auto picture = file_.texture_picture(*texture, PictureCode::linear, *info);
    if (!picture) info->fail("has a picture of a format that is not read");
    const double scale = info->number_or("scale", 1.0);
    if (!(std::abs(scale) <= most_relief_scale)) {
      info->fail(fmt::format("has the scale {}; give one between {} and {}", scale,
                             -most_relief_scale, most_relief_scale));
    }
    material.relief = relief_of_normals(laid_on(*info, picture->color), scale);
  });
}

std::string GltfMaterials::texture_coordinates(const JsonObject& primitive) const {
  const auto index = primitive.index("material");
  if (!index || *index >= file_.count("materials")) return {};
  return coordinates_of_material(file_.at("materials", *index, primitive));
}

std::string GltfMaterials::coordinates_of_material(const JsonObject& material) const {
  const auto base = BaseColor(material).info();
  auto info = base ? base : material.object("emissiveTexture");
  if (!info) info = material.object("normalTexture");
  const auto try_picture = [&](const std::optional<JsonObject>& owner, const char* key) {
    if (!info && owner) info = owner->object(key);
  };
  try_picture(material.object("pbrMetallicRoughness"), "metallicRoughnessTexture");
  const auto clear_coat = material.extension("KHR_materials_clearcoat");
  try_picture(clear_coat, "clearcoatTexture");
  try_picture(clear_coat, "clearcoatRoughnessTexture");
  try_picture(material.extension("KHR_materials_specular"), "specularTexture");
  try_picture(material.extension("KHR_materials_diffuse_transmission"),
              "diffuseTransmissionTexture");
  return info ? coordinates_of(*info) : std::string();
}

// True if the picture under `key` is laid over surfaces rather than read as its mean.
bool GltfMaterials::follows(const JsonObject& info, std::string_view key,
                            const JsonObject& from) const {
  constexpr std::array<std::string_view, 5> followed = {
      "metallicRoughnessTexture", "specularTexture", "clearcoatTexture",
      "clearcoatRoughnessTexture", "diffuseTransmissionTexture"};
  return std::ranges::find(followed, key) != followed.end() &&
         coordinates_of(info) == coordinates_of_material(from);
}

std::optional<Picture> GltfMaterials::base_picture(const JsonObject& from) {
  const auto info = BaseColor(from).info();
  return info ? color_picture(*info, from) : std::nullopt;
}

// Picture of sRGB colours of a texture's use by the material `from`.
std::optional<Picture> GltfMaterials::color_picture(const JsonObject& info,
                                                    const JsonObject& from) {
  const auto texture = info.index("index");
  if (!texture) info.fail("lacks the index of a texture");
  auto known = color_pictures_.find(*texture);
  if (known == color_pictures_.end()) {
    std::optional<Picture> picture;
    const bool is_sound = remarks_.attempt(unusable_pictures, from.name(), [&] {
      picture = file_.texture_picture(*texture, PictureCode::srgb, info);
    });
    if (is_sound && !picture) remarks_.add(unread_pictures, from.name());
    known = color_pictures_.emplace(*texture, std::move(picture)).first;
  }
  return known->second;
}

SurfaceTexture GltfMaterials::laid_on(const JsonObject& info,
                                      std::shared_ptr<const Texture> picture) const {
  SurfaceTexture image{.picture = std::move(picture), .placement = placement_of(info)};
  const JsonObject& texture = file_.at("textures", info.index_or("index", 0), info);
  if (const auto number = texture.index("sampler")) {
    const JsonObject& sampler = file_.at("samplers", *number, texture);
    image.wrap = {wrap_of(sampler, "wrapS"), wrap_of(sampler, "wrapT")};
    constexpr std::size_t nearest = 9728, linear = 9729;
    image.is_smooth = sampler.index_or("magFilter", linear) != nearest;
  }
  return image;
}

// The base colour's picture and its factor.
std::optional<ReflectanceTexture> GltfMaterials::base_texture(const JsonObject& from) {
  const auto picture = base_picture(from);
  if (!picture) return std::nullopt;
  const BaseColor color_from(from);
  return ReflectanceTexture{
      .image = laid_on(*color_from.info(), picture->shown(is_cut_by_alpha(from))),
      .factor = gltf_color(color_from.owner, color_from.factor, 4).max(0.0f).min(1.0f)};
}

// `material` is the conversion for the uniform colour `base`.
void GltfMaterials::lay_on_picture(const JsonObject& from, const Spectrum& base,
                                   Material& material) {
  const BaseColor color_from(from);
  const auto picture = base_picture(from);
  if (picture && (material.reflectance > 0.0f).any()) {
    const Spectrum factor = gltf_color(color_from.owner, color_from.factor, 4).max(0.0f).min(1.0f);
    const Spectrum diffuse = (base > 0.0f).select(material.reflectance / base, 0.0f);
    material.texture = {.image = laid_on(*color_from.info(), picture->shown(is_cut_by_alpha(from))),
                        .factor = factor * diffuse.min(1.0f)};
  } else if (picture) {
    remarks_.add("Textures were read as their mean colour", material.name);
  }
}

// Alpha below a cutoff cuts holes. Blended alpha lets the share 1 - alpha through, except where a
// picture of alpha cuts holes: most of its texels are then clear or opaque.
void GltfMaterials::cut_by_alpha(const JsonObject& from, Material& material) {
  if (!is_cut_by_alpha(from)) return;
  const BaseColor color_from(from);
  const auto factors =
      color_from.owner ? color_from.owner->numbers(color_from.factor, 4) : std::vector<double>();
  double opacity = factors.empty() ? 1.0 : std::clamp(factors[3], 0.0, 1.0);
  const auto picture = base_picture(from);
  const auto cut = [&](double cutoff) {
    material.mask = Mask{.image = laid_on(*color_from.info(), picture->alpha),
                         .cutoff = static_cast<float>(cutoff)};
  };
  const bool has_picture = picture && picture->alpha;
  if (from.string_or("alphaMode", "OPAQUE") == "MASK") {
    const double cutoff = from.number_or("alphaCutoff", 0.5);
    const bool is_seen = cutoff <= opacity;
    if (is_seen && has_picture && cutoff > 0.0) cut(cutoff / opacity);
    opacity = is_seen ? 1.0 : 0.0;
  } else if (has_picture) {
    const auto even = even_opacity(*picture->alpha);
    if (even && !material.dielectric && !material.is_emitter()) {
      return let_through(material,
                         ShareTexture{.image = laid_on(*color_from.info(), picture->alpha),
                                      .factor = static_cast<float>(opacity)});
    }
    if (even) opacity *= static_cast<double>(*even);
    if (!even) cut(0.5);
  }
  if (!(opacity < 1.0)) return;
  if (material.dielectric) {
    return remarks_.add("Transparency by alpha was left out of glass", material.name);
  }
  let_through(material, Spectrum::Constant(3, static_cast<float>(opacity)));
  material.emission *= static_cast<float>(opacity);
  if (material.emission_texture) material.emission_texture->factor *= static_cast<float>(opacity);
}

PictureMean GltfMaterials::texture_mean(const std::optional<JsonObject>& owner, const char* key,
                                        PictureCode code, const JsonObject& from) {
  PictureMean white;
  white.color.setOnes();
  white.covered_color.setOnes();
  const auto info = owner ? owner->object(key) : std::nullopt;
  if (!info) return white;
  const auto texture = info->index("index");
  if (!texture) info->fail("lacks the index of a texture");
  auto known = textures_.find({*texture, code});
  if (known == textures_.end()) {
    std::optional<PictureMean> mean;
    const bool is_sound = remarks_.attempt(
        unusable_pictures, from.name(), [&] { mean = file_.texture_mean(*texture, code, *info); });
    if (is_sound && !mean) remarks_.add(unread_pictures, from.name());
    known = textures_.emplace(std::pair(*texture, code), mean).first;
  }
  if (known->second) {
    if (!follows(*info, key, from)) {
      remarks_.add("Textures were read as their mean colour", from.name());
    }
    return *known->second;
  }
  white.color.setConstant(0.5);
  white.covered_color.setConstant(0.5);
  return white;
}

}  // namespace lightwell
