#pragma once

#include "mesh/patches/patch_outline.h"
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
  void add_to_patches(int emitter, bool behind, const SurfacePoint& at, double exchange, int patch);
  double between(int i, int j) const;

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  std::vector<char> is_left_to_rays_;  // per emitter
  std::vector<int> emitter_of_;
  std::vector<int> lit_;  // patches of emitters, ascending
  // Patches of emitters that shine by a picture have rows of their own after those of the emitters'
  // sides. By patch; -1: the patch has the row of its emitter's side.
  std::vector<int> own_row_;
  std::vector<std::vector<int>> pictured_;  // by emitter and side, as rows are: patches with a row
  std::vector<PatchOutline> outline_;       // of each patch with a row
  Eigen::ArrayXXd exchange_;  // (2 e + side, i): from patch i to the front or back of emitter e
};

}  // namespace lightwell
