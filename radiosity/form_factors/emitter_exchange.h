#pragma once

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Exchange areas of patches with the emitters that `direct_light` owns: closed form times
/// visibility, averaged over points of the receiving patch. Rays hit small bright emitters only by
/// chance. Emitters above a quarter of all area are left to rays.
class EmitterExchange {
 public:
  EmitterExchange(const ElementCaster& caster, const DirectLight& direct_light);

  /// Emitter on whose lit side the patch lies; -1: none.
  int emitter_of(int patch) const { return emitter_of_[patch]; }

  /// Computes the exchange areas for add_row(). `receives[i]`: patch i takes part in diffuse
  /// exchange. Slices that `phase` holds are recalled.
  void compute(const std::vector<char>& receives, const FormFactorOptions& options,
               const JournalPhase& phase = {});

  /// Appends S_ij with patches j > i where i or j belongs to an emitter, in ascending order of j.
  void add_row(int i, std::vector<FormFactor>& row) const;

 private:
  double share_of_emitter(int patch) const;
  double between(int i, int j) const;

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  std::vector<char> is_left_to_rays_;  // per emitter
  std::vector<int> emitter_of_;
  std::vector<int> lit_;      // patches of emitters, ascending
  Eigen::ArrayXXd exchange_;  // (2 e + side, i): from patch i to the front or back of emitter e
};

}  // namespace lightwell
