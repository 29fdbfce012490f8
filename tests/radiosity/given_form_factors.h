#pragma once

#include <vector>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell::test {

/// Form factors given outright, as matrices: straight ones, and extended ones the same in all
/// bands.
class GivenFormFactors : public FormFactors {
 public:
  explicit GivenFormFactors(const Eigen::ArrayXXd& F, const Eigen::ArrayXXd& specular = {},
                            int bands = 3)
      : rows_(F.rows()), specular_(F.rows()) {
    for (int i = 0; i < F.rows(); ++i) {
      for (int j = 0; j < F.cols(); ++j) {
        if (F(i, j) > 0.0) rows_[i].push_back({j, static_cast<float>(F(i, j))});
        if (specular.size() == 0 || !(specular(i, j) > 0.0)) continue;
        specular_[i].patch.push_back(j);
        specular_[i].value.insert(specular_[i].value.end(), bands,
                                  static_cast<float>(specular(i, j)));
      }
    }
  }
  int patch_count() const override { return static_cast<int>(rows_.size()); }
  std::span<const FormFactor> row(int i) const override { return rows_[i]; }
  SpecularRow specular_row(int i) const override {
    const auto count = static_cast<Eigen::Index>(specular_[i].patch.size());
    if (count == 0) return {};
    const auto bands = static_cast<Eigen::Index>(specular_[i].value.size()) / count;
    return {.patch = specular_[i].patch,
            .value = Eigen::Map<const BandArray>(specular_[i].value.data(), count, bands)};
  }
  Spectrum escaped(int) const override { return Spectrum::Zero(3); }
  Spectrum absorbed_by_specular(int) const override { return Spectrum::Zero(3); }

 private:
  struct Specular {
    std::vector<int> patch{};
    std::vector<float> value{};
  };
  std::vector<std::vector<FormFactor>> rows_;
  std::vector<Specular> specular_;
};

/// The same reflectance and emission in all bands.
inline PatchMesh patches(const Eigen::ArrayXd& area, const Eigen::ArrayXf& rho,
                         const Eigen::ArrayXf& M, int bands = 3) {
  PatchMesh mesh;
  mesh.area = area;
  mesh.reflectance = rho.replicate(1, bands);
  mesh.emission = M.replicate(1, bands);
  return mesh;
}

}  // namespace lightwell::test
