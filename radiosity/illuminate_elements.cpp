#include "radiosity/illuminate_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "radiosity/error_estimate.h"
#include "radiosity/form_factors/transport.h"
#include "radiosity/gap_errors.h"
#include "radiosity/reconstruct.h"
#include "radiosity/rows/memory_budget.h"
#include "radiosity/solution/relight.h"
#include "radiosity/stopwatch.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// The allowed error, relative to the mean irradiance; 0: no accuracy is requested.
double target_of(const Scene& scene, const SolveOptions& options, const SolvedScene& patches) {
  if (!options.accuracy) return 0.0;
  if (options.accuracy->share > 0.0) return options.accuracy->share;
  const double mean = mean_illuminance(scene.bands, patches.mesh, patches.solution.patch_radiosity);
  return mean > 0.0 ? std::min(options.accuracy->lux / mean, 1.0) : 1.0;
}

void require_finite(const Scene& scene, const RadiositySolution& solution) {
  const BandArray E = solution.irradiance();
  const Eigen::Index odd = E.rows() - E.isFinite().rowwise().all().count();
  if (odd == 0 && solution.patch_radiosity.allFinite()) return;
  throw InputError(fmt::format(
      "{}: irradiance is not a finite number at {} of {} vertices; an exitance near 1e38 W/m2 is "
      "more than single precision holds. Check the units of the scene's emission",
      scene.file.empty() ? "the scene" : scene.file.string(), odd, E.rows()));
}

// The options of a solve; with a target error, elements may be split deeper and be more than by
// default.
SolveOptions effective_options(const SolveOptions& options, double target,
                               const SolvedScene& solved, int columns) {
  SolveOptions effective = options;
  if (target > 0.0) {
    // Three levels more: at a tight accuracy the errors left are at the edges of shadows, some of
    // them on large elements.
    constexpr int deeper = 3;
    effective.refine.max_level += deeper;
    // A million elements take about 1 GB.
    constexpr std::int64_t plenty = 1000000;
    auto& most = effective.refine.max_elements;
    if (most == 0) most = std::max<std::int64_t>(plenty, 4 * solved.mesh.element_count());
  }
  if (const auto memory = options.form_factors.memory) {
    effective.refine.room = elements_in(memory->report().limit - resident_memory().now, columns);
  }
  return effective;
}

// Gathers with rising effort until the error estimate meets the target.
class GatherAttempts {
 public:
  GatherAttempts(const Scene& scene, const DirectLightSums& direct_light,
                 const SolveOptions& options, SolvedScene& solved)
      : scene_(scene),
        direct_light_(direct_light),
        solved_(solved),
        target_(target_of(scene, options, solved)),
        options_(
            effective_options(options, target_, solved, direct_light.by_channel.column_count())),
        pilot_gathers_(std::in_place, scene, std::move(solved.mesh), direct_light.by_channel,
                       solved.solution, noise_share(target_)) {
    take(target_ > 0.0 ? first_effort(target_, options.refine.tolerance > 0.0)
                       : Effort{options.refine.tolerance, options.gather.rays});
  }

  void run() {
    do {
      if (!pilot_) refine();
      gather();
      estimate();
    } while (raise_effort());
    GatherOptions gather = options_.gather;
    gather.run = options_.run;
    add_gap_errors({scene_, *caster_, direct_light_.all}, gather, solved_.solution);
    spent_["error_estimate"] += watch_.lap();
  }

  void add_seconds(std::vector<PhaseSeconds>& seconds) {
    for (const char* phase : {"refine", "gather", "error_estimate"}) {
      if (spent_[phase] > 0.0) seconds.push_back({phase, spent_[phase]});
    }
  }
  bool has_refined() const { return pilot_->tree != nullptr; }
  const RefineReport& refinement() const { return pilot_->refinement; }
  double target() const { return target_; }
  int gather_rays() const { return effort_.gather_rays; }

 private:
  bool may_repeat() const { return target_ > 0.0; }

