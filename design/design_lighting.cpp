#include "design/design_lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "design/measured_light.h"
#include "radiosity/solution/relight.h"
#include "raytrace/cameras/choose_camera.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

/// Measurements of levels at most. The margin of a limit is the bound of the error, which hardly
/// depends on the levels, so that the second measurement nearly always ends the search.
constexpr int most_measurements = 4;

// Place among the limited grids of the task of the grid that a limit names.
int grid_index(const Scene& scene, const WordedLimit& limit,
               const std::vector<CalculationGrid>& of_scene, std::vector<int>& limited) {
  const auto at = std::ranges::find(of_scene, limit.place, &CalculationGrid::name);
  if (at == of_scene.end()) {
    std::vector<std::string> names;
    for (const CalculationGrid& grid : of_scene) names.push_back(grid.name);
    const std::string remedy = names.empty() ? " Add a [[grids]] table with that name to the scene."
                                             : did_you_mean(limit.place, names);
    throw InputError(fmt::format("{}: the scene {} has no grid of that name.{}", limit.origin,
                                 scene.file.string(), remedy));
  }
  const auto grid = static_cast<int>(at - of_scene.begin());
  const auto known = std::ranges::find(limited, grid);
  if (known != limited.end()) return static_cast<int>(known - limited.begin());
  limited.push_back(grid);
  return static_cast<int>(limited.size()) - 1;
}

int eye_index(const Scene& scene, const WordedLimit& limit, std::vector<Camera>& eyes) {
  const auto known = std::ranges::find(eyes, limit.place, &Camera::name);
  if (known != eyes.end()) return static_cast<int>(known - eyes.begin());
  try {
    eyes.push_back(choose_camera(scene, limit.place));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", limit.origin, error.what()));
  }
  return static_cast<int>(eyes.size()) - 1;
}

// Channels of luminaires, in rising order. Throws InputError if one holds daylight as well.
std::vector<int> channels_to_dim(const Scene& scene, const RadiositySolution& solution,
                                 const std::vector<Luminaire>& luminaires) {
  std::vector<int> channels;
  for (const Luminaire& luminaire : luminaires) channels.push_back(luminaire.channel);
  std::ranges::sort(channels);
  channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
  for (int i = static_cast<int>(scene.lamps.size()); i < free_source_count(scene); ++i) {
    const int channel = solution.source_channel[static_cast<std::size_t>(i)];
    if (!std::ranges::binary_search(channels, channel)) continue;
    throw InputError(fmt::format(
        "channel '{}' of the solution holds luminaires and daylight, which cannot be dimmed; solve "
        "with --channels per-luminaire, or leave the solution out",
        solution.channels[static_cast<std::size_t>(channel)].name));
  }
  return channels;
}

// Sets the costs of the plan and of the luminaires of the problem. Power counts if that of every
// luminaire is known, otherwise flux.
void set_costs(const DesignTask& task, const std::vector<int>& channels, LightingPlan& plan,
               DimmingProblem& problem) {
  const auto unknown = std::ranges::find_if(
      plan.luminaires, [](const Luminaire& luminaire) { return !(luminaire.watts > 0.0); });
  plan.is_in_watts = unknown == plan.luminaires.end();
  if (!plan.is_in_watts) {
    plan.notes.push_back(fmt::format(
        "the electric power of luminaire '{}' is not known, so luminous flux is minimised; name "
        "the power with the key watts of its [[lamps]] table or with --watts",
        unknown->name));
  }
  for (const int channel : channels) {
    problem.luminaires.push_back({.name = plan.groups[static_cast<std::size_t>(channel)],
                                  .least = task.request.limits.least_level});
  }
  for (const Luminaire& luminaire : plan.luminaires) {
    const auto at = std::ranges::lower_bound(channels, luminaire.channel) - channels.begin();
    const double cost = plan.is_in_watts ? luminaire.watts : luminaire.lumens;
    problem.luminaires[static_cast<std::size_t>(at)].cost += cost;
    plan.cost_at_full += cost;
  }
}

