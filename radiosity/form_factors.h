#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/element_caster.h"
#include "radiosity/direct_light.h"
#include "scene/progress.h"

namespace lightwell {

/// F_ij: share of what leaves patch i that arrives at patch j without meeting anything else.
struct FormFactor {
  int patch = 0;
  float value = 0.0f;
};

/// Light that reaches patch j from i by way of mirrors and clear glass: the extended form factor of
/// Sillion & Puech 1989, one share per band because mirrors and glass may be tinted.
struct SpecularFormFactor {
  int patch = 0;
  Spectrum value{};
};

/// F_ij of a meshed scene, one sparse row per source patch i.
///
/// Guarantees of every implementation: 0 <= F_ij; A_i F_ij = A_j F_ji (reciprocity);
/// sum_j F_ij + escaped_i = 1, where light by way of specular surfaces counts with what it loses
/// there (closure).
class FormFactors {
 public:
  virtual ~FormFactors() = default;
  virtual int patch_count() const = 0;
  virtual std::span<const FormFactor> row(int i) const = 0;
  /// Empty for scenes without mirrors or glass.
  virtual std::span<const SpecularFormFactor> specular_row(int i) const = 0;
  /// Share per band of what leaves patch i that leaves the scene or meets a black back.
  virtual Spectrum escaped(int i) const = 0;
  /// Share per band that mirrors and glass absorb.
  virtual Spectrum absorbed_by_specular(int i) const = 0;
};

struct FormFactorOptions {
  int rays_per_patch = 512;  ///< power of two; noise of the indirect light falls as about 1/rays
  int rays_per_emitter =
      32768;  ///< from small bright emitters, for light thrown by mirrors and glass
  int max_specular_depth = 8;  ///< mirror and glass events along one ray
  ShadowOptions shadows{.min_rays = 4, .max_rays = 16};
  Progress progress{};
};

/// What was measured before closure and reciprocity were enforced.
struct FormFactorReport {
  double seconds = 0.0;
  std::int64_t rays = 0;
  double closure_correction = 0.0;  ///< largest |1 - row sum| before balancing
  double mean_closure_correction = 0.0;
  double closure_error = 0.0;  ///< the same after
  double depth_cut = 0.0;      ///< mean share of a row lost to max_specular_depth
};

/// Ray-cast form factors with closed-form emitters: cosine-distributed, Owen-scrambled rays from
/// points all over a patch (METHODS: Malley 1988; Sobol) for the smooth part; for small bright
/// emitters the closed form times visibility. Both estimates A_i F_ij and A_j F_ji are joined by
/// their variances and the result is balanced by symmetric diagonal scaling (Sinkhorn & Knopp 1967;
/// Knight, Ruiz & Ucar 2014), which keeps reciprocity and brings every row sum to 1.
std::unique_ptr<FormFactors> ray_cast_form_factors(const Scene& scene, const ElementCaster& caster,
                                                   const DirectLight& direct_light,
                                                   const FormFactorOptions& options = {},
                                                   FormFactorReport* report = nullptr);

}  // namespace lightwell
