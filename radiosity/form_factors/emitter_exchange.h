#pragma once

#include <vector>

#include "mesh/patches/patch_outline.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/journal_phase.h"
#include "scene/sampling.h"

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
  /// Exchange areas S of a patch with rows of lit patches, m^2: FormFactor::patch is the row's
  /// number, 2 e + side of an emitter or own_row_.
  using Row = std::vector<FormFactor>;
  /// The exchange areas that the points of a patch have found, by row.
  class Found;
  void add_point(const SurfacePoint& at, std::uint64_t key, int number, double area,
                 const FormFactorOptions& options, Found& found) const;
  void add_to_patches(int emitter, bool behind, const SurfacePoint& at, double exchange,
                      Found& found) const;
  Row row_of(int patch, const SobolPoints& sobol, const FormFactorOptions& options) const;
  bool recall_rows(const JournalPhase& phase, int block, int begin, int end);
  void turn_over();
  double share_of_emitter(int patch) const;
  int row_of_lit(int patch) const;

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
  std::vector<std::vector<int>> lit_of_row_;  // patches that a row stands for, ascending
  std::vector<Row> from_;  // by patch i: rows 2 e + side of the front or back of emitter e
  std::vector<Row> to_;    // by row: patches i, ascending
};

}  // namespace lightwell
