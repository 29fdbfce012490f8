#pragma once

#include <memory>
#include <optional>

#include "scene/bands.h"
#include "scene/texture.h"

namespace lightwell {

class CoatLevels;

/// A picture of one share or width: the number is `factor` times the picture's first channel.
struct ShareTexture {
  SurfaceTexture image{};
  float factor = 1.0f;  ///< [0,1]
};

/// Shares and roughness of a material that vary over facets with UV. At each point the surface is a
/// mixture, by area, of a base under a coat, bare metal, and holes too fine to see:
///
///     rho = o (1 - m) (1 - c A s) ((1 - t) base + t behind_base)      diffuse reflectance
///     tau = o (1 - m) (1 - c A s) t passed                            diffuse transmittance
///     mirrored: o ((1 - m) c s F(angle) + m metal);   straight on: 1 - o + o straight
///
/// with the shares m of metal, c of the coat over the base, o of all that is no hole, and t of
/// translucency, each from a picture or constant; F is the coat's Fresnel reflectance, A its mean
/// for even light (see CoatedBase), and s tints the coat. No sum of shares exceeds 1 if none of
/// `base`, `behind_base` + `passed`, `metal` and s does. The material's own numbers are those for
/// the pictures' means.
struct SurfacePattern {
  std::optional<ShareTexture> roughness{};  ///< GGX alpha of mirror, coat or glass
  std::optional<ShareTexture> metal{};      ///< m; absent: the mirror is as it is, and m 0 in rho
  std::optional<ShareTexture> coat{};       ///< c; absent: 1
  std::optional<ShareTexture> opacity{};    ///< o; absent: 1
  std::optional<ShareTexture> translucency{};  ///< t; absent: 1
  Spectrum base{};                             ///< [0,1], times the colour of Material::texture
  Spectrum behind_base{};  ///< base where all light is translucent, times that colour
  Spectrum passed{};       ///< [0,1]; empty: nothing is translucent
  Spectrum mirrored{};     ///< [0,1]: s of a coat, else what a mirror without pictures of m mirrors
  Spectrum metal_color{};  ///< [0,1]; empty without `metal`
  Spectrum straight{};     ///< [0,1]; empty: nothing but holes passes light straight on
  bool metal_shows_texture = false;  ///< metal_color is times the colour of Material::texture
  /// A and F of the coat at each roughness; null without a coat.
  std::shared_ptr<const CoatLevels> coat_levels{};
};

}  // namespace lightwell
