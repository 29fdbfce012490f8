#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/rows/memory_budget.h"
#include "scene/progress.h"

namespace lightwell {

class Portals;

/// F_ij: share of what leaves patch i that arrives at patch j directly.
struct FormFactor {
  int patch = 0;
  float value = 0.0f;
};

/// Light from patch i that reaches other patches through mirrors and clear glass: the extended form
/// factors of Sillion & Puech 1989, one share per band because mirrors and glass may be tinted.
struct SpecularRow {
  std::span<const int> patch{};
  Eigen::Map<const BandArray> value{nullptr, 0, 0};  ///< entries x bands
};

/// F_ij of a meshed scene, one sparse row per source patch i, ordered by j.
///
/// Every implementation keeps
///   - 0 <= F_ij;
///   - reciprocity, A_i F_ij = A_j F_ji; by way of clear bodies n_i^2 A_i F_ij = n_j^2 A_j F_ji
///     (see squared_index);
///   - closure: sum_j (F_ij + F^s_ij) (1 - s_j) + escaped(i) + absorbed_by_specular(i) = 1 in every
///     band. F^s_ij is specular_row(i), s_j the share of even light that patch j mirrors besides
///     what it scatters: such a patch counts in row(i), and passes its mirrored share on.
class FormFactors {
 public:
  virtual ~FormFactors() = default;
  virtual int patch_count() const = 0;
  virtual std::span<const FormFactor> row(int i) const = 0;
  virtual SpecularRow specular_row(int i) const = 0;  ///< empty without mirrors or glass
  /// Share per band of what leaves patch i that leaves the scene or meets a black back.
  virtual Spectrum escaped(int i) const = 0;
  /// Share per band that mirrors and glass absorb on the way.
  virtual Spectrum absorbed_by_specular(int i) const = 0;
  /// n_i^2, squared index of refraction of the clear body around each patch, relative to the air
  /// around all bodies; empty: 1 for all.
  virtual Eigen::ArrayXd squared_index() const { return {}; }
  /// Gives up row i. The row may be empty afterwards.
  virtual void release([[maybe_unused]] int i) {}
};

/// Methods for form factors. All keep the properties of FormFactors.
enum class FormFactorMethod {
  /// Rays; closed forms times fractional visibility where patches are near, large or bright.
  automatic,
  /// Cosine-distributed rays from all over each patch (Malley's method), counted at the patches
  /// that the rays meet.
  ray_cast,
  /// Item buffers on half a cube about each patch's centroid (Cohen & Greenberg 1985).
  hemicube,
  /// The closed form of every pair of polygons (Lambert; Schroeder & Hanrahan 1993) times their
  /// visibility: exact behind few polygons, otherwise sampled by shadow rays. Time is quadratic in
  /// the number of patches. Rays for patches that are no polygons.
  analytic
};

struct NamedFormFactorMethod {
  std::string_view name;
  FormFactorMethod method;
};
/// Names of the methods in options and files.
inline constexpr std::array<NamedFormFactorMethod, 4> form_factor_methods = {
    {{"auto", FormFactorMethod::automatic},
     {"ray-cast", FormFactorMethod::ray_cast},
     {"hemicube", FormFactorMethod::hemicube},
     {"analytic", FormFactorMethod::analytic}}};

/// The method of that name. Throws std::invalid_argument that lists all names for any other name.
FormFactorMethod form_factor_method(std::string_view name);

struct FormFactorOptions {
  FormFactorMethod method = FormFactorMethod::automatic;
  int rays_per_patch = 512;  ///< powers of two stratify best; noise falls nearly as 1/rays
  /// Casts fewer rays from small patches, a sixteenth at least: for sums of power, to which such
  /// patches add little. No meaning with `target_error`.
  bool has_rays_by_area = false;
  /// Wanted standard error of every F_ij; rows that need them get more rays. 0: rays_per_patch for
  /// all rows.
  double target_error = 0.0;
  int most_rays_per_patch = 1 << 18;  ///< upper limit where target_error needs more rays
  /// Rays from each facet that DirectLight owns, in total, for light through mirrors and glass; a
  /// power of two.
  int rays_per_emitter = 65536;
  int max_specular_depth = 8;  ///< mirror and glass events along one ray
  int emitter_points = 16;     ///< points of a patch at which an emitter's closed form is evaluated
  ShadowOptions shadows{.min_rays = 4, .max_rays = 16};
  /// Narrow openings that rays of rows are aimed at as well (`automatic` and `ray_cast`); null:
  /// none.
  std::shared_ptr<const Portals> portals{};
  int hemicube_resolution = 256;  ///< cells along an edge of the hemicube's top
  /// Scales rows to close and stay reciprocal; FormFactorReport gives the size of the correction.
  bool enforce_closure = true;
  /// Memory budget of the process; rows beyond it go to disk. Shared because the result's rows stay
  /// in the budget's storage. Null: a budget of its own with the defaults of MemoryOptions.
  std::shared_ptr<MemoryBudget> memory{};
  RunControl run{};  ///< the journal keeps finished rows
};

/// Measurements before and after closure is enforced.
struct FormFactorReport {
  std::int64_t rays = 0;
  std::int64_t closed_forms = 0;         ///< pairs of patches computed by closed form
  double mean_closure_correction = 0.0;  ///< mean |1 - row sum| of the joined estimates
  double max_closure_correction = 0.0;
  double max_closure_error = 0.0;  ///< largest remaining |1 - row sum|
  /// Largest |A_i F_ij - A_j F_ji| / min(A_i, A_j), from rounding to floats.
  double max_reciprocity_error = 0.0;
  double depth_cut = 0.0;  ///< mean share of a row lost to max_specular_depth (counted as absorbed)
  /// Per patch, share of its light that no row takes up, counted as escaped; empty: none. Rows
  /// contradict each other where surfaces lie in the same place: what a hidden surface sends has no
  /// counterpart, since no ray meets it.
  std::vector<float> lost_share{};
  /// Largest change of a closed form's F_ij in each row by closure.
  std::vector<float> closure_shift{};
  /// Estimated error of the worst F_ij of each row: standard error of sampled parts, bounds of the
  /// others, and closure_shift where that is larger. Empty: not estimated.
  std::vector<float> row_error{};
  /// Bound of the standard error of any sum of the F_ij of a row whose rays are counted, 1 / (2
  /// sqrt(rays)). Empty: not all factors are counts (`ray_cast` alone has them).
  std::vector<float> count_error{};
  /// Bound of the errors of the closed forms of each row, summed over the row, since they may all
  /// have the same sign. Empty: 0.
  std::vector<float> row_bias{};
};

/// Form factors of a meshed scene.
///   - Light that leaves a patch reaches others directly, by rays or closed forms, or through
///     mirrors and glass, by rays alone.
///   - i -> j and j -> i estimate the same A_i F_ij and are joined with weights of inverse
///     variance.
///   - Facets that DirectLight owns are small and bright. Except for `ray_cast` and `hemicube`,
///     closed forms replace their sampled exchange.
///   - Rows are closed by symmetric diagonal scaling (Sinkhorn & Knopp 1967; Knight, Ruiz & Ucar
///     2014), which keeps reciprocity: sampled exchange first, closed forms only for the remaining
///     gap.
///
/// The result is the same, bit for bit, for any number of threads and any memory. Throws
/// Interrupted if `progress` requests a stop, InputError if the memory budget is too small, and
/// std::runtime_error if rows go to disk and the disk is full.
std::unique_ptr<FormFactors> compute_form_factors(const LitScene& lit,
                                                  const FormFactorOptions& options = {},
                                                  FormFactorReport* report = nullptr);

}  // namespace lightwell
