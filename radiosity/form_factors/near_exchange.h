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

class Portals;

/// Closed forms times fractional visibility for pairs that many rays of a row meet: near or large
/// patches.
///
/// `all` of a row's rays cross the front of another patch's polygon, whatever stands between, and
/// `first` of them meet that patch first. The ratio estimates the visible share, weighted by the
/// kernel of the form factor:
///
///   F_ij = (closed form) first / all
///
/// The estimate is exact without occluders, and never noisier than the plain count, first / rays.
/// The hidden part is clipped instead (visible_exchange) where the noise exceeds a wanted accuracy
/// and only few polygons stand between.
class NearExchange {
 public:
  /// `target_error`: wanted standard error of F_ij; 0: as the rays give. Pairs on both sides of
  /// `portals` (null: none) are left to the rays that are aimed there: their visible share is too
  /// small to be counted. Keeps the pointer.
  NearExchange(const ElementCaster& caster, double target_error, const Portals* portals = nullptr);

  /// Initial rays of a row times the target error. A count of fewer than `fewest_near_rays` = 12
  /// rays, too few for a closed form, has a standard error of at most sqrt(11) / rays. Larger
  /// counts, of patches that are neither near nor polygons, need more rays.
  static constexpr double worst_count_error = 3.32;

  /// Counts of a row for patch j: rays that cross the patch (`all`), and rays that meet the patch
  /// first.
  struct Pair {
    int patch = 0;
    int first = 0, all = 0;
  };

  /// Adds the pairs of a row that was cast with `count_hidden`. Returns the standard error of the
  /// row's worst F_ij, including those that remain counts. Safe to call from many threads.
  double find_pairs(int patch, const EstimatedRow& row, std::vector<Pair>& pairs) const;

  /// Exchange areas from the rows of pairs. Precondition: `pairs` counts columns below the
  /// diagonal. Counts from both ends of a pair are added. `take(i, row)` gets the exchange of patch
  /// i with patches j > i, row after row. Rows that `phase` holds are recalled.
  void exchange(RecordStore pairs, const Progress& progress,
                const std::function<void(int, std::vector<FormFactor>&)>& take,
                const JournalPhase& phase = {}) const;

 private:
  bool is_exact_due(int i, int j, double variance, Between& between) const;
  void add_row(const PairExchange& closed_form, int i, RecordSpan row, RecordSpan column,
               std::vector<FormFactor>& exchange) const;

  Eigen::ArrayXd area_;
  double target_error_;
  const Portals* portals_;
  std::vector<PatchOutline> outlines_;
  std::optional<PairShafts> shafts_;
};

}  // namespace lightwell
