#pragma once

#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solve.h"

namespace lightwell {

/// caustic_irradiance() with the rays and the depth of `options`.
BandArray caustics(const LitScene& lit, const SolveOptions& options);

/// Caustics on elements of even size; vertices of refined elements interpolate them. Refined
/// elements would be too small for the number of rays, and so are those of crumbs.
class EvenCaustics {
 public:
  /// Casts the rays. `base`: with a caster at the base of `elements`, which are split and merged
  /// again.
  EvenCaustics(const LitScene& base, const SolveOptions& options, RefinedElements& elements);

  /// Irradiance at vertices of the elements, W/m^2, vertices x columns of every channel; empty if
  /// the scene has no mirrors or glass.
  BandArray at(const RefinedElements& elements, const std::vector<int>& vertices);

 private:
  BandArray values_{};
  int known_ = 0;  // vertices of the even elements; 0: there are no caustics
};

}  // namespace lightwell
