#include "radiosity/gather_attempts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/accuracy.h"
#include "radiosity/error_estimate.h"
#include "radiosity/form_factors/transport.h"
#include "radiosity/gap_errors.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/notable_portals.h"
#include "radiosity/patch_light.h"
#include "radiosity/reconstruct.h"
#include "radiosity/rows/memory_budget.h"
#include "radiosity/solution/relight.h"
#include "radiosity/unjudged_errors.h"
#include "scene/errors.h"
#include "scene/name_in_messages.h"
#include "scene/stopwatch.h"

namespace lightwell {
namespace {

double share_of(double lux, double mean) {
  return mean > 0.0 ? std::min(lux / mean, 1.0) : 1.0;
}

// The allowed error of each part, relative to the part's mean irradiance.
std::vector<double> targets_of(const Scene& scene, const SolveOptions& options,
                               const SolvedScene& patches) {
  const RadiositySolution& s = patches.solution;
  const auto parts = static_cast<std::size_t>(s.parts.judged_count());
  if (parts == 1 || !options.accuracy || options.accuracy->share > 0.0) {
    return std::vector<double>(parts, target_of(scene, options, patches));
  }
  std::vector<double> targets;
  for (const double mean :
       mean_illuminances(scene.bands, patches.mesh, s.patch_radiosity, s.parts)) {
    targets.push_back(share_of(options.accuracy->lux, mean));
  }
  return targets;
}

void require_finite(const Scene& scene, const RadiositySolution& solution) {
  const BandArray E = solution.irradiance();
  const Eigen::Index odd = E.rows() - E.isFinite().rowwise().all().count();
  if (odd == 0 && solution.patch_radiosity.allFinite()) return;
  throw InputError(fmt::format(
      "{}: irradiance is not a finite number at {} of {} vertices; an exitance near 1e38 W/m2 is "
      "more than single precision holds. Check the units of the scene's emission",
      name_in_messages(scene), odd, E.rows()));
}

// The options of a solve; with a target error, elements may be split deeper and be more than by
// default.
SolveOptions effective_options(const SolveOptions& options, double target,
                               const SolvedScene& solved, int columns) {
  SolveOptions effective = options;
  if (effective.gather.rays == 0) effective.gather.rays = rays_by_default;
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
    const std::int64_t room = memory->report().limit - resident_memory().now;
    effective.refine.room = elements_in(options.run.least(room), columns);
  }
  return effective;
}

SolveOptions with_portals(std::shared_ptr<const Portals> portals, SolveOptions options) {
  options.gather.portals = std::move(portals);
  return options;
}

// Gathers with rising effort until the error estimate meets the target.
class GatherAttempts {
 public:
  GatherAttempts(const Scene& scene, const GatherSources& sources, const SolveOptions& options,
                 SolvedScene& solved)
      : scene_(scene),
        sources_(sources),
        solved_(solved),
        target_(target_of(scene, options, solved)),
        targets_(targets_of(scene, options, solved)),
        irradiances_(reference_irradiances(solved.mesh, solved.solution.patch_radiosity,
                                           solved.solution.parts)),
        options_(with_portals(
            find_notable_portals(sources, solved, irradiances_, options.run),
            effective_options(options, target_, solved, sources.by_channel.column_count()))),
        may_save_rays_(options.gather.rays == 0 && !(target_ > 0.0)),
        pilot_gathers_(std::in_place, scene, std::move(solved.mesh), sources.by_channel,
                       solved.solution) {
    options_.refine.parts = solved.solution.parts;
    estimates_.resize(targets_.size());
    raised_.assign(targets_.size(), 1);
    std::vector<Effort> efforts;
    for (const double target : targets_) {
      efforts.push_back(target > 0.0 ? first_effort(target, options.refine.tolerance > 0.0)
                                     : Effort{options.refine.tolerance, options_.gather.rays});
    }
    take(std::move(efforts));
  }

  // Ends with the best result so far once the time is up.
  void run() {
    const RunControl run = options_.run;
    bool is_finished = true;
    const bool is_in_time = finishes_in_time(run, [&](const RunControl& in_time) {
      options_.run = in_time;
      do {
        is_finished = pilot_ || refines();
        if (!is_finished) return;
        gather();
        estimate();
      } while (raise_effort());
    });
    is_finished = is_finished && is_in_time;
    options_.run = run;
    if (!is_finished) end_early();
    if (!caster_) caster_.emplace(solved_.mesh);
    GatherOptions gather = options_.gather;
    gather.run = options_.run;
    constexpr int for_an_early_end = 512;
    add_gap_errors(lit(), gather, solved_.solution,
                   is_finished ? most_gap_elements : for_an_early_end, &radiosity_);
    if (is_finished) add_unjudged_errors(lit(), gather, solved_.solution, &radiosity_);
    spent_["error_estimate"] += watch_.lap();
  }

