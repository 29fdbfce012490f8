#include "radiosity/illuminate_elements.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radiosity/gather_attempts.h"
#include "scene/stopwatch.h"

namespace lightwell {
namespace {

// The error to reach next, below `error`, which took `spent` seconds, where `left` seconds are
// left; empty if there is not enough time for a notable difference.
std::optional<double> next_error(double error, double least, double spent, double left) {
  // Noise falls with the power 2/3 of the rays (see rays_for_noise()), which is 1.5, and the
  // elements grow besides. A fifth of the time is left in case that this is too hopeful.
  constexpr double order = 2.0, most_of_time = 0.8;
  // A quarter of the error takes 16 times as long, so all earlier stages take a 15th of the last
  // one's time. A difference of less than a fifth is not worth a stage.
  constexpr double largest_step = 0.25, notable_step = 0.8;
  const double step = std::pow(spent / (most_of_time * left), 1.0 / order);
  if (!(error > least) || !(step < notable_step)) return std::nullopt;
  return std::max(least, std::max(step, largest_step) * error);
}

// Reaches smaller and smaller errors as long as there is time. Each stage repeats what the one
// before did with less effort, so that all before the last take a third to a half of its time.
class StagesInTime {
 public:
  StagesInTime(const Scene& scene, const GatherSources& sources, const SolveOptions& options,
               SolvedScene& solved)
      : scene_(scene),
        sources_(sources),
        options_(options),
        patches_(solved),
        solved_(solved),
        target_(options.accuracy ? target_of(scene, options, solved) : finest) {}

  void run(SolveReport& report) {
    // 16 % takes the fewest rays that gathers have, so less would save nothing. After the first
    // stage an early end has to be completed; after a later one there is a result.
    constexpr double first = 0.16, for_the_first = 0.9, for_a_later = 0.95;
    Stopwatch watch;
    double error = std::max(first, target_), spent = 0.0;
    SolveOptions stage = options_at(error);
    stage.run = options_.run.with_share(for_the_first);
    gather_to_accuracy(scene_, sources_, stage, solved_, report);
    report.stage = error;
    while (solved_.solution.outcome == patches_.solution.outcome) {
      const double seconds = watch.lap();
      const auto next = next_error(error, target_, seconds, options_.run.time_left());
      if (!next) break;
      error = *next;
      SolvedScene better = patches_;
      SolveReport of_better = report;
      stage = options_at(error);
      if (!finishes_in_time(options_.run.with_share(for_a_later), [&](const RunControl& in_time) {
            stage.run = in_time;
            stage.run.seconds_left = {};
            gather_to_accuracy(scene_, sources_, stage, better, of_better);
          })) {
        break;
      }
      spent += seconds;
      solved_ = std::move(better);
      report = of_better;
      report.stage = error;
    }
    if (spent > 0.0) solved_.solution.seconds.push_back({"earlier_stages", spent});
    judge();
    report.accuracy = options_.accuracy ? target_ : 0.0;
  }

 private:
  // If no accuracy is asked for: below, the noise of form factors is no longer negligible, and no
  // error estimate sees it.
  static constexpr double finest = 0.005;

  SolveOptions options_at(double error) const {
    SolveOptions options = options_;
    options.run.journal = nullptr;
    if (error > target_ || !options.accuracy) options.accuracy = Accuracy{.share = error};
    // Caustics take the same time at every error otherwise. Their noise falls with the square root
    // of the rays.
    constexpr double all_rays_for = 0.02;
    if (error > target_) {
      const double share = std::pow(std::min(1.0, all_rays_for / error), 2);
      options.caustic_rays = std::max(1, static_cast<int>(share * options.caustic_rays));
    }
    return options;
  }

  // The outcome against what was asked for, in place of the last stage's own.
  void judge() {
    RadiositySolution& solution = solved_.solution;
    if (solution.outcome == Outcome::cut_short) return;
    solution.outcome = patches_.solution.outcome;
    const bool is_missed = options_.accuracy && !(solution.error_estimate <= target_);
    if (is_missed && solution.outcome == Outcome::converged) {
      solution.outcome = Outcome::accuracy_missed;
    }
  }

  const Scene& scene_;
  GatherSources sources_;
  const SolveOptions& options_;
  SolvedScene patches_;  // before any light of elements
  SolvedScene& solved_;
  double target_;
};

}  // namespace

void illuminate_elements(const Scene& scene, const GatherSources& sources,
                         const SolveOptions& options, SolvedScene& solved, SolveReport* report) {
  SolveReport unread;
  SolveReport& of_this = report ? *report : unread;
  if (options.run.has_limit()) {
    StagesInTime(scene, sources, options, solved).run(of_this);
  } else {
    gather_to_accuracy(scene, sources, options, solved, of_this);
  }
}

}  // namespace lightwell