  void take(const Effort& effort) {
    effort_ = effort;
    options_.refine.tolerance = effort.refine_tolerance;
    options_.gather.rays = effort.gather_rays;
    if (!(target_ > 0.0)) return;
    options_.gather.shadows = effort.shadows();
    options_.gather.shadows.sky_rays = sky_rays(target_);
  }

  // Splits elements and gathers to their vertices with few rays.
  void refine() {
    caster_.reset();
    pilot_ = pilot_gathers_->gather(options_);
    if (attempt_ == 0 && target_ > 0.0) {
      effort_.gather_rays = pilot_->gather_rays;
      take(effort_);
    }
    if (pilot_->refined) {
      solved_.mesh = std::move(*pilot_->refined);
    } else {
      solved_.mesh = may_repeat() ? pilot_gathers_->base() : std::move(pilot_gathers_->base());
    }
    caster_.emplace(pilot_gathers_->caster(solved_.mesh, *pilot_));
    if (!may_repeat()) pilot_gathers_.reset();
    give_back_free_pages();  // splitting elements leaves many
    if (pilot_->tree) spent_["refine"] += watch_.lap();
  }

  void gather() {
    reconstruct({scene_, *caster_, direct_light_.by_channel}, options_, *pilot_, solved_.solution,
                may_repeat() ? &kept_ : nullptr);
    relight(solved_, effective_scales(solved_.solution));
    give_back_free_pages();
    spent_["gather"] += watch_.lap();
  }

  ErrorEstimate estimate_batch(int batch, Eigen::ArrayXf* of_elements) const {
    return estimate_error({scene_, *caster_, direct_light_.all}, options_, solved_.solution,
                          of_elements, batch);
  }

  void estimate() {
    Eigen::ArrayXf& of_elements = solved_.solution.interpolation_error;
    estimate_ = estimate_batch(0, of_elements.size() == 0 ? &of_elements : nullptr);
    // If the target lies between the ends of the estimate, more sample points cost less than
    // another attempt: a single point may hold a fifth of the squared error. Four batches halve the
    // standard error of one.
    constexpr int most_batches = 4;
    for (int batch = 1;
         batch < most_batches && estimate_.least() < target_ && target_ < estimate_.error();
         ++batch) {
      estimate_ = joined(estimate_, estimate_batch(batch, nullptr));
    }
    solved_.solution.error_estimate = estimate_.error();
    spent_["error_estimate"] += watch_.lap();
  }

  // Returns false if the target is met, or if more effort would not help.
  bool raise_effort() {
    RadiositySolution& solution = solved_.solution;
    if (!may_repeat() || solution.error_estimate <= target_) return false;
    const auto next = next_effort(effort_, target_, estimate_.error(), estimate_.noise,
                                  pilot_->refinement, attempt_);
    if (!next) {
      if (solution.outcome == Outcome::converged) solution.outcome = Outcome::accuracy_missed;
      return false;
    }
    if (next->refine_tolerance < effort_.refine_tolerance) pilot_.reset();
    take(*next);
    ++attempt_;
    return true;
  }

  const Scene& scene_;
  DirectLightSums direct_light_;
  SolvedScene& solved_;
  double target_;
  SolveOptions options_;
  Effort effort_{};
  int attempt_ = 0;
  std::optional<PilotGathers> pilot_gathers_;
  std::optional<PilotGather> pilot_{};
  std::optional<ElementCaster> caster_{};
  KeptGathers kept_{};
  ErrorEstimate estimate_{};
  Stopwatch watch_{};
  std::map<std::string, double> spent_{};
};

}  // namespace

void illuminate_elements(const Scene& scene, const DirectLightSums& direct_light,
                         const SolveOptions& options, SolvedScene& solved, SolveReport* report) {
  GatherAttempts attempts(scene, direct_light, options, solved);
  attempts.run();
  RadiositySolution& solution = solved.solution;
  require_finite(scene, solution);
  if (attempts.has_refined()) solution.provenance.refinement = sentence(attempts.refinement());
  attempts.add_seconds(solution.seconds);
  if (!report) return;
  report->refinement = attempts.refinement();
  report->accuracy = attempts.target();
  report->gather_rays = attempts.gather_rays();
}

}  // namespace lightwell
