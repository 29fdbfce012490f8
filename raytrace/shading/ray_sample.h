#pragma once

#include <cstdint>

#include "mesh/elements/element_caster.h"
#include "raytrace/pictures/layers.h"
#include "scene/bands.h"
#include "scene/specular.h"

namespace lightwell {

/// Result of tracing a ray.
struct RaySample {
  Spectrum radiance{};  ///< W/(m^2 sr)
  /// Radiance besides, W/(m^2 sr), that a rough surface of one of many samples found by chance (see
  /// RayTree); empty: none.
  Spectrum by_chance{};
  /// Layers that are averaged over a pixel; zero unless RenderOptions::layers has any of the
  /// sampled layers.
  SampledLayers layers = SampledLayers::Zero();
  std::uint64_t fingerprint = 0;  ///< identifies the surfaces seen, see RayTree
  /// A rough mirror or a rough clear surface was met, at first or behind smooth ones. (The light of
  /// coats is a small share of a pixel's.)
  bool sees_gloss = false;
  /// About the variance of the radiance, mean of the bands, by the noise of shadow rays to the sky
  /// and of lights drawn from clusters, (W/(m^2 sr))^2.
  float variance = 0.0f;
  std::int64_t depth_cut = 0;  ///< branches that ended at max_depth
  float cut_weight = 0.0f;     ///< sum over these branches of the largest weight of any band
};

/// The event at each smooth surface of a path: light is reflected or crosses.
struct ChainTurns {
  static constexpr int most = 64;
  std::uint64_t crosses = 0;  ///< bit i: the light crosses surface i
  int count = 0;              ///< surfaces, at most `most`; a longer path has no turns

  bool follows(int i, bool crossing) const { return ((crosses >> i) & 1U) == (crossing ? 1U : 0U); }
};

/// A straight part of a path behind at least one smooth mirror or clear body.
struct SpecularSegment {
  const Ray& ray;           ///< from the last surface on
  double end;               ///< m along the ray to the next surface, infinite without one
  const Spectrum& weight;   ///< share of radiance that reaches the path's beginning
  const Media& media;       ///< bodies that the segment runs in
  std::uint64_t chain = 0;  ///< the same for paths by way of the same surfaces in the same order
  ChainTurns turns{};       ///< what happened at these surfaces
};

}  // namespace lightwell
