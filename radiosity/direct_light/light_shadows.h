#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/exact_shadows.h"
#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/emitters/solid_angle_sampler.h"
#include "radiosity/visibility/shadow_rays.h"

namespace lightwell {

/// A light above a point's horizon: its unoccluded F, and the effort to find its visible share.
struct LightShadow {
  const Emitter* emitter = nullptr;    ///< or
  const FreeSource* source = nullptr;  ///< F is then its kernel
  SolidAngleSampler sampler{};
  int index = 0;
  double F = 0.0;
  int channel = 0;
  std::uint64_t key = 0;
  double chance = 1.0;      ///< by which the light was drawn
  int cluster = -1;         ///< see LightSample
  int least = 0, most = 0;  ///< rays
  /// True if the share seen is the sum of the weights of unblocked rays over the expected sum
  /// (expected_weight) in place of the sum of all. The latter has less noise and a bias that falls
  /// with the number of rays: a single one is seen or not, however much its direction weighs.
  bool by_expected_weight = false;
  std::optional<double> share{};  ///< visible; empty: rays are needed
  EmissionTree::View view{};      ///< of an emitter that shines by a picture; else without parts
  /// Mean exitance of what the point sees of the picture; of a source, what it sends to the point.
  Spectrum pictured{};

  bool has_picture() const { return !view.parts.empty(); }
  const Spectrum& light() const {
    if (pictured.size() > 0) return pictured;
    return emitter ? emitter->exitance : source->light;
  }
};

/// Light of an emitter with a picture as a point sees all of it, over the emitter's form factor F.
Spectrum pictured_light(const Emitter& emitter, const EmissionTree::View& view, double F);

/// Decides the rays of lights that a point asks together. `other_light`: by channel, the light of
/// others that it asks, W/m^2, mean of the bands.
void set_effort(std::span<LightShadow> shadows, std::vector<double> other_light,
                const ShadowOptions& options);

/// Finds the visible share of the light's emitter without rays, or else what its rays need.
void find_share(const ExactShadows& exact, const ElementCaster& caster, const SurfacePoint& at,
                LightShadow& shadow);

/// Casts the rays of all lights, and tallies those of each.
std::vector<ShadowTally> cast_shadows(std::span<const LightShadow> shadows,
                                      const ElementCaster& caster, const SobolPoints& sobol,
                                      const SurfacePoint& at, const ShadowMedium& medium);

/// The share of a light that arrives, dimmed light as well, mean of the bands.
double arriving_share(const ShadowTally& tally);

}  // namespace lightwell
