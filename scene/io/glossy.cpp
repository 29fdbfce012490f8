#include "scene/io/glossy.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "scene/coat.h"
#include "scene/io/sheets.h"
#include "scene/material_at.h"

namespace lightwell {
namespace {

// Replaces the base's reflectance, and that of its picture, by `coated` of it.
void replace_base(Material& material, const std::function<Spectrum(const Spectrum&)>& coated) {
  const Spectrum before = material.reflectance;
  material.reflectance = coated(before);
  if (!material.texture) return;
  if (before.size() != 3) {
    // Colours of a picture are no reflectances of other bands: all of them change as the mean does,
    // which is less than brighter ones would.
    material.texture->factor *=
        (before > 0.0f).select(material.reflectance / before, 0.0f).min(1.0f);
    return;
  }
  const Spectrum factor = material.texture->factor;
  std::shared_ptr<const Texture>& picture = material.texture->image.picture;
  picture = std::make_shared<const Texture>(
      picture->mapped([&](const Eigen::Array3f& texel) -> Eigen::Array3f {
        const Spectrum base = factor * texel;
        return coated(base);
      }));
  material.texture->factor.setOnes();
}

}  // namespace

void set_coat(Material& material, double index, double alpha, const Spectrum& specular) {
  material.coat = Coat{.index_of_refraction = static_cast<float>(index)};
  material.specular = specular;
  material.specular_roughness = roughness_of(alpha);
}

namespace {

using CoatedReflectance = std::function<Spectrum(const Spectrum&)>;

// Replaces the base of a material that has its coat by what `coated` makes of it.
void replace_coated_base(Material& material, const CoatedReflectance& coated) {
  if (material.passes_straight()) material.regular_transmittance *= 1.0f - mean_mirrored(material);
  if (!material.is_translucent()) return replace_base(material, coated);
  // Light on both sides is the sum of light that is alike on both, of which rho + tau returns, and
  // of light that is opposite, of which rho - tau returns.
  const Spectrum tau = material.transmittance;
  const auto half = [&](const Spectrum& base, float sign) -> Spectrum {
    return 0.5f * (coated(base + tau) + sign * coated(base - tau));
  };
  material.transmittance = half(material.reflectance, -1.0f);
  replace_base(material, [&](const Spectrum& base) { return half(base, 1.0f); });
}

}  // namespace

void lay_coat(Material& material, double index, double alpha, const Spectrum& specular,
              bool saturating) {
  set_coat(material, index, alpha, specular);
  const CoatOverBase coat(material, saturating);
  replace_coated_base(material, [&](const Spectrum& base) { return coat.reflectance(base); });
}

void lay_coat(Material& material, double index, double alpha, const Spectrum& specular,
              const CoatedReflectance& coated) {
  set_coat(material, index, alpha, specular);
  // Errors of a law's integrals would let base and coat send back more than arrives.
  const Spectrum most = 1.0f - mean_mirrored(material);
  replace_coated_base(material,
                      [&](const Spectrum& base) -> Spectrum { return coated(base).min(most); });
}

void lay_simple_coat(Material& material, double index, double alpha, const Spectrum& specular) {
  set_coat(material, index, alpha, specular);
  // A coat of less than all of Fresnel's share takes as much less from the base, at every angle.
  const float most = specular.size() > 0 ? specular.maxCoeff() : 0.0f;
  material.coat->cover = most;
  const float passed = 1.0f - most * static_cast<float>(CoatedBase(material).mean_mirrored());
  material.reflectance *= passed;
  material.transmittance *= passed;
  material.regular_transmittance *= passed;
  if (material.texture) material.texture->factor *= passed;
}

double alpha_of_exponent(double exponent) {
  return std::sqrt(2.0 / (exponent + 2.0));
}

Dielectric thin_pane(double index, const Spectrum& tint, double alpha) {
  return {.index_of_refraction = static_cast<float>(index),
          .tint = tint,
          .roughness = roughness_of(alpha),
          .thin = true};
}

float roughness_of(double alpha) {
  return alpha > smooth_alpha ? static_cast<float>(std::min(alpha, 1.0)) : 0.0f;
}

void add_highlight(Material& material, const Spectrum& share, double alpha) {
  if (!(share > 0.0f).any()) return;
  if (alpha > glossy_alpha) {
    material.reflectance += share;
    return;
  }
  material.specular += share;
  material.specular_roughness = roughness_of(alpha);
}

bool is_glossy_in_parts(const ShareTexture& alpha) {
  const Texture& picture = *alpha.image.picture;
  int glossy = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const float here = alpha.factor * picture.texel(0, x, y)[0];
      if (here <= static_cast<float>(glossy_alpha)) ++glossy;
    }
  }
  constexpr double least = 0.05;
  return glossy >= least * picture.width() * picture.height();
}

ShareTexture squared(const ShareTexture& share) {
  const Texture& picture = *share.image.picture;
  std::vector<Texture::Code> texels;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const float texel = picture.texel(0, x, y)[0];
      texels.push_back(Texture::encode(texel * texel));
    }
  }
  ShareTexture result = share;
  result.factor *= share.factor;
  result.image.picture =
      std::make_shared<const Texture>(picture.width(), picture.height(), 1, std::move(texels));
  return result;
}

bool set_metal_and_paint(Material& material, const MetalAndPaint& given) {
  const auto& [color, index, alpha, metallic, alpha_picture, metallic_picture] = given;
  if (!alpha_picture && !metallic_picture) return false;
  if (!(alpha_picture ? is_glossy_in_parts(*alpha_picture) : alpha <= glossy_alpha)) return false;
  const auto mean = [](const std::optional<ShareTexture>& picture, double even) {
    return picture ? static_cast<double>(picture->factor * picture->image.picture->mean()[0])
                   : even;
  };
  SurfacePattern pattern{.roughness = alpha_picture, .base = color, .behind_base = color};
  pattern.mirrored = Spectrum::Zero(color.size());
  material.specular_roughness = roughness_of(mean(alpha_picture, alpha));
  material.coat.reset();
  const double of_metal = mean(metallic_picture, metallic);
  // An even mixture of metal and paint has no coat, as one without pictures.
  if (of_metal < (metallic_picture ? 1.0 - least_metallic : least_metallic)) {
    material.coat = Coat{.index_of_refraction = static_cast<float>(index)};
    pattern.mirrored.setOnes();
  }
  if (of_metal >= least_metallic) {
    pattern.metal = metallic_picture ? *metallic_picture : even_share(static_cast<float>(of_metal));
    pattern.metal_color = color;
    pattern.metal_shows_texture = material.texture.has_value();
  }
  set_pattern(material, std::move(pattern));
  return true;
}

void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha) {
  const Spectrum metal = static_cast<float>(metallic) * color;
  material.reflectance = color - metal;
  material.specular = Spectrum::Zero(color.size());
  add_highlight(material, metal, alpha);
}

}  // namespace lightwell