  void add_seconds(std::vector<PhaseSeconds>& seconds) {
    for (const char* phase : {"refine", "gather", "error_estimate"}) {
      if (spent_[phase] > 0.0) seconds.push_back({phase, spent_[phase]});
    }
  }
  bool has_refined() const { return has_refined_; }
  const RefineReport& refinement() const { return refinement_; }
  double target() const { return target_; }
  int gather_rays() const { return options_.gather.rays; }

 private:
  bool may_repeat() const { return target_ > 0.0; }
  LitScene lit() const { return {scene_, *caster_, sources_.all}; }

  // Takes the efforts of the parts, and shadow rays for the largest of them.
  void take(std::vector<Effort> efforts) {
    efforts_ = std::move(efforts);
    Effort most = efforts_.front();
    options_.refine.efforts.clear();
    for (std::size_t p = 0; p < efforts_.size(); ++p) {
      most.refine_tolerance = std::min(most.refine_tolerance, efforts_[p].refine_tolerance);
      most.gather_rays = std::max(most.gather_rays, efforts_[p].gather_rays);
      options_.refine.efforts.push_back({.tolerance = efforts_[p].refine_tolerance,
                                         .noise = noise_share(targets_[p]),
                                         .sky_noise = sky_noise_share(p),
                                         .rays = efforts_[p].gather_rays,
                                         .irradiance = irradiances_[p]});
    }
    options_.refine.tolerance = most.refine_tolerance;
    options_.gather.rays = most.gather_rays;
    if (!(target_ > 0.0)) return;
    options_.gather.shadows = most.shadows(options_.gather.shadows.many_lights);
    options_.gather.shadows.sky_rays = sky_rays(*std::ranges::min_element(targets_));
  }

  // The noise that the sky's light may have: without a target, that of the default's rays in a
  // typical room, so that they are not cast where fewer will do; or, once refinement has left a
  // larger error, that of a target as large.
  double sky_noise_share(std::size_t part) const {
    if (targets_[part] > 0.0) return noise_share(targets_[part]);
    const int rays = options_.gather.shadows.sky_rays;
    if (rays <= 0) return 0.0;
    const double left = part < refinement_.parts.size() ? refinement_.parts[part].estimate : 0.0;
    return noise_share(std::max(target_of_sky_rays(rays), left));
  }

  // Splits elements and gathers to their vertices with few rays. Returns false if there is not
  // enough time for that.
  bool refines() {
    caster_.reset();
    pilot_ = pilot_gathers_->gather(options_);
    if (!pilot_) return false;
    if (attempt_ == 0 && target_ > 0.0) {
      std::vector<Effort> efforts = efforts_;
      for (std::size_t p = 0; p < efforts.size(); ++p) {
        efforts[p].gather_rays = pilot_->gather_rays[p];
      }
      take(std::move(efforts));
    }
    take_mesh(may_repeat());
    spread_pools({scene_, *caster_, sources_.by_channel}, unscaled_radiosity(solved_.solution),
                 pilot_->beside_direct(), options_.free_rays, pilot_->direct);
    if (may_save_rays_) save_rays();
    give_back_free_pages();  // splitting elements leaves many
    if (pilot_->tree) spent_["refine"] += watch_.lap();
    return true;
  }

  // Fewer rays of the final gather where the elements leave a large error that rays do not reduce.
  void save_rays() {
    if (refinement_.outcome == RefineOutcome::tolerance_reached) return;
    std::vector<Effort> efforts = efforts_;
    for (std::size_t p = 0; p < std::min(efforts.size(), refinement_.parts.size()); ++p) {
      efforts[p].gather_rays = rays_worth(refinement_.parts[p].estimate);
    }
    take(std::move(efforts));
  }

  // Makes the mesh of the pilot gather that of the solution.
  void take_mesh(bool keeps_base) {
    state_ = State::has_pilot;
    refinement_ = pilot_->refinement;
    has_refined_ = pilot_->tree != nullptr;
    if (pilot_->refined) {
      solved_.mesh = std::move(*pilot_->refined);
    } else {
      solved_.mesh = keeps_base ? pilot_gathers_->base() : std::move(pilot_gathers_->base());
    }
    caster_.emplace(pilot_gathers_->caster(solved_.mesh, *pilot_));
    if (!keeps_base) pilot_gathers_.reset();
  }

