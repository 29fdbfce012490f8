#pragma once

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// What patches exchange with the emitters that `direct_light` owns, from closed form times
/// visibility averaged over points of the receiving patch. Small and bright, emitters are what
/// sampling finds by chance.
class EmitterExchange {
 public:
  EmitterExchange(const ElementCaster& caster, const DirectLight& direct_light);

  /// Number of the emitter on whose lit side a patch lies; -1: none.
  int emitter_of(int patch) const { return emitter_of_[patch]; }

  /// Computes what row() takes from. `receives[i]`: whether patch i takes part in diffuse exchange
  /// at all. What `phase` holds is not computed again.
  void compute(const std::vector<char>& receives, const FormFactorOptions& options,
               const JournalPhase& phase = {});

  /// Appends S_ij with patches j > i where i or j is an emitter's, j rising.
  void add_row(int i, std::vector<FormFactor>& row) const;

 private:
  double share_of_emitter(int patch) const;
  double between(int i, int j) const;

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  std::vector<int> emitter_of_;
  std::vector<int> lit_;      // patches of emitters, rising
  Eigen::ArrayXXd exchange_;  // (2 e + side, i): from patch i to the front or back of emitter e
};

}  // namespace lightwell
