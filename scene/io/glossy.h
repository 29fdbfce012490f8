#pragma once

#include <functional>
#include <optional>

#include "scene/bands.h"
#include "scene/scene.h"

namespace lightwell {

/// Largest GGX width alpha of a metal or a highlight that is read as glossy. Rougher metals and
/// highlights are nearly diffuse and are read as diffuse, so that the first pass solves for their
/// light without rays into most of the room.
inline constexpr double glossy_alpha = 0.5;

/// Largest alpha of a surface that is read as smooth: a lobe of a thirtieth of a degree.
inline constexpr double smooth_alpha = 1e-3;

/// Share of metal below which a material counts as a dielectric, which has a coat.
inline constexpr double least_metallic = 0.02;

/// Least share of clear glass in a mixed material that is read as wholly clear. Materials with a
/// smaller share are read as opaque.
inline constexpr double mostly_clear = 0.5;

/// Lays a clear coat over a material whose `reflectance` is that of base and coat together (see
/// Material::coat); arguments as for lay_coat().
void set_coat(Material& material, double index, double alpha, const Spectrum& specular);

/// Lays a clear coat of the index of refraction `index`, [lowest_coat_index, highest_index], and
/// GGX width `alpha` over a material whose `reflectance` and texture are those of the base (see
/// CoatOverBase). The coat mirrors Fresnel's share times `specular`. `saturating` as for
/// CoatOverBase. A sheet that passes light has the coat on both sides.
void lay_coat(Material& material, double index, double alpha, const Spectrum& specular,
              bool saturating = true);
/// The same with another law of what light for even light base and coat send back together, of the
/// base's reflectance.
void lay_coat(Material& material, double index, double alpha, const Spectrum& specular,
              const std::function<Spectrum(const Spectrum&)>& coated);

/// Lays a coat as lay_coat(), but light does not go to and fro below it: rho = (1 - s F_o) base, s
/// the largest of `specular`, as in glTF's materials (fresnel_mix in appendix B of glTF 2.0,
/// KHR_materials_specular, KHR_materials_clearcoat).
void lay_simple_coat(Material& material, double index, double alpha, const Spectrum& specular);

/// GGX width of Phong's highlight cos^n, sqrt(2 / (n + 2)) (Walter et al. 2007).
double alpha_of_exponent(double exponent);

/// Pane without thickness; `tint` is the transmittance of the light that is not reflected.
Dielectric thin_pane(double index, const Spectrum& tint, double alpha = 0.0);

/// Adds a reflected share of light with a lobe of GGX width `alpha`: specular up to glossy_alpha,
/// diffuse beyond.
void add_highlight(Material& material, const Spectrum& share, double alpha);

/// Roughness of a surface of GGX width `alpha`: 0 up to smooth_alpha, at most 1.
float roughness_of(double alpha);

/// True if a twentieth or more of a picture of alpha is at most glossy_alpha. Other surfaces are
/// read as diffuse throughout.
bool is_glossy_in_parts(const ShareTexture& alpha);

/// The square of a picture of shares, such as a roughness whose square is alpha.
ShareTexture squared(const ShareTexture& share);

/// Metal beside a dielectric under a coat, of one base colour; pictures stand in place of numbers.
struct MetalAndPaint {
  Spectrum color{};       ///< [0,1], times the colour of Material::texture
  double index = 1.5;     ///< of the coat
  double alpha = 0.0;     ///< GGX width
  double metallic = 0.0;  ///< [0,1]
  std::optional<ShareTexture> alpha_picture{}, metallic_picture{};
};

/// Gives a material, whose texture is set, the pattern of such a surface; false, without a change,
/// if there is no picture or the surface is not glossy anywhere.
bool set_metal_and_paint(Material& material, const MetalAndPaint& given);

/// Sets a material of one color that is part metal and part diffuse: diffuse reflectance (1 -
/// metallic) color, highlight metallic color. `metallic` in [0,1].
void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha);

}  // namespace lightwell