// Light of each channel by itself, at full level.
void measure_channels(MeasuredLight& light, const std::vector<int>& channels,
                      DimmingProblem& problem, const Progress& progress) {
  const auto count = static_cast<Eigen::Index>(channels.size());
  for (const LuxGrid& grid : light.grids()) {
    const auto points = static_cast<Eigen::Index>(grid.points.size());
    problem.grids.push_back({.name = grid.name, .lux = Eigen::MatrixXd(points, count)});
  }
  for (const Camera& eye : light.eyes()) {
    problem.observers.push_back({.name = eye.name,
                                 .glare = Eigen::VectorXd::Zero(count),
                                 .background = Eigen::VectorXd::Zero(count)});
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto between = [&] {
      report(progress, "luminaires", static_cast<double>(i) / static_cast<double>(count));
    };
    std::vector<double> alone(light.channel_count(), 0.0);
    alone[static_cast<std::size_t>(channels[static_cast<std::size_t>(i)])] = 1.0;
    const LightReadings readings = light.measure(alone, 0, between);
    for (std::size_t g = 0; g < readings.fields.size(); ++g) {
      problem.grids[g].lux.col(i) = readings.fields[g].lux;
    }
    for (std::size_t o = 0; o < readings.glares.size(); ++o) {
      problem.observers[o].background[i] = readings.glares[o].background;
      for (const GlareSource& source : readings.glares[o].sources) {
        problem.observers[o].glare[i] += source.share;
      }
    }
  }
}

/// A reading of a limited quantity, and the bound of its error.
struct BoundedValue {
  double value = 0.0, within = 0.0;
};

BoundedValue value_of_field(LimitKind kind, const LuxField& field) {
  switch (kind) {
    case LimitKind::least_at_least:
      return {field.least, known_bound(field, field.least)};
    case LimitKind::greatest_at_most:
      return {field.greatest, known_bound(field, field.greatest)};
    case LimitKind::uniformity_at_least: {
      const Requirement uniformity = uniformity_at_least(0.0, {.field = &field});
      return {*uniformity.value, uniformity.within};
    }
    default:
      return {field.mean, field.mean_within * field.mean};
  }
}

// UGR rises most where the background is darker than it was read, by twice the error estimate.
BoundedValue value_of_glare(const Glare& glare, double error_estimate) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double shares = 0.0;
  for (const GlareSource& source : glare.sources) shares += source.share;
  if (!glare.ugr) return {shares > 0.0 ? infinity : 0.0, 0.0};
  if (!(error_estimate > 0.0)) return {*glare.ugr, std::numeric_limits<double>::quiet_NaN()};
  const double darkest = 1.0 - 2.0 * error_estimate;
  return {*glare.ugr, darkest > 0.0 ? -8.0 * std::log10(darkest) : infinity};
}

// Outcomes of all limits at the readings.
std::vector<LimitOutcome> outcomes_of(const DesignTask& task, const LightReadings& readings,
                                      double error_estimate) {
  std::vector<LimitOutcome> outcomes;
  for (std::size_t k = 0; k < task.limits.size(); ++k) {
    const DimmingLimit& limit = task.limits[k];
    const auto place = static_cast<std::size_t>(limit.place);
    const BoundedValue reached = limit.kind == LimitKind::ugr_at_most
                                     ? value_of_glare(readings.glares[place], error_estimate)
                                     : value_of_field(limit.kind, readings.fields[place]);
    outcomes.push_back({.limit = task.request.limits.limits[k],
                        .reached = reached.value,
                        .within = reached.within,
                        .verdict = verdict_of(Requirement{.is_upper = !is_lower_limit(limit.kind),
                                                          .limit = limit.value,
                                                          .value = reached.value,
                                                          .within = reached.within})});
  }
  return outcomes;
}

// Moves the limits of the problem by what the outcomes lack for being met beyond doubt.
void tighten(const std::vector<LimitOutcome>& outcomes, DimmingProblem& problem) {
  constexpr double a_little_more = 1.1;  // the next measurement has other noise
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const LimitOutcome& outcome = outcomes[k];
    DimmingLimit& limit = problem.limits[k];
    const double sign = is_lower_limit(limit.kind) ? 1.0 : -1.0;
    const double lack = sign * (outcome.limit.value - outcome.reached) + outcome.within;
    if (!(lack > 0.0) || !std::isfinite(lack)) continue;
    constexpr double least_share = 0.01;  // of a limit, which stays above zero
    limit.value =
        std::max(limit.value + sign * a_little_more * lack, least_share * outcome.limit.value);
    if (limit.kind == LimitKind::uniformity_at_least) limit.value = std::min(limit.value, 1.0);
  }
}

// The levels of a dimming plan for all channels; those of daylight are 0.
std::vector<double> levels_of(const DimmingPlan& dimming, const std::vector<int>& channels,
                              std::size_t channel_count) {
  std::vector<double> levels(channel_count, 0.0);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    levels[static_cast<std::size_t>(channels[i])] = dimming.levels[static_cast<Eigen::Index>(i)];
  }
  return levels;
}

