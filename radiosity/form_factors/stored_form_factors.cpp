#include "radiosity/form_factors/stored_form_factors.h"

#include <cstring>

namespace lightwell {

// A row holds all patches before all values, as SpecularRow needs them.
void StoredFormFactors::append_specular(int i, std::span<const int> patches,
                                        std::span<const float> values) {
  std::vector<std::byte> row(patches.size_bytes() + values.size_bytes());
  if (row.empty()) return;
  std::memcpy(row.data(), patches.data(), patches.size_bytes());
  std::memcpy(row.data() + patches.size_bytes(), values.data(), values.size_bytes());
  specular.append(i, row.data(), patches.size());
}

SpecularRow StoredFormFactors::specular_row(int i) const {
  const RecordSpan row = specular.row(i);
  if (row.size() == 0) return {};
  const auto* const patches = reinterpret_cast<const int*>(row[0]);
  const auto* const values = reinterpret_cast<const float*>(patches + row.size());
  return {.patch = {patches, row.size()},
          .value = Eigen::Map<const BandArray>(values, static_cast<Eigen::Index>(row.size()),
                                               escaped_share.cols())};
}

void StoredFormFactors::release(int i) {
  rows.release(i);
  specular.release(i);
}

}  // namespace lightwell
