#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/rows/memory_budget.h"
#include "scene/progress.h"

namespace lightwell {

/// F_ij: share of what leaves patch i that arrives at patch j without meeting anything else.
struct FormFactor {
  int patch = 0;
  float value = 0.0f;
};

/// Light that reaches other patches from patch i by way of mirrors and clear glass: the extended
/// form factors of Sillion & Puech 1989, a share per band because mirrors and glass may be tinted.
struct SpecularRow {
  std::span<const int> patch{};
  Eigen::Map<const BandArray> value{nullptr, 0, 0};  ///< entries x bands
};

/// F_ij of a meshed scene, one sparse row per source patch i, ordered by j.
///
/// Every implementation keeps 0 <= F_ij, reciprocity A_i F_ij = A_j F_ji, and closure: what row(i)
/// and specular_row(i) add up to, together with escaped(i) and absorbed_by_specular(i), is 1 in
/// every band (a surface that both mirrors and scatters counts in row(i) and passes its mirrored
/// share on).
class FormFactors {
 public:
  virtual ~FormFactors() = default;
  virtual int patch_count() const = 0;
  virtual std::span<const FormFactor> row(int i) const = 0;
  virtual SpecularRow specular_row(int i) const = 0;  ///< empty without mirrors or glass
  /// Share per band of what leaves patch i that leaves the scene or meets a black back.
  virtual Spectrum escaped(int i) const = 0;
  /// Share per band that mirrors and glass take up on the way.
  virtual Spectrum absorbed_by_specular(int i) const = 0;
  /// Row i is not needed any more: its memory may go to something else, and it may be empty now.
  virtual void release([[maybe_unused]] int i) {}
};

/// How form factors are found. All keep the promises of FormFactors.
enum class FormFactorMethod {
  /// Rays, and closed forms times fractional visibility where patches are near, large or bright.
  automatic,
  /// Cosine-distributed rays from all over each patch (Malley's method), counted where they end.
  ray_cast,
  /// Item buffers on half a cube about each patch's centre (Cohen & Greenberg 1985).
  hemicube,
  /// The closed form of every pair of polygons (Lambert; Schroeder & Hanrahan 1993) times their
  /// visibility: exact where few polygons stand between, else sampled by shadow rays. Quadratic in
  /// the number of patches. Rays for patches that are no polygons.
  analytic
};

struct NamedFormFactorMethod {
  std::string_view name;
  FormFactorMethod method;
};
/// What the methods are called wherever one is asked for by name.
inline constexpr std::array<NamedFormFactorMethod, 4> form_factor_methods = {
    {{"auto", FormFactorMethod::automatic},
     {"ray-cast", FormFactorMethod::ray_cast},
     {"hemicube", FormFactorMethod::hemicube},
     {"analytic", FormFactorMethod::analytic}}};

/// Throws std::invalid_argument, naming all that there are, for a name that is none of them.
FormFactorMethod form_factor_method(std::string_view name);

struct FormFactorOptions {
  FormFactorMethod method = FormFactorMethod::automatic;
  int rays_per_patch = 512;  ///< a power of two stratifies best; noise falls nearly as 1/rays
  /// Wanted standard error of every F_ij; rays are added to the rows that need them. 0: as many as
  /// rays_per_patch says.
  double target_error = 0.0;
  int most_rays_per_patch = 1 << 18;  ///< what target_error may ask for
  /// From each facet DirectLight owns, in all, for what mirrors and glass throw; a power of two.
  int rays_per_emitter = 65536;
  int max_specular_depth = 8;  ///< mirror and glass events along one ray
  int emitter_points = 16;     ///< points of a patch at which an emitter's closed form is taken
  ShadowOptions shadows{.min_rays = 4, .max_rays = 16};
  int hemicube_resolution = 256;  ///< cells along an edge of the hemicube's top
  /// Scale rows so that they close and stay reciprocal; what that changed is reported.
  bool enforce_closure = true;
  /// What the process may have in memory; rows that do not fit go to disk. Shared because the
  /// result's rows stay where it put them. Null: a budget of its own, with MemoryOptions' defaults.
  std::shared_ptr<MemoryBudget> memory{};
  RunControl run{};  ///< the journal keeps finished rows
};

/// What was measured before and after closure was enforced.
struct FormFactorReport {
  std::int64_t rays = 0;
  std::int64_t closed_forms = 0;         ///< pairs of patches that have a closed form
  double mean_closure_correction = 0.0;  ///< mean |1 - row sum| of the joined estimates
  double max_closure_correction = 0.0;
  double max_closure_error = 0.0;      ///< max |1 - row sum| that is left
  double max_reciprocity_error = 0.0;  ///< max |A_i F_ij - A_j F_ji| / min(A_i, A_j), of floats
  double depth_cut = 0.0;  ///< mean share of a row lost to max_specular_depth (counted as absorbed)
  std::vector<float> row_error{};  ///< estimated standard error of the worst F_ij of each row
};

/// Form factors of a meshed scene. What leaves a patch reaches others straight, by rays or closed
/// forms, and by way of mirrors and glass, by rays alone. Estimates of i -> j and j -> i are
/// estimates of the same A_i F_ij and are joined in proportion to what they can be trusted. Facets
/// that `direct_light` owns are small and bright: but for `ray_cast` and `hemicube`, closed forms
/// take the place of what was sampled for them. Rows are closed by symmetric diagonal scaling
/// (Sinkhorn & Knopp 1967; Knight, Ruiz & Ucar 2014), which keeps reciprocity: what was sampled
/// first, and closed forms only as far as that leaves a gap. The result is the same, bit for bit,
/// for any number of threads and any memory. Throws Interrupted when progress says stop, InputError
/// if the memory allowed is too little, and std::runtime_error if rows go to disk and it is full.
std::unique_ptr<FormFactors> compute_form_factors(const LitScene& lit,
                                                  const FormFactorOptions& options = {},
                                                  FormFactorReport* report = nullptr);

}  // namespace lightwell