// Steps 2 to 4 of design_lighting(). The limits of the problem are tightened.
void find_levels(const DesignTask& task, const std::vector<int>& channels, MeasuredLight& light,
                 DimmingProblem& problem, LightingPlan& plan, const Progress& progress) {
  const Eigen::VectorXd full = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(channels.size()));
  while (plan.measurements < most_measurements) {
    const DimmingPlan dimming = best_dimming(problem);
    const bool is_first = plan.measurements == 0;
    if (is_first) plan.cost_without_margin = dimming.cost;
    if (!is_first && !dimming.is_feasible) break;  // the margin is out of reach
    plan.is_feasible = dimming.is_feasible;
    plan.cost = dimming.cost;
    plan.levels = levels_of(dimming, channels, light.channel_count());
    const auto replica = static_cast<std::uint64_t>(++plan.measurements);
    const auto between = [&] {
      report(progress, "levels", static_cast<double>(plan.measurements) / most_measurements);
    };
    LightReadings readings = light.measure(plan.levels, replica, between);
    plan.limits = outcomes_of(task, readings, light.solution().error_estimate);
    for (std::size_t g = 0; g < readings.fields.size(); ++g) {
      plan.surfaces[g].field = std::move(readings.fields[g]);
    }
    for (std::size_t k = 0; k < plan.limits.size(); ++k) {
      plan.limits[k].price = dimming.price[k];
      plan.limits[k].at_full = value_at(problem, task.limits[k], full);
    }
    const DimmingPlan even = best_dimming(dimmed_evenly(problem));
    plan.cost_of_even = even.is_feasible ? std::optional(even.cost) : std::optional<double>();
    if (!plan.is_feasible || plan.meets_all()) break;
    tighten(plan.limits, problem);
  }
  light.relight_at(plan.levels);
}

}  // namespace

bool LightingPlan::meets_all() const {
  return std::ranges::all_of(
      limits, [](const LimitOutcome& outcome) { return outcome.verdict == Verdict::met; });
}

DesignTask plan_design(const Scene& scene, DesignRequest request) {
  if (scene.relative_units) {
    throw InputError(fmt::format(
        "{}: the scene names no unit of light, so no limit in lx can be met", scene.file.string()));
  }
  DesignTask task{.design = read_lighting_design(scene)};
  for (const WordedLimit& limit : request.limits.limits) {
    const int place = limit.kind == LimitKind::ugr_at_most
                          ? eye_index(scene, limit, task.eyes)
                          : grid_index(scene, limit, task.design.grids, task.grids);
    task.limits.push_back({.kind = limit.kind, .place = place, .value = limit.value});
  }
  require_luminaires(scene, request.watts);
  task.places = allowed_places(scene, request.limits.moves);
  task.request = std::move(request);
  return task;
}

LightingPlan design_lighting(const DesignTask& task, const ReportedScene& of, SolvedScene& solved,
                             const Progress& progress) {
  require_channels(solved.solution);
  LightingPlan plan{
      .luminaires = luminaires_of(of.scene, solved, task.design, task.request.watts),
      .maintenance_factor = maintenance_factor(task.request.limits.maintenance_factor, task.design),
      .rays = task.request.rays};
  for (const LightChannel& channel : solved.solution.channels) plan.groups.push_back(channel.name);
  const std::vector<int> channels = channels_to_dim(of.scene, solved.solution, plan.luminaires);
  DimmingProblem problem{.limits = task.limits};
  set_costs(task, channels, plan, problem);
  MeasuredLight light(of, solved,
                      {.grids = task.design.grids,
                       .limited = task.grids,
                       .eyes = task.eyes,
                       .luminous_heights = task.design.luminous_height,
                       .maintenance_factor = plan.maintenance_factor,
                       .rays = plan.rays});
  if (channels.size() < solved.solution.channels.size()) {
    plan.notes.emplace_back("daylight is switched off: limits are those of electric light alone");
  }
  measure_channels(light, channels, problem, progress);
  for (const std::string& lamp : light.left_out()) {
    plan.notes.push_back(
        fmt::format("lamp '{}' has no luminous area, so that UGR does not count its glare", lamp));
  }
  for (const LuxGrid& grid : light.grids()) {
    CalculationSurface& surface = plan.surfaces.emplace_back();
    surface.grid = grid;
    surface.lines = light.lines_of(grid);
  }
  plan.measured = problem;
  plan.dimmed = channels;
  find_levels(task, channels, light, problem, plan, progress);
  return plan;
}

}  // namespace lightwell
