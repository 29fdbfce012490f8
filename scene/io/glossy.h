#pragma once

#include "scene/bands.h"
#include "scene/scene.h"

namespace lightwell {

/// Largest GGX width alpha of a metal or a highlight that is read as glossy. Rougher metals and
/// highlights are nearly diffuse and are read as diffuse, so that the first pass solves for their
/// light without rays into most of the room.
inline constexpr double glossy_alpha = 0.5;

/// Largest alpha of a surface that is read as smooth: a lobe of a thirtieth of a degree.
inline constexpr double smooth_alpha = 1e-3;

/// Least share of clear glass in a mixed material that is read as wholly clear. Materials with a
/// smaller share are read as opaque.
inline constexpr double mostly_clear = 0.5;

/// Reflectance of a smooth dielectric for diffuse light: 2 integral F(cos) cos dcos, [0,1]. `index`
/// > 0 is relative to the outside.
double diffuse_fresnel(double index);

/// Reflectance for diffuse light of a diffuse base rho under a smooth coat of index n, the coat's
/// own reflection times `specular` included (Saunderson 1942): specular F_o + (1 - F_o)(1 - F_i)
/// rho / (1 - rho F_i), at most 1. F_o and F_i are diffuse_fresnel() from outside and from within.
/// With `saturating` false, rho in the denominator is taken as 1, a common simplification.
Spectrum coated_reflectance(const Spectrum& rho, double index, bool saturating,
                            const Spectrum& specular);

/// coated_reflectance() of one coat over many bases: F_o and F_i are integrated once.
class Coat {
 public:
  Coat(double index, bool saturating, const Spectrum& specular);
  Spectrum operator()(const Spectrum& rho) const;

 private:
  float outside_, inside_;  // F_o, F_i
  bool saturating_;
  Spectrum specular_;
};

/// Reflectance of a metal of refractive index eta + i k for diffuse light, by Fresnel's equations
/// (Born & Wolf, 14.2). The diffuse mean is used because a Material reflects the same at every
/// angle: a dim metal such as tungsten reflects a tenth more of diffuse light than at normal
/// incidence.
Spectrum diffuse_metal_reflectance(const Spectrum& eta, const Spectrum& k);

/// Pane without thickness; `tint` is the transmittance of the light that is not reflected.
Dielectric thin_pane(double index, const Spectrum& tint, double alpha = 0.0);

/// Adds a reflected share of light with a lobe of GGX width `alpha`: specular up to glossy_alpha,
/// diffuse beyond.
void add_highlight(Material& material, const Spectrum& share, double alpha);

/// Roughness of a surface of GGX width `alpha`: 0 up to smooth_alpha, at most 1.
float roughness_of(double alpha);

/// Sets a material of one color that is part metal and part diffuse: diffuse reflectance (1 -
/// metallic) color, highlight metallic color. `metallic` in [0,1].
void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha);

}  // namespace lightwell
