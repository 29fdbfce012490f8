#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/rows/row_store.h"

namespace lightwell {

/// View factors between the units of a user (facets of a file, parts joined to one), each of one or
/// many patches. Area-weighted sums of form factors for rows I, J of patches:
///
///     F_IJ = sum_{i in I} A_i sum_{j in J} F_ij / A_I.
///
/// The properties of form factors remain: 0 <= F_IJ <= 1, A_I F_IJ = A_J F_JI, and rows sum to 1
/// together with `open` and `blocked`.
struct ViewFactors {
  /// `budget` as in FormFactorOptions.
  explicit ViewFactors(int rows, std::shared_ptr<MemoryBudget> budget = nullptr)
      : area(static_cast<std::size_t>(rows), 0.0),
        open(area),
        blocked(area),
        factors(std::move(budget), rows, RecordStore::Count::below_diagonal) {}

  std::vector<double> area;      ///< A_I, m^2; 0: the row has no patches
  std::vector<double> open;      ///< share that leaves the scene or meets a black back
  std::vector<double> blocked;   ///< share that meets patches of no row
  RowStore<FormFactor> factors;  ///< F_IJ > 0, ordered by J within a row

  int row_count() const { return static_cast<int>(area.size()); }
  std::span<const FormFactor> row(int i) const { return factors.row(i); }
  /// Number of F_IJ > 0.
  std::int64_t entry_count() const { return factors.record_count(); }
  /// Releases all F_IJ; rows are empty afterwards.
  void release_rows() {
    for (int i = 0; i < row_count(); ++i) factors.release(i);
  }
  float factor(int i, int j) const;
};

/// View factors from form factors. `row_of_patch`: row of each patch, 0 to row_count - 1; -1: none.
/// Scenes with mirrors or glass are taken in band 0. Rows of `form_factors` are released on the
/// way, so that memory holds only one of both.
ViewFactors sum_form_factors(FormFactors& form_factors, const PatchMesh& mesh,
                             const std::vector<int>& row_of_patch, int row_count,
                             std::shared_ptr<MemoryBudget> budget = nullptr);

/// max_I |1 - sum_J F_IJ - open_I - blocked_I| over rows with an area.
double closure_error(const ViewFactors& view_factors);

/// max_IJ |A_I F_IJ - A_J F_JI| / min(A_I, A_J).
double reciprocity_error(const ViewFactors& view_factors);

/// Estimated error of the worst F_IJ, for independent errors e_i of the worst F_ij of each patch
/// (row_error of the report) and bounds b_i of the errors of a patch that may all have the same
/// sign (row_bias): max_I sqrt(sum_{i in I} (A_i / A_I)^2 n_i e_i^2) + sum_{i in I} (A_i / A_I)
/// b_i. n_i is the largest number of F_ij > 0 of patch i that belong to the same row. Where rays
/// are counted, n_i e_i^2 is at most the variance of any share of the rays (count_error of the
/// report).
double error_estimate(const FormFactorReport& report, const FormFactors& form_factors,
                      const PatchMesh& mesh, const std::vector<int>& row_of_patch);

/// Area-weighted mean of `open` over all rows.
double mean_open_share(const ViewFactors& view_factors);

}  // namespace lightwell
