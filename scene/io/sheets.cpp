#include "scene/io/sheets.h"

#include <memory>
#include <utility>
#include <vector>

#include "scene/material_at.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

// Adds to a share that may be empty.
void add_share(const Spectrum& share, Spectrum& sum) {
  if (!(share > 0.0f).any()) return;
  if (sum.size() == 0) {
    sum = share;
  } else {
    sum += share;
  }
}

}  // namespace

void add_diffuse_transmittance(Material& material, const Spectrum& share) {
  add_share(share, material.transmittance);
  if (material.is_translucent()) material.one_sided = false;
}

void add_regular_transmittance(Material& material, const Spectrum& share) {
  add_share(share, material.regular_transmittance);
  if (material.passes_straight()) material.one_sided = false;
}

void add_transmittance(Material& material, const Spectrum& share, double alpha) {
  if (alpha > straight_alpha) {
    add_diffuse_transmittance(material, share);
  } else {
    add_regular_transmittance(material, share);
  }
}

void add_passed(const Material& part, float weight, Material& sum) {
  if (part.is_translucent()) add_diffuse_transmittance(sum, weight * part.transmittance);
  if (part.passes_straight()) add_regular_transmittance(sum, weight * part.regular_transmittance);
}

void scale_shares(const Spectrum& factor, Material& material) {
  for (Spectrum* share : {&material.reflectance, &material.specular, &material.transmittance,
                          &material.regular_transmittance}) {
    if (share->size() > 0) *share *= factor;
  }
  if (material.texture) material.texture->factor *= factor;
}

void limit_shares(Material& material) {
  scale_shares(mean_sent_on(material).max(1.0f).inverse(), material);
}

void let_through(Material& material, const Spectrum& opacity) {
  if ((opacity >= 1.0f).all()) return;
  if (material.pattern) return let_through(material, even_share(opacity.mean()));
  scale_shares(opacity, material);
  add_regular_transmittance(material, 1.0f - opacity);
}

void let_through(Material& material, const ShareTexture& opacity) {
  SurfacePattern pattern = material.pattern ? *material.pattern : pattern_of(material);
  const float already = pattern.opacity && pattern.opacity->image.picture->level_count() == 1
                            ? pattern.opacity->factor
                            : 1.0f;
  pattern.opacity = opacity;
  pattern.opacity->factor *= already;
  material.one_sided = false;
  set_pattern(material, std::move(pattern));
}

ShareTexture even_share(float share) {
  const SurfaceTexture image{
      .picture = std::make_shared<const Texture>(1, 1, 1, std::vector{Texture::encode(1.0f)})};
  return {.image = image, .factor = share};
}

std::optional<float> even_opacity(const Texture& opacity) {
  constexpr float least = 0.1f, most = 0.9f;  // of texels that are neither clear nor opaque
  std::size_t between = 0;
  for (int y = 0; y < opacity.height(); ++y) {
    for (int x = 0; x < opacity.width(); ++x) {
      const float texel = opacity.texel(0, x, y)[0];
      if (texel > least && texel < most) ++between;
    }
  }
  const auto all =
      static_cast<std::size_t>(opacity.width()) * static_cast<std::size_t>(opacity.height());
  if (2 * between < all) return std::nullopt;
  return opacity.mean()[0];
}

bool close_lamp(Material& material) {
  if (!material.is_emitter() || !material.passes_straight()) return false;
  material.regular_transmittance = {};
  return true;
}

}  // namespace lightwell
