#pragma once

#include "radiosity/form_factor_assembly.h"

namespace lightwell {

/// What patches exchange with the emitters that `direct_light` owns, from closed form times
/// visibility averaged over points of the receiving patch. Small and bright, emitters are what
/// sampling finds by chance.
class EmitterExchange {
 public:
  EmitterExchange(const ElementCaster& caster, const DirectLight& direct_light);

  /// Number of the emitter on whose lit side a patch lies; -1: none.
  int emitter_of(int patch) const { return emitter_of_[patch]; }

  /// `receives[i]`: whether patch i takes part in diffuse exchange at all.
  KnownExchange exchange(const std::vector<char>& receives, const FormFactorOptions& options) const;

 private:
  Eigen::ArrayXXd from_points(const std::vector<char>& receives,
                              const FormFactorOptions& options) const;

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  std::vector<int> emitter_of_;
};

}  // namespace lightwell