  void gather() {
    state_ = State::has_pilot;
    radiosity_.resize(0, 0);
    reconstruct({scene_, *caster_, sources_.by_channel}, options_, *pilot_, solved_.solution,
                may_repeat() ? &kept_ : nullptr);
    relight(solved_, effective_scales(solved_.solution));
    state_ = State::is_gathered;
    give_back_free_pages();
    spent_["gather"] += watch_.lap();
  }

  std::vector<ErrorEstimate> estimate_batch(int batch, Eigen::ArrayXf* of_elements,
                                            std::span<const char> wanted) const {
    return estimate_errors(lit(), options_, solved_.solution,
                           {batch, of_elements, wanted, &radiosity_});
  }

  // True if the target of a part is missed, and if either
  // - it lies between the ends of the estimate, or
  // - the ends are too far apart to say how much effort is missing.
  bool is_undecided(std::size_t part) const {
    // A share of the target. An error known to a tenth gives the tolerance that is missing to about
    // a fifth, which is the smallest step of next_effort().
    constexpr double far_apart = 0.1;
    const ErrorEstimate& estimate = estimates_[part];
    const double least = estimate.least(), error = estimate.error(), target = targets_[part];
    return target > 0.0 && estimate.batches > 0 && target < error &&
           (least < target || error - least > far_apart * target);
  }

  void estimate() {
    Eigen::ArrayXf& of_elements = solved_.solution.interpolation_error;
    const bool has_errors = of_elements.size() > 0;
    if (!has_errors) raised_.assign(estimates_.size(), 1);
    if (radiosity_.size() == 0) radiosity_ = gatherable_radiosity(lit(), solved_.solution);
    const std::vector<ErrorEstimate> first =
        estimate_batch(0, has_errors ? nullptr : &of_elements, raised_);
    for (std::size_t p = 0; p < first.size(); ++p) {
      if (raised_[p] != 0) estimates_[p] = first[p];
    }
    // More sample points for an undecided estimate cost less than an attempt too many, or than one
    // that splits far too much: a single point may hold a fifth of the squared error. Four batches
    // halve the standard error of one.
    constexpr int most_batches = 4;
    for (int batch = 1; batch < most_batches; ++batch) {
      std::vector<char> wanted(estimates_.size(), 0);
      for (std::size_t p = 0; p < wanted.size(); ++p) {
        wanted[p] = raised_[p] != 0 && is_undecided(p) ? 1 : 0;
      }
      if (std::ranges::count(wanted, 1) == 0) break;
      const std::vector<ErrorEstimate> more = estimate_batch(batch, nullptr, wanted);
      for (std::size_t p = 0; p < wanted.size(); ++p) {
        estimates_[p] = joined(estimates_[p], more[p]);
      }
    }
    keep_estimates();
    state_ = State::is_estimated;
    spent_["error_estimate"] += watch_.lap();
  }

  // Completes the solution with what there is, by as little work as possible:
  // - the attempt before, if refinement was stopped in a later one;
  // - the light at the vertices of the base, or at patches, if refinement was stopped in the first
  //   attempt;
  // - the light of the pilot gather, if the gather was stopped.
  void end_early() {
    spent_["gather"] += watch_.lap();
    RadiositySolution& solution = solved_.solution;
    if (solution.outcome == Outcome::converged) solution.outcome = Outcome::cut_short;
    if (state_ == State::is_estimated) return;
    options_.run.journal = nullptr;
    // 128 rays at 64 to 512 points: a second or two.
    constexpr int few_rays = 128, few_points = 64;
    options_.gather.rays = std::min(few_rays, options_.gather.rays);
    options_.error_points = std::min(few_points, options_.error_points);
    options_.refine.efforts.clear();
    raised_.assign(estimates_.size(), 1);
    if (state_ == State::has_nothing) {
      pilot_ = pilot_gathers_->gather_in_haste(options_);
      take_mesh(false);
    }
    if (state_ == State::has_pilot) {
      radiosity_.resize(0, 0);
      take_pilot_light({scene_, *caster_, sources_.by_channel}, options_, *pilot_,
                       may_repeat() ? &kept_ : nullptr, solution);
      relight(solved_, effective_scales(solution));
    }
    estimate();
  }

  // Writes the estimates into the solution. The largest error counts for the whole: largest against
  // the part's target, which for an accuracy in lux is another share of each part's mean.
  void keep_estimates() {
    RadiositySolution& solution = solved_.solution;
    solution.error_estimate = 0.0;
    for (std::size_t p = 0; p < estimates_.size(); ++p) {
      const bool is_known = estimates_[p].batches > 0;
      if (p < solution.parts.parts.size()) {
        solution.parts.parts[p].error_estimate = is_known ? estimates_[p].error() : -1.0;
      }
      if (!is_known) continue;
      const double of_target = targets_[p] > 0.0 ? target_ / targets_[p] : 1.0;
      solution.error_estimate =
          std::max(solution.error_estimate, of_target * estimates_[p].error());
    }
  }

