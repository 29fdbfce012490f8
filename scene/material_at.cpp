#include "scene/material_at.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "scene/coat.h"

namespace lightwell {
namespace {

// Largest alpha that counts as smooth: a lobe of a thirtieth of a degree.
constexpr float smooth = 1e-3f;

// Value of a picture by `read`, which gives its colour; `otherwise` without a picture.
template <class Read>
float share_by(const std::optional<ShareTexture>& picture, float otherwise, Read&& read) {
  if (!picture) return otherwise;
  const Eigen::Array3f value = read(picture->image);
  return std::clamp(picture->factor * value[0], 0.0f, 1.0f);
}

template <class Read>
float roughness_by(const Material& material, Read&& read) {
  const float even =
      material.dielectric ? material.dielectric->roughness : material.specular_roughness;
  const float alpha = share_by(material.pattern->roughness, even, read);
  return alpha > smooth ? alpha : 0.0f;
}

template <class Read>
PatternValues values_by(const Material& material, const RgbBasis& basis, Read&& read) {
  const SurfacePattern& pattern = *material.pattern;
  const auto share = [&](const std::optional<ShareTexture>& picture, float otherwise) {
    return share_by(picture, otherwise, read);
  };
  PatternValues values;
  if (material.texture) values.color = basis.reflectance(read(material.texture->image));
  values.roughness = roughness_by(material, read);
  values.metal = share(pattern.metal, values.metal);
  values.coat = share(pattern.coat, values.coat);
  values.opacity = share(pattern.opacity, values.opacity);
  values.translucency = share(pattern.translucency, values.translucency);
  return values;
}

// A spectrum times the colour of a picture, if there is one.
Spectrum tinted(const Spectrum& of, const Spectrum& color) {
  return color.size() > 0 ? Spectrum(of * color) : of;
}

// Least and greatest value of a picture of one share.
std::pair<float, float> range_of(const ShareTexture& share) {
  const Texture& picture = *share.image.picture;
  float least = 1.0f;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) least = std::min(least, picture.texel(0, x, y)[0]);
  }
  return {share.factor * least, share.factor * picture.largest()[0]};
}

}  // namespace

PatternValues values_at(const Material& material, const Eigen::Vector2d& uv,
                        const RgbBasis& basis) {
  return values_by(material, basis, [&](const SurfaceTexture& image) { return image.at(uv); });
}

PatternValues values_over(const Material& material, const Eigen::Vector2d& uv,
                          const Eigen::Matrix2d& footprint, const RgbBasis& basis) {
  return values_by(material, basis,
                   [&](const SurfaceTexture& image) { return image.over(uv, footprint); });
}

PatternValues mean_values(const Material& material, const RgbBasis& basis) {
  return values_by(material, basis,
                   [](const SurfaceTexture& image) { return image.picture->mean(); });
}

Material material_at(const Material& material, const PatternValues& values) {
  const SurfacePattern& pattern = *material.pattern;
  const float m = values.metal, c = values.coat, o = values.opacity, t = values.translucency;
  const float alpha = values.roughness;
  Material here{.specular_roughness = alpha,
                .coat = material.coat,
                .metal = material.metal,
                .dielectric = material.dielectric,
                .one_sided = material.one_sided,
                .pattern = material.pattern};
  if (here.dielectric) {
    here.dielectric->roughness = alpha;
    here.reflectance = here.specular = material.specular;
    return here;
  }
  Spectrum under = Spectrum::Constant(pattern.base.size(), o * (1.0f - m));
  if (here.coat) {
    const auto A = static_cast<float>(pattern.coat_levels->at(alpha).mean_mirrored());
    under *= 1.0f - c * A * pattern.mirrored;
    here.coat->cover = c;
  }
  here.reflectance =
      under * tinted((1.0f - t) * pattern.base + t * pattern.behind_base, values.color);
  if (pattern.passed.size() > 0) here.transmittance = t * under * pattern.passed;
  here.specular = (here.coat ? o * (1.0f - m) * c : o) * pattern.mirrored;
  if (pattern.metal) {
    const Spectrum& color = pattern.metal_color;
    const Spectrum metal =
        o * m * (pattern.metal_shows_texture ? tinted(color, values.color) : color);
    if (here.coat) {
      here.coat->bare = metal;
    } else {
      here.specular = metal;
    }
  }
  if (o < 1.0f || pattern.straight.size() > 0) {
    here.regular_transmittance = Spectrum::Constant(pattern.base.size(), 1.0f - o);
    if (pattern.straight.size() > 0) here.regular_transmittance += under * pattern.straight;
  }
  return here;
}

float roughness_at(const Material& material, const Eigen::Vector2d& uv) {
  return roughness_by(material, [&](const SurfaceTexture& image) { return image.at(uv); });
}

std::vector<const ShareTexture*> pictures_of(const SurfacePattern& pattern) {
  std::vector<const ShareTexture*> pictures;
  for (const auto* share : {&pattern.roughness, &pattern.metal, &pattern.coat, &pattern.opacity,
                            &pattern.translucency}) {
    if (share->has_value()) pictures.push_back(&**share);
  }
  return pictures;
}

SurfacePattern pattern_of(const Material& material) {
  SurfacePattern pattern{.passed = material.transmittance,
                         .mirrored = material.specular,
                         .straight = material.regular_transmittance};
  const Spectrum& rho = material.texture ? material.texture->factor : material.reflectance;
  Spectrum under = Spectrum::Ones(rho.size());
  if (material.coat) under -= mean_mirrored(material);
  const auto bare = [&](const Spectrum& share) -> Spectrum {
    return (under > 0.0f).select(share / under, 0.0f).min(1.0f);
  };
  pattern.base = pattern.behind_base = bare(rho);
  if (pattern.passed.size() > 0) pattern.passed = bare(pattern.passed);
  if (pattern.straight.size() > 0) pattern.straight = bare(pattern.straight);
  return pattern;
}

void set_pattern(Material& material, SurfacePattern pattern, const RgbBasis& basis) {
  if (material.coat) {
    std::pair<float, float> range(material.specular_roughness, material.specular_roughness);
    if (pattern.roughness) range = range_of(*pattern.roughness);
    pattern.coat_levels = std::make_shared<const CoatLevels>(material, range.first, range.second);
  }
  material.pattern = std::make_shared<const SurfacePattern>(std::move(pattern));
  PatternValues means = mean_values(material, basis);
  const Material mean = material_at(material, means);
  material.reflectance = mean.reflectance;
  material.transmittance = mean.transmittance;
  material.regular_transmittance = mean.regular_transmittance;
  material.specular = mean.specular;
  material.specular_roughness = mean.specular_roughness;
  material.coat = mean.coat;
  material.dielectric = mean.dielectric;
  if (!material.texture) return;
  means.color = Spectrum();
  material.texture->factor = material_at(material, means).reflectance;
}

}  // namespace lightwell
