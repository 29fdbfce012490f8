#pragma once

#include <functional>
#include <optional>

#include "radiosity/closed_forms/pair_exchange.h"
#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/rows/column_block.h"
#include "radiosity/rows/row_store.h"
#include "radiosity/visibility/pair_shafts.h"
#include "scene/progress.h"

namespace lightwell {

/// Closed forms times fractional visibility for the pairs that a row's rays meet often: those that
/// are near or large.
///
/// Of a row's rays, `all` cross the polygon of another patch from its front, whatever stands
/// between, and `first` of them meet it first. Their ratio estimates the visible part, weighted as
/// the form factor is, so F_ij = (closed form) first / all: exact where nothing stands between, and
/// never noisier than first / rays, the plain count. Where it is noisier than a wanted accuracy and
/// only a few polygons stand between, their shadow is clipped off instead (visible_exchange).
class NearExchange {
 public:
  /// `target_error`: wanted standard error of F_ij; 0: what the rays give.
  NearExchange(const ElementCaster& caster, double target_error);

  /// Rays that a row starts with, times the error wanted: what leaves a count of the fewest rays
  /// that make a closed form worth it uncertain by that error. Larger counts, of patches that are
  /// neither near nor polygons, ask for more.
  static constexpr double worst_count_error = 3.32;

  /// What a row says of patch j: how many of its rays cross it, and how many meet it first.
  struct Pair {
    int patch = 0;
    int first = 0, all = 0;
  };

  /// Adds the pairs of a row that was cast with `count_hidden`. Returns the standard error of its
  /// worst F_ij, those that remain counts included. Safe to call from many threads.
  double find_pairs(int patch, const EstimatedRow& row, std::vector<Pair>& pairs) const;

  /// Takes rows of pairs, kept so that columns below the diagonal are counted. `take(i, row)` gets
  /// the exchange of patch i with patches j > i, one row after another; both ends' counts of a pair
  /// are added. Rows that `phase` holds are not computed again.
  void exchange(RecordStore pairs, const Progress& progress,
                const std::function<void(int, std::vector<FormFactor>&)>& take,
                const JournalPhase& phase = {}) const;

 private:
  bool is_exact_due(int i, int j, double variance, Between& between) const;
  void add_row(const PairExchange& closed_form, int i, RecordSpan row, RecordSpan column,
               std::vector<FormFactor>& exchange) const;

  Eigen::ArrayXd area_;
  double target_error_;
  std::vector<PatchOutline> outlines_;
  std::optional<PairShafts> shafts_;
};

}  // namespace lightwell
