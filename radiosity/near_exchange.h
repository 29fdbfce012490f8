#pragma once

#include <functional>

#include "mesh/patch_outline.h"
#include "radiosity/estimated_row.h"
#include "radiosity/row_store.h"
#include "scene/progress.h"

namespace lightwell {

/// Closed forms times fractional visibility for the pairs that a row's rays meet often: those that
/// are near or large.
///
/// Of a row's rays, `all` cross the polygon of another patch from its front, whatever stands
/// between, and `first` of them meet it first. Their ratio estimates the visible part, weighted as
/// the form factor is, so F_ij = (closed form) first / all: exact where nothing stands between, and
/// never noisier than first / rays, the plain count.
class NearExchange {
 public:
  explicit NearExchange(const PatchMesh& mesh);

  /// Standard error of the worst F_ij that remains a count, times the row's rays.
  static constexpr double worst_count_error = 3.32;

  /// What a row says of patch j: how many of its rays cross it, and how many meet it first.
  struct Pair {
    int patch = 0;
    int first = 0, all = 0;
  };

  /// Adds the pairs of a row that was cast with `look_behind`. Returns the standard error of its
  /// worst F_ij, those that remain counts included. Safe to call from many threads.
  double look(int patch, const EstimatedRow& row, std::vector<Pair>& pairs) const;

  /// Takes rows of pairs, kept so that columns below the diagonal are counted. `take(i, row)` gets
  /// the exchange of patch i with patches j > i, one row after another; both ends' counts of a pair
  /// are added.
  void exchange(RecordStore pairs, const Progress& progress,
                const std::function<void(int, std::vector<FormFactor>&)>& take) const;

  const std::vector<PatchOutline>& outlines() const { return outlines_; }

 private:
  Eigen::ArrayXd area_;
  std::vector<PatchOutline> outlines_;
};

}  // namespace lightwell
