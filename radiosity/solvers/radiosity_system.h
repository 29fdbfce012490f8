#pragma once

#include <vector>

#include "radiosity/solvers/kept_passes.h"
#include "radiosity/solvers/row_gather.h"

namespace lightwell {

/// The linear system B = M + R F B of a mesh, all bands side by side. R scatters irradiance E to
/// both sides of sheets, (R E)_i = rho_i E_i + tau_i E_behind(i), and is the diagonal of rho where
/// nothing is translucent. With arriving light E0 from elsewhere, M is M + R E0.
///
/// Within a clear body of index n_i all of B, M and E are basic, over n_i^2 (see
/// FormFactors::squared_index), and areas count n_i^2 times: the system is symmetric there, too.
class RadiositySystem : public RowGather {
 public:
  /// Keeps references to mesh and form_factors; `pause` as in RowGather. `arriving` is E0, patches
  /// x bands, or empty.
  RadiositySystem(const PatchMesh& mesh, const FormFactors& form_factors,
                  std::function<void()> pause = {}, const BandArray& arriving = {});

  int patch_count() const { return static_cast<int>(area.size()); }

  const Eigen::ArrayXd squared_index;  ///< n_i^2; empty: 1
  const Eigen::ArrayXd area;           ///< n_i^2 A_i, m^2
  LightVector M, rho;                  ///< emission in W/m^2, reflectance
  LightVector tau;                     ///< diffuse transmittance; empty if nothing is translucent
  LightVector albedo;                  ///< rho + tau: what scatters of even light on both sides

  /// True if light passes sheets diffusely.
  bool is_translucent() const { return tau.size() > 0; }
  /// The patch whose irradiance passes to patch i; -1: none.
  int behind(int i) const { return behind_.empty() ? -1 : behind_[static_cast<std::size_t>(i)]; }
  /// Values of patches, W/m^2, over n_i^2, and the reverse.
  LightVector basic(const BandArray& values) const;
  BandArray without_index(LightVector values) const;
  /// R E.
  LightVector scattered(const LightVector& E) const;

  /// M + R F B - B: one pass.
  LightVector residual(const LightVector& B) const;
  /// (I - R F) x: one pass.
  LightVector product(const LightVector& x) const;

  /// Runs a solver's `pass` over the rows, which overwrites `results`; a kept pass is recalled
  /// instead.
  template <class Pass, class... Results>
  void pass(Pass pass, Results&... results) const {
    if (passes_) {
      passes_->next(pass, results...);
    } else {
      pass();
    }
  }
  /// Keeps all further passes in `passes`, null: none. Keeps the pointer.
  void keep_passes(KeptPasses* passes) { passes_ = passes; }

  /// Deviation of F from reciprocity: approximately the root mean square of A_i F_ij - A_j F_ji
  /// over that of A_i F_ij, in the worst band. Two passes, with random vectors.
  double asymmetry() const;

 private:
  const std::vector<int>& behind_;  // see PatchMesh::behind
  KeptPasses* passes_ = nullptr;
};

/// sum_i w_i a_i b_i per lane, added in the order of patches.
LaneArray weighted_dot(const Eigen::ArrayXd& w, const LightVector& a, const LightVector& b);
LaneArray weighted_dot(const LightVector& w, const LightVector& a, const LightVector& b);

}  // namespace lightwell
