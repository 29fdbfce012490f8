#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Diffuse reflectance for even light of a base under a rough coat, of light that microfacets
/// scatter once, as Mitsuba's `roughplastic` has it:
///
///     rho = T T / n^2 base / (1 - base F_i)
///
/// T is the share of even light that enters through the coat, T / n^2 that of even light from the
/// base that leaves, and F_i that which returns to the base. What one microfacet sends to another
/// is lost: T + F_o and T / n^2 + F_i are below 1, and each way to and fro below the coat loses
/// more. White under GGX facets of alpha 0.2 and index 1.5 reflects 0.80 in all (CoatOverBase: 1).
/// Walter et al. 2007, "Microfacet models for refraction through rough surfaces".
class LossyCoat {
 public:
  /// Distribution of the microfacets.
  enum class Facets { ggx, beckmann };

  /// The refractive index is over that before the coat; `alpha` > 0. With `saturating` false,
  /// `base` in the denominator is taken as 1, as CoatOverBase does.
  LossyCoat(double index, double alpha, Facets facets, bool saturating);
  /// rho for `base`, [0,1].
  Spectrum reflectance(const Spectrum& base) const;

 private:
  float twice_passed_, inside_;  // T T / n^2, F_i
  bool saturating_;
};

}  // namespace lightwell