  // The next effort of a part; empty if more would not help.
  std::optional<Effort> next_effort_of(std::size_t part) const {
    RefineReport refined = pilot_->refinement;
    if (part < refined.parts.size()) {
      refined.estimate = refined.parts[part].estimate;
      if (refined.parts[part].is_reached) refined.outcome = RefineOutcome::tolerance_reached;
    }
    const ErrorEstimate& estimate = estimates_[part];
    const Effort& spent = efforts_[part];
    auto next =
        next_effort(spent, targets_[part], estimate.error(), estimate.noise, refined, attempt_);
    // Few of the rays in a dim room find the opening that its light comes from. The noise then has
    // a long tail, is larger than its estimate, and no splitting reduces it. Rays come first where
    // the noise has more than half of the squared error.
    constexpr double large = 0.7;
    const bool is_noisy = efforts_.size() > 1 && estimate.noise > large * estimate.error();
    if (next && is_noisy && next->gather_rays > spent.gather_rays) {
      next->refine_tolerance = spent.refine_tolerance;
    }
    return next;
  }

  // Returns false if all targets are met, or if more effort would not help where they are not.
  bool raise_effort() {
    if (!may_repeat()) return false;
    std::vector<Effort> efforts = efforts_;
    std::vector<char> raised(efforts.size(), 0);
    bool is_met = true, is_more = false, is_finer = false;
    for (std::size_t p = 0; p < efforts.size(); ++p) {
      if (estimates_[p].batches == 0 || estimates_[p].error() <= targets_[p]) continue;
      is_met = false;
      const std::optional<Effort> next = next_effort_of(p);
      if (!next) continue;
      is_more = true;
      raised[p] = 1;
      is_finer = is_finer || next->refine_tolerance < efforts_[p].refine_tolerance;
      efforts[p] = *next;
    }
    if (is_met) return false;
    if (!is_more) {
      RadiositySolution& solution = solved_.solution;
      if (solution.outcome == Outcome::converged) solution.outcome = Outcome::accuracy_missed;
      return false;
    }
    if (is_finer) pilot_.reset();
    take(std::move(efforts));
    raised_ = std::move(raised);
    ++attempt_;
    return true;
  }

  const Scene& scene_;
  GatherSources sources_;
  SolvedScene& solved_;
  double target_;                    // relative to the mean irradiance of the scene
  std::vector<double> targets_;      // relative to the mean irradiance of each part
  std::vector<double> irradiances_;  // by which errors in each part are judged, W/m^2
  SolveOptions options_;
  std::vector<Effort> efforts_{};  // of each part
  int attempt_ = 0;
  // Steps of the present attempt that the solution holds.
  enum class State { has_nothing, has_pilot, is_gathered, is_estimated };
  State state_ = State::has_nothing;
  RefineReport refinement_{};
  bool has_refined_ = false;
  bool may_save_rays_;
  std::optional<PilotGathers> pilot_gathers_;
  std::optional<PilotGather> pilot_{};
  std::optional<ElementCaster> caster_{};
  KeptGathers kept_{};
  BandArray radiosity_{};  // that gathers read, of the solution; empty: not found yet
  std::vector<ErrorEstimate> estimates_{};  // of each part
  std::vector<char> raised_{};  // 1 for each part whose light changed since its estimate
  Stopwatch watch_{};
  std::map<std::string, double> spent_{};
};

}  // namespace

double target_of(const Scene& scene, const SolveOptions& options, const SolvedScene& patches) {
  if (!options.accuracy) return 0.0;
  if (options.accuracy->share > 0.0) return options.accuracy->share;
  return share_of(options.accuracy->lux,
                  mean_illuminance(scene.bands, patches.mesh, patches.solution.patch_radiosity));
}

void gather_to_accuracy(const Scene& scene, const GatherSources& sources,
                        const SolveOptions& options, SolvedScene& solved, SolveReport& report) {
  GatherAttempts attempts(scene, sources, options, solved);
  attempts.run();
  RadiositySolution& solution = solved.solution;
  require_finite(scene, solution);
  if (attempts.has_refined()) solution.provenance.refinement = sentence(attempts.refinement());
  attempts.add_seconds(solution.seconds);
  report.refinement = attempts.refinement();
  report.accuracy = attempts.target();
  report.gather_rays = attempts.gather_rays();
}

}  // namespace lightwell
