#pragma once

#include "scene/bands.h"
#include "scene/scene.h"

namespace lightwell {

/// Largest GGX width alpha of a metal or a highlight that is read as glossy. Rougher ones are read
/// as diffuse, which they nearly are: the first pass then solves for them, and need not follow rays
/// that most of the room may be at the end of.
inline constexpr double glossy_alpha = 0.5;

/// Up to here (a lobe of a thirtieth of a degree) a surface is read as smooth.
inline constexpr double smooth_alpha = 1e-3;

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

/// The same coat over many bases, without a new integral for each.
class Coat {
 public:
  Coat(double index, bool saturating, const Spectrum& specular);
  Spectrum operator()(const Spectrum& rho) const;

 private:
  float outside_, inside_;  // F_o, F_i
  bool saturating_;
  Spectrum specular_;
};

/// Reflectance under diffuse light of a metal of refractive index eta + i k, by Fresnel's equations
/// (Born & Wolf, 14.2). Materials reflect the same at every angle, and light that bounces meets a
/// metal at all of them: a dim one such as tungsten reflects a tenth more than straight on.
Spectrum diffuse_metal_reflectance(const Spectrum& eta, const Spectrum& k);

/// Share of light that crosses a thin pane of this index at normal incidence, reflections between
/// its two faces included: (1 - F) / (1 + F).
double pane_transmittance(double index);

/// A pane without thickness of that index, which passes `tint` of what it does not reflect.
Dielectric thin_pane(double index, const Spectrum& tint, double alpha = 0.0);

/// A share of light that is mirrored with a lobe of that width: glossy, or diffuse beyond
/// glossy_alpha.
void add_highlight(Material& material, const Spectrum& share, double alpha);

/// The roughness of a surface of that alpha: none up to smooth_alpha, at most 1.
float roughness_of(double alpha);

/// What a surface is called that is part metal (share `metallic` of it, [0,1]) and part diffuse, of
/// one color: diffuse below, with the metal as a highlight.
void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha);

}  // namespace lightwell
