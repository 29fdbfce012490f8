#pragma once

#include <mutex>

#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/rows/row_store.h"

namespace lightwell {

/// The estimated rows of all patches: shares in stores that a memory budget governs, single numbers
/// per row in arrays.
class RowEstimates {
 public:
  RowEstimates(const std::shared_ptr<MemoryBudget>& budget, int patches, int bands);

  /// Adds row i, each at most once. Safe to call from many threads.
  void add(int i, const EstimatedRow& row);
  void close();

  int patch_count() const { return static_cast<int>(inverse_variance_.size()); }
  int bands() const { return bands_; }
  double inverse_variance(int i) const { return inverse_variance_[i]; }
  bool is_measured(int i) const { return inverse_variance_[i] > 0.0; }
  double escaped(int i) const { return escaped_[i]; }
  /// Share that first met a purely specular surface.
  double specular(int i) const { return specular_[i]; }
  double rays(int i) const { return rays_[i]; }

  /// First arrivals, as FormFactor records.
  RecordStore& shares() { return shares_; }

  /// True if any row met mirrors or glass. Precondition of all functions below.
  bool has_specular() const { return has_specular_; }
  /// Arrivals through mirrors and glass: records of the patch and one float per band.
  RecordStore& specular_shares() { return specular_shares_; }
  /// Sum of the specular shares of row i, per band.
  auto specular_sum(int i) const { return specular_sum_.row(i); }
  auto specular_escaped(int i) const { return specular_escaped_.row(i); }
  auto absorbed(int i) const { return absorbed_.row(i); }
  auto cut(int i) const { return cut_.row(i); }

 private:
  void add_specular(int i, const EstimatedRow& row);

  int bands_ = 0;
  RecordStore shares_, specular_shares_;
  Eigen::ArrayXd inverse_variance_, escaped_, specular_, rays_;
  // A mutex on the heap makes the class movable.
  std::unique_ptr<std::mutex> specular_mutex_ = std::make_unique<std::mutex>();
  bool has_specular_ = false;
  Eigen::ArrayXXd specular_sum_;  // patches x bands, as the arrays below
  BandArray specular_escaped_, absorbed_, cut_;
};

}  // namespace lightwell
