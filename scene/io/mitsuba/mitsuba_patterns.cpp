// Pictures of roughness, metal and coat of Mitsuba's BSDFs.
#include <algorithm>
#include <memory>
#include <utility>

#include "scene/io/glossy.h"
#include "scene/io/mitsuba/mitsuba_materials.h"
#include "scene/io/sheets.h"
#include "scene/material_at.h"

namespace lightwell {

std::optional<ShareTexture> MitsubaMaterials::share_picture(const MitsubaNode& bsdf,
                                                            std::string_view property) {
  const auto given = colors_.texture(bsdf, property, Pixels::all);
  if (!given) return std::nullopt;
  SurfaceTexture image = given->texture.image;
  image.picture = first_channel(*image.picture);
  return ShareTexture{.image = std::move(image), .factor = given->texture.factor[0]};
}

double MitsubaMaterials::mean_or(const MitsubaNode& bsdf, std::string_view property,
                                 double otherwise) {
  const auto picture = share_picture(bsdf, property);
  if (!picture) return colors_.number_or(bsdf, property, otherwise);
  return double{picture->factor} * static_cast<double>(picture->image.picture->mean()[0]);
}

// Pictures of `alpha` and of a coat's `specular_reflectance`.
void MitsubaMaterials::vary_gloss(const MitsubaNode& bsdf, Material& material) {
  const auto alpha = bsdf.type.starts_with("rough") ? share_picture(bsdf, "alpha") : std::nullopt;
  const auto coat =
      material.coat ? share_picture(bsdf, "specular_reflectance") : std::optional<ShareTexture>();
  if (!alpha && !coat) return;
  if (!material.dielectric && (!material.mirrors() || (alpha && !is_glossy_in_parts(*alpha)))) {
    return;
  }
  SurfacePattern pattern = pattern_of(material);
  pattern.roughness = alpha;
  if (coat) {
    pattern.coat = coat;
    pattern.mirrored = Spectrum::Ones(material.specular.size());
  }
  set_pattern(material, std::move(pattern));
}

// Pictures of `roughness` and `metallic`; metal has the base colour, `color` times its picture, and
// the rest a coat of the index of refraction `index`.
void MitsubaMaterials::vary_principled(const MitsubaNode& bsdf, const Spectrum& color, double index,
                                       Material& material) {
  MetalAndPaint given{.color = color,
                      .index = index,
                      .metallic = std::clamp(mean_or(bsdf, "metallic", 0.0), 0.0, 1.0),
                      .metallic_picture = share_picture(bsdf, "metallic")};
  const double roughness = std::clamp(mean_or(bsdf, "roughness", 0.5), 0.0, 1.0);
  given.alpha = roughness * roughness;
  if (const auto picture = share_picture(bsdf, "roughness"))
    given.alpha_picture = squared(*picture);
  Material varied = material;
  varied.texture = std::nullopt;
  if (const auto picture = colors_.texture(bsdf, "base_color", Pixels::all)) {
    varied.texture = picture->texture;
  }
  if (set_metal_and_paint(varied, given)) material = varied;
}

}  // namespace lightwell
