#pragma once

#include <mutex>

#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/rows/row_store.h"

namespace lightwell {

/// The estimated rows of all patches: their shares in stores that a memory budget governs, what is
/// one number a row as arrays.
class RowEstimates {
 public:
  RowEstimates(const std::shared_ptr<MemoryBudget>& budget, int patches, int bands);

  /// Row i, at most once. From many threads.
  void add(int i, const EstimatedRow& row);
  void close();

  int patch_count() const { return static_cast<int>(inverse_variance_.size()); }
  int bands() const { return bands_; }
  double inverse_variance(int i) const { return inverse_variance_[i]; }
  bool is_measured(int i) const { return inverse_variance_[i] > 0.0; }
  double escaped(int i) const { return escaped_[i]; }
  double specular(int i) const { return specular_[i]; }  ///< first met a mirror or glass
  double rays(int i) const { return rays_[i]; }

  /// First arrivals: FormFactor records.
  RecordStore& shares() { return shares_; }

  /// Whether any row met mirrors or glass. What follows may be asked for only then.
  bool has_specular() const { return has_specular_; }
  /// Arrivals by way of mirrors and glass: the patch and a float for each band.
  RecordStore& specular_shares() { return specular_shares_; }
  /// Sum of these of row i, per band.
  auto specular_sum(int i) const { return specular_sum_.row(i); }
  auto specular_escaped(int i) const { return specular_escaped_.row(i); }
  auto absorbed(int i) const { return absorbed_.row(i); }
  auto cut(int i) const { return cut_.row(i); }

 private:
  void add_specular(int i, const EstimatedRow& row);

  int bands_ = 0;
  RecordStore shares_, specular_shares_;
  Eigen::ArrayXd inverse_variance_, escaped_, specular_, rays_;
  std::unique_ptr<std::mutex> specular_mutex_ = std::make_unique<std::mutex>();  // to be moved
  bool has_specular_ = false;
  Eigen::ArrayXXd specular_sum_;  // patches x bands, as those below
  BandArray specular_escaped_, absorbed_, cut_;
};

}  // namespace lightwell
