#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Diffuse base under a clear coat. Light passes the coat twice, and the more of it the steeper:
///
///     f(in, out) = rho / pi g(theta_in) g(theta_out),   g = (1 - A(theta)) / mean of 1 - A
///
/// A(theta) is the share that the coat mirrors, times the share of the base that it covers, and the
/// mean is that of even light, so rho is the diffuse reflectance for even light (Kelemen &
/// Szirmay-Kalos 2001, "A microfacet based coupled specular-matte BRDF model"). Base and coat
/// together reflect all light where the base is white.
class CoatedBase {
 public:
  /// `material` has a coat of a finite index and roughness; std::invalid_argument otherwise. The
  /// coat of a material with a pattern is one of the pattern's CoatLevels.
  explicit CoatedBase(const Material& material);
  /// A coat between two of the same index that cover all: A is (1 - part) that of `low` plus part
  /// that of `high`.
  CoatedBase(const CoatedBase& low, const CoatedBase& high, double part);

  /// g, >= 0: light that the base gets or gives at `cosine`, [0,1], to the normal, over that at all
  /// angles alike. The mean over the hemisphere, weighted by the cosine, is 1.
  double factor(double cosine) const;
  /// Share of even light that a coat of `specular` 1 mirrors, [0,1].
  double mean_mirrored() const { return mean_; }
  /// This base where the coat covers the share `cover`, [0,1], of the base.
  CoatedBase covering(float cover) const;

 private:
  double mirrored(double cosine) const;

  static constexpr std::size_t steps_ = 64;
  double index_ = 1.5, mean_ = 0.0, cover_ = 1.0;
  /// A at the cosines (i + 0.5) / steps_ of a rough coat; empty: Fresnel's equations.
  std::optional<std::array<float, steps_>> rough_{};
};

/// Bases under a coat of one index whose roughness varies by place, [0,1]: tables at sixteen steps
/// in the root of alpha, between which A is linear.
class CoatLevels {
 public:
  /// `material` has a coat of a finite index; the tables span alpha from `least` to `most`, [0,1].
  CoatLevels(const Material& material, float least, float most);
  /// The base where the coat has the GGX width `alpha`; beyond the span, its end.
  CoatedBase at(float alpha) const;

 private:
  int first_ = 0;
  std::vector<CoatedBase> levels_{};  // at the steps from first_ on, or one for a single alpha
};

/// The coated bases of a scene.
class CoatedBases {
 public:
  explicit CoatedBases(const std::vector<Material>& materials);

  bool empty() const { return empty_; }
  /// The base of a material; null: the material has no coat.
  const CoatedBase* of(int material) const {
    const auto& base = bases_[static_cast<std::size_t>(material)];
    return base ? &*base : nullptr;
  }

 private:
  bool empty_ = true;
  std::vector<std::optional<CoatedBase>> bases_{};
};

/// Share of even light, per band, that a material mirrors: `specular`, with a coat or a metal
/// times the mean of Fresnel's reflectance, and the bare metal beside a coat.
Spectrum mean_mirrored(const Material& material);
/// mean_mirrored() of each material.
std::vector<Spectrum> mean_mirrored(const std::vector<Material>& materials);

/// Diffuse reflectance for even light of a base, rho, under a coat (Saunderson 1942):
///
///     rho = (1 - F_o)(1 - F_i) base / (1 - base F_i),   1 - F_i = (1 - F_o) / n^2
///
/// F_o and F_i are the shares of even light that the coat mirrors from outside and from within.
/// With `saturating` false, `base` in the denominator is taken as 1, a common simplification.
class CoatOverBase {
 public:
  /// `material` has a coat; its reflectance does not matter.
  explicit CoatOverBase(const Material& material, bool saturating = true);
  /// rho for `base`, [0,1].
  Spectrum reflectance(const Spectrum& base) const;

 private:
  float outside_, inside_;  // F_o, F_i
  bool saturating_;
};

}  // namespace lightwell
