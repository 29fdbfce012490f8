#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/rows/row_store.h"

namespace lightwell {

/// View factors between the things a user counts by (facets of a file, parts put together), which
/// may be one patch or many. Area-weighted sums of form factors: for rows I, J of patches
///
///     F_IJ = sum_{i in I} A_i sum_{j in J} F_ij / A_I.
///
/// They keep what form factors keep: 0 <= F_IJ <= 1, A_I F_IJ = A_J F_JI, and rows that add up,
/// with what is open and what is blocked, to 1.
struct ViewFactors {
  /// `budget` as in FormFactorOptions.
  explicit ViewFactors(int rows, std::shared_ptr<MemoryBudget> budget = nullptr)
      : area(static_cast<std::size_t>(rows), 0.0),
        open(area),
        blocked(area),
        factors(std::move(budget), rows, RecordStore::Count::below_diagonal) {}

  std::vector<double> area;      ///< A_I, m^2; 0: nothing is left of that row
  std::vector<double> open;      ///< share that leaves the scene or meets a black back
  std::vector<double> blocked;   ///< share that meets patches of no row
  RowStore<FormFactor> factors;  ///< F_IJ > 0, ordered by J within a row

  int row_count() const { return static_cast<int>(area.size()); }
  std::span<const FormFactor> row(int i) const { return factors.row(i); }
  /// How many F_IJ are above 0.
  std::int64_t entry_count() const { return factors.record_count(); }
  /// Gives up all F_IJ, to make room; rows are empty afterwards.
  void release_rows() {
    for (int i = 0; i < row_count(); ++i) factors.release(i);
  }
  float factor(int i, int j) const;
};

/// `row_of_patch` says for every patch which of `row_count` rows it belongs to, -1: to none.
/// Scenes with mirrors or glass are taken in band 0. Gives up the form factors' rows as it goes, so
/// that the two do not take memory both.
ViewFactors sum_form_factors(FormFactors& form_factors, const PatchMesh& mesh,
                             const std::vector<int>& row_of_patch, int row_count,
                             std::shared_ptr<MemoryBudget> budget = nullptr);

/// max_I |1 - sum_J F_IJ - open_I - blocked_I| over rows with an area.
double closure_error(const ViewFactors& view_factors);

/// max_IJ |A_I F_IJ - A_J F_JI| / min(A_I, A_J).
double reciprocity_error(const ViewFactors& view_factors);

/// Estimated standard error of the worst F_IJ, from e_i, that of the worst F_ij of each patch,
/// errors taken as independent: max_I sqrt(sum_{i in I} (A_i / A_I)^2 n_i e_i^2), n_i the most F_ij
/// > 0 of patch i that belong to one and the same row.
double error_estimate(const std::vector<float>& patch_error, const FormFactors& form_factors,
                      const PatchMesh& mesh, const std::vector<int>& row_of_patch);

/// Area-weighted mean of `open` over all rows.
double mean_open_share(const ViewFactors& view_factors);

}  // namespace lightwell
