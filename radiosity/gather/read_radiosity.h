#pragma once

#include <Eigen/Core>
#include <memory>

#include "mesh/elements/element_caster.h"
#include "mesh/elements/pictured_reflectance.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// The part rho E of a radiosity B on sheets with pictures, from B on both of their sides:
///
///     B + B_behind = (rho + tau)(E + E_behind),   B - B_behind = (rho - tau)(E - E_behind)
///
/// Where rho and tau differ by less than a twentieth of their sum, B does not tell the sides apart,
/// and E = E_behind is taken. `radiosity` and the result are vertices x columns, W/m^2; 0 at other
/// vertices; empty if there is no such sheet.
BandArray reflected_by_sheets(const PatchMesh& mesh, const PicturedReflectance& pictures,
                              const BandArray& radiosity);

/// The radiosity that rays of a gather read where they end, by columns: that of a solution, or 1 at
/// a single vertex in each column, which gives the share of each vertex in what a point gathers.
class ReadRadiosity {
 public:
  /// `values` are vertices x columns, W/m^2; keeps references.
  ReadRadiosity(const PatchMesh& mesh, const BandArray& values)
      : mesh_(mesh),
        values_(&values),
        columns_(values.cols()),
        pictures_(std::make_shared<const PicturedReflectance>(mesh)),
        by_sheets_(
            std::make_shared<const BandArray>(reflected_by_sheets(mesh, *pictures_, values))) {}
  /// A column for each vertex and band, the bands of a vertex side by side. Keeps a reference.
  ReadRadiosity(const PatchMesh& mesh, Eigen::Index bands)
      : mesh_(mesh),
        columns_(mesh.vertex_count() * bands),
        bands_(bands),
        pictures_(std::make_shared<const PicturedReflectance>(mesh)) {}

  Eigen::Index columns() const { return columns_; }

  /// Adds `share` times the radiosity at an element's point.
  void add(const ElementHit& hit, double share, Eigen::ArrayXd& sum) const {
    const auto& corners = mesh_.corners[hit.element];
    for (int c = 0; c < mesh_.corner_count(hit.element); ++c) {
      if (!values_) {
        sum.segment(corners[c] * bands_, bands_) += share * double{hit.weights[c]};
        continue;
      }
      const float* B = values_->data() + corners[c] * columns_;
      for (Eigen::Index k = 0; k < columns_; ++k) {
        sum[k] += share * static_cast<double>(hit.weights[c] * B[k]);
      }
    }
  }

  /// Adds `share` times the radiosity where a ray ends that stands for `solid_angle`, sr. Pictures
  /// count as they are there (see PicturedReflectance).
  void add_seen(const Ray& ray, const ElementHit& hit, double solid_angle, double share,
                Eigen::ArrayXd& sum) const {
    if (!pictures_->varies(hit.element)) {
      add(hit, share, sum);
      if (!is_pictured_sheet(hit)) return;
      const Spectrum even = Spectrum::Constant(mesh_.reflectance.cols(), static_cast<float>(share));
      return add_picture_of_sheet(ray, hit, solid_angle, even, sum);
    }
    add(hit, Spectrum(static_cast<float>(share) * pictures_->factor(ray, hit, solid_angle)), sum);
  }

  /// The same, with a share per band.
  void add_seen(const Ray& ray, const ElementHit& hit, double solid_angle, const Spectrum& share,
                Eigen::ArrayXd& sum) const {
    if (!pictures_->varies(hit.element)) {
      add(hit, share, sum);
      if (is_pictured_sheet(hit)) add_picture_of_sheet(ray, hit, solid_angle, share, sum);
      return;
    }
    add(hit, Spectrum(share * pictures_->factor(ray, hit, solid_angle)), sum);
  }

  /// Adds the radiosity at an element's point times the share of each band.
  void add(const ElementHit& hit, const Spectrum& share, Eigen::ArrayXd& sum) const {
    const Eigen::Index bands = share.size();
    const auto& corners = mesh_.corners[hit.element];
    const int count = mesh_.corner_count(hit.element);
    if (!values_) {
      for (int c = 0; c < count; ++c) {
        sum.segment(corners[c] * bands, bands) += (hit.weights[c] * share).cast<double>();
      }
      return;
    }
    add_interpolated(*values_, hit, share, sum);
  }

 private:
  void add_interpolated(const BandArray& values, const ElementHit& hit, const Spectrum& share,
                        Eigen::ArrayXd& sum) const {
    const Eigen::Index bands = share.size();
    const auto& corners = mesh_.corners[hit.element];
    const int count = mesh_.corner_count(hit.element);
    for (Eigen::Index k = 0; k < columns_; k += bands) {
      Spectrum B = Spectrum::Zero(bands);
      for (int c = 0; c < count; ++c) {
        B += hit.weights[c] * values.row(corners[c]).segment(k, bands).transpose();
      }
      sum.segment(k, bands) += (share * B).cast<double>();
    }
  }

  bool is_pictured_sheet(const ElementHit& hit) const {
    return by_sheets_ && by_sheets_->size() > 0 && pictures_->varies_on_sheet(hit.element);
  }

  // Adds what a sheet's picture reflects at a hit beyond its mean in the interpolated radiosity.
  void add_picture_of_sheet(const Ray& ray, const ElementHit& hit, double solid_angle,
                            const Spectrum& share, Eigen::ArrayXd& sum) const {
    const Spectrum beyond = pictures_->factor(ray, hit, solid_angle) - 1.0f;
    add_interpolated(*by_sheets_, hit, share * beyond, sum);
  }

  const PatchMesh& mesh_;
  const BandArray* values_ = nullptr;  // null: 1 at a single vertex
  Eigen::Index columns_ = 0, bands_ = 0;
  std::shared_ptr<const PicturedReflectance> pictures_;
  std::shared_ptr<const BandArray> by_sheets_{};  // reflected_by_sheets(); null: none
};

}  // namespace lightwell
