#pragma once

#include "radiosity/row_gather.h"

namespace lightwell {

/// B = M + rho F B of a mesh with all its bands side by side.
class RadiositySystem : public RowGather {
 public:
  /// Keeps references to both; `pause` as in RowGather.
  RadiositySystem(const PatchMesh& mesh, const FormFactors& form_factors,
                  std::function<void()> pause = {});

  int patch_count() const { return static_cast<int>(area.size()); }

  const Eigen::ArrayXd& area;  ///< A_i, m^2
  LightVector M, rho;          ///< emission in W/m^2, reflectance

  /// M + rho F B - B: one pass.
  LightVector residual(const LightVector& B) const;
  /// (I - rho F) x: one pass.
  LightVector product(const LightVector& x) const;

  /// How far F is from reciprocal: about the root mean square of A_i F_ij - A_j F_ji over that of
  /// A_i F_ij, in the worst band. Two passes, with random vectors.
  double asymmetry() const;
};

/// sum_i w_i a_i b_i in each lane; added up patch after patch.
LaneArray weighted_dot(const Eigen::ArrayXd& w, const LightVector& a, const LightVector& b);
LaneArray weighted_dot(const LightVector& w, const LightVector& a, const LightVector& b);

}  // namespace lightwell
