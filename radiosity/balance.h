#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// Sparse matrix by rows; row i is [first[i], first[i+1]) of column and value, columns rising.
struct SparseRows {
  std::vector<std::int64_t> first{};
  std::vector<int> column{};
  std::vector<float> value{};
  int rows() const { return static_cast<int>(first.size()) - 1; }
};

struct SymmetricEntry {
  int i = 0, j = 0;  ///< different
  double value = 0.0;
};

/// The n x n matrix that has each entry at (i, j) and (j, i). Entries of one place replace those
/// before them.
SparseRows symmetric_rows(int n, std::span<const SymmetricEntry> entries);

/// Scale factors d > 0 with sum_j d_i S_ij d_j + d_i open_i = target_i for a symmetric S >= 0: the
/// symmetric scaling of Sinkhorn & Knopp 1967 in the square-root form of Knight, Ruiz & Ucar 2014.
/// Rows with nothing in them, or with target <= 0, keep d = 1 or go to 0 and are not counted in the
/// error. Ends when every row is within `tolerance` (relative) or after `max_iterations`.
Eigen::ArrayXd symmetric_scaling(const SparseRows& S, const Eigen::ArrayXd& open,
                                 const Eigen::ArrayXd& target, double tolerance = 1e-8,
                                 int max_iterations = 200);

}  // namespace lightwell
