#pragma once

#include <vector>

#include "radiosity/form_factors/form_factors.h"
#include "validation/cases/case.h"

namespace lightwell {

/// Form factors given outright, as a matrix: three bands, nothing escapes.
class MatrixFormFactors : public FormFactors {
 public:
  explicit MatrixFormFactors(const Eigen::ArrayXXd& F);

  int patch_count() const override { return static_cast<int>(rows_.size()); }
  std::span<const FormFactor> row(int i) const override {
    return rows_[static_cast<std::size_t>(i)];
  }
  SpecularRow specular_row(int) const override { return {}; }
  Spectrum escaped(int) const override { return Spectrum::Zero(3); }
  Spectrum absorbed_by_specular(int) const override { return Spectrum::Zero(3); }

 private:
  std::vector<std::vector<FormFactor>> rows_;
};

/// An enclosure whose form factors are known, one patch for each surface; values are patches x
/// bands.
struct KnownEnclosure {
  Eigen::ArrayXd area{};
  Eigen::ArrayXXd F{};
  BandArray reflectance{}, emission{}, radiosity{};
};

/// Radiosities by every solver beside the known ones.
ComparedValues solve_known_enclosure(const KnownEnclosure& enclosure);

}  // namespace lightwell
