#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// One value per patch and band, as solvers compute with them: patches x lanes. A lane is a band,
/// or, so that processors can take several at once, one that is 0 throughout.
using LightVector = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One value per lane.
using LaneArray = Eigen::Array<double, 1, Eigen::Dynamic>;

/// Products F B with the rows of F, extended form factors included: one pass serves all bands.
class RowGather {
 public:
  /// Keeps a reference. `pause` is called now and then during a pass and may throw, which ends it.
  RowGather(const FormFactors& form_factors, int bands, std::function<void()> pause = {});

  int lanes() const { return lanes_; }
  int bands() const { return bands_; }
  bool has_specular_rows() const { return has_specular_; }
  const FormFactors& form_factors() const { return form_factors_; }

  /// E_i = sum_j F_ij B_j of one patch, lanes() values.
  void row(int i, const LightVector& B, double* E) const;
  /// F B: one pass over the rows, in order, by all threads.
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
  void (*gather_packet_)(std::span<const FormFactor>, const double*, double*);
  bool has_specular_ = false;
};

}  // namespace lightwell
