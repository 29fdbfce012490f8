#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// One value per patch and lane: patches x lanes. A lane is a band, or a column of zeros that fills
/// up a SIMD packet.
using LightVector = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One value per lane.
using LaneArray = Eigen::Array<double, 1, Eigen::Dynamic>;

/// Products F B with the rows of F, extended form factors included. One pass serves all bands.
class RowGather {
 public:
  /// Keeps a reference. `bands` is a multiple of those of the rows, whose factors then serve each
  /// set of bands (see solve_columns). `pause` is called repeatedly during a pass and may throw to
  /// end the pass.
  RowGather(const FormFactors& form_factors, int bands, std::function<void()> pause = {});

  int lanes() const { return lanes_; }
  int bands() const { return bands_; }
  bool has_specular_rows() const { return has_specular_; }
  const FormFactors& form_factors() const { return form_factors_; }

  /// E_i = sum_j F_ij B_j of one patch, lanes() values.
  void row(int i, const LightVector& B, double* E) const;
  /// F B, in one pass over the rows, in order, by all threads.
  LightVector all(const LightVector& B) const;

  void pause() const {
    if (pause_) pause_();
  }

  LightVector with_lanes(const BandArray& values) const;
  BandArray without_lanes(const LightVector& values) const;

 private:
  const FormFactors& form_factors_;
  std::function<void()> pause_;
  int bands_ = 0, lanes_ = 0;
  void (*gather_lanes_)(std::span<const FormFactor>, const double* B, int lanes, double* E);
  bool has_specular_ = false;
};

}  // namespace lightwell
