#pragma once

#include "scene/bands.h"
#include "scene/scene.h"

namespace lightwell {

/// Largest GGX width alpha of a metal that is read as a perfect mirror: its lobe is then narrower
/// than about 10 degrees. Rougher metals are read as diffuse.
inline constexpr double mirror_alpha = 0.2;

/// Least share of clear glass in a material that is read as wholly clear; the others are opaque.
inline constexpr double mostly_clear = 0.5;

/// Light that a smooth dielectric of this index (> 0, relative to outside) reflects of light that
/// comes from all sides evenly: 2 integral F(cos) cos dcos, [0,1].
double diffuse_fresnel(double index);

/// Light that a diffuse base of reflectance rho under a smooth coat of index n gives back of light
/// that comes from all sides evenly, the coat's own reflection (times `specular`) included:
/// specular F_o + (1 - F_o)(1 - F_i) rho / (1 - rho F_i), F_i from within (Saunderson 1942). With
/// `saturating` false, rho in the denominator is taken as 1, a common simplification.
Spectrum coated_reflectance(const Spectrum& rho, double index, bool saturating,
                            const Spectrum& specular);

/// Reflectance at normal incidence of a metal of refractive index eta + i k (Born & Wolf, 14.2).
Spectrum metal_reflectance(const Spectrum& eta, const Spectrum& k);

/// Share of light that crosses a thin pane of this index at normal incidence, reflections between
/// its two faces included: (1 - F) / (1 + F).
double pane_transmittance(double index);

/// What a surface is called that is part metal (share `metallic` of it, [0,1]) and part diffuse, of
/// one color: diffuse below, a mirror if its `alpha` is at most mirror_alpha.
void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha);

}  // namespace lightwell
