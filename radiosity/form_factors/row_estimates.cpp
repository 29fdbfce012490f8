#include "radiosity/form_factors/row_estimates.h"

#include <cstring>

namespace lightwell {

RowEstimates::RowEstimates(const std::shared_ptr<MemoryBudget>& budget, int patches, int bands)
    : bands_(bands),
      shares_(budget, patches, sizeof(FormFactor), RecordStore::Count::below_diagonal),
      specular_shares_(budget, patches,
                       sizeof(int) + sizeof(float) * static_cast<std::size_t>(bands),
                       RecordStore::Count::below_diagonal),
      inverse_variance_(Eigen::ArrayXd::Zero(patches)),
      escaped_(inverse_variance_),
      specular_(inverse_variance_),
      rays_(inverse_variance_) {}

void RowEstimates::add(int i, const EstimatedRow& row) {
  inverse_variance_[i] = row.inverse_variance;
  escaped_[i] = row.escaped;
  specular_[i] = row.specular;
  rays_[i] = row.rays;
  shares_.append(i, row.shares.data(), row.shares.size());
  const auto any = [](const Spectrum& lost) { return lost.size() > 0 && (lost > 0.0f).any(); };
  if (row.specular > 0.0 || !row.specular_patch.empty() || any(row.specular_escaped) ||
      any(row.absorbed) || any(row.cut)) {
    add_specular(i, row);
  }
}

void RowEstimates::add_specular(int i, const EstimatedRow& row) {
  {
    const std::lock_guard lock(*specular_mutex_);
    if (!has_specular_) {
      has_specular_ = true;
      specular_sum_.setZero(inverse_variance_.size(), bands_);
      specular_escaped_ = absorbed_ = cut_ = BandArray::Zero(inverse_variance_.size(), bands_);
    }
  }
  specular_sum_.row(i) = row.specular_share.cast<double>().colwise().sum();
  specular_escaped_.row(i) = row.specular_escaped.transpose();
  absorbed_.row(i) = row.absorbed.transpose();
  cut_.row(i) = row.cut.transpose();
  const std::size_t record = specular_shares_.record_bytes();
  std::vector<std::byte> records(row.specular_patch.size() * record);
  for (std::size_t r = 0; r < row.specular_patch.size(); ++r) {
    std::byte* const to = records.data() + r * record;
    std::memcpy(to, &row.specular_patch[r], sizeof(int));
    std::memcpy(to + sizeof(int), &row.specular_share(static_cast<Eigen::Index>(r), 0),
                record - sizeof(int));
  }
  specular_shares_.append(i, records.data(), row.specular_patch.size());
}

void RowEstimates::close() {
  shares_.close();
  specular_shares_.close();
}

}  // namespace lightwell
