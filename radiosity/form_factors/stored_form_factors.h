#pragma once

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/rows/row_store.h"

namespace lightwell {

/// Form factors stored in full, in stores that a memory budget governs.
class StoredFormFactors final : public FormFactors {
 public:
  StoredFormFactors(const std::shared_ptr<MemoryBudget>& budget, int patches, int bands)
      : rows(budget, patches),
        specular(budget, patches, sizeof(int) + sizeof(float) * static_cast<std::size_t>(bands)),
        escaped_share(BandArray::Zero(patches, bands)),
        absorbed_share(escaped_share) {}

  int patch_count() const override { return rows.row_count(); }
  std::span<const FormFactor> row(int i) const override { return rows.row(i); }
  SpecularRow specular_row(int i) const override;
  Spectrum escaped(int i) const override { return escaped_share.row(i).transpose(); }
  Spectrum absorbed_by_specular(int i) const override { return absorbed_share.row(i).transpose(); }
  Eigen::ArrayXd squared_index() const override { return squared_indices; }
  void release(int i) override;

  /// Adds row i: patches, then values with all bands of a patch together. Safe to call from many
  /// threads.
  void append_specular(int i, std::span<const int> patches, std::span<const float> values);

  RowStore<FormFactor> rows;
  RecordStore specular;
  BandArray escaped_share, absorbed_share;  ///< patches x bands
  Eigen::ArrayXd squared_indices{};         ///< see squared_index()
};

}  // namespace lightwell
