#include "design/move_luminaires.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "design/places/place_search.h"

namespace lightwell {
namespace {

// Descents at most, each from a place whose light was solved: what the second one still gains is
// what PlacedLight gets wrong far from the first place.
constexpr int most_descents = 3;

// Shares of the way to the places of a descent that are tried.
constexpr double shares_of_way[] = {1.0, 0.5};

// True if levels of `a` are better than those of `b`: all limits met, then of less cost.
bool is_better_design(const LightingPlan& a, const LightingPlan& b) {
  if (a.meets_all() != b.meets_all()) return a.meets_all();
  if (a.is_feasible != b.is_feasible) return a.is_feasible;
  if (a.is_feasible) return a.cost < b.cost;
  return best_dimming(a.measured).worst_miss < best_dimming(b.measured).worst_miss;
}

// True if a descent promises what another solve can show: the bound of an illuminance's error is
// seldom less than a thousandth.
bool is_worth_a_solve(const PlaceOptimum& found) {
  constexpr double least_gain = 1e-3;
  const DimmingPlan &before = found.first, &after = found.plan;
  if (before.is_feasible != after.is_feasible) return after.is_feasible;
  return before.is_feasible ? after.cost < (1.0 - least_gain) * before.cost
                            : after.worst_miss < before.worst_miss - least_gain;
}

// Moves the lamps, to places with as many digits as are written.
Scene with_lamps_at(Scene scene, const AllowedPlaces& allowed, const Eigen::Matrix3Xd& places) {
  constexpr double decimals = 1e6;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const AllowedPlace& box = allowed.moved[static_cast<std::size_t>(i)];
    Lamp& lamp = scene.lamps[static_cast<std::size_t>(box.lamp)];
    for (int axis = 0; axis < 3; ++axis) {
      if (!(box.high[axis] > box.low[axis])) continue;
      const double in_file = places(axis, i) / scene.metres_per_unit;
      lamp.position[axis] = scene.metres_per_unit * (std::round(in_file * decimals) / decimals);
    }
  }
  return scene;
}

// The luminaire of the dimming problem that each moved lamp is part of.
std::vector<int> luminaires_of_lamps(const AllowedPlaces& allowed, const LightingPlan& plan,
                                     const RadiositySolution& solution) {
  std::vector<int> luminaires;
  for (const AllowedPlace& place : allowed.moved) {
    const int channel = solution.source_channel[static_cast<std::size_t>(place.lamp)];
    luminaires.push_back(
        static_cast<int>(std::ranges::lower_bound(plan.dimmed, channel) - plan.dimmed.begin()));
  }
  return luminaires;
}

std::vector<Eigen::Vector3d> positions_of(const LightingPlan& plan) {
  std::vector<Eigen::Vector3d> positions;
  for (const Luminaire& luminaire : plan.luminaires) positions.push_back(luminaire.position);
  return positions;
}

LightReceivers receivers_of(const DesignTask& task, const LightingPlan& plan) {
  LightReceivers receivers{.eyes = task.eyes};
  for (const CalculationSurface& surface : plan.surfaces) receivers.grids.push_back(surface.grid);
  return receivers;
}

}  // namespace

MovedDesign move_luminaires(const DesignTask& task, const ReportedScene& of,
                            const SolveWithChannels& solve, const Progress& progress) {
  const AllowedPlaces& allowed = task.places;
  int solves = 0;
  const auto design_of = [&](Scene scene) {
    MovedDesign made{.scene = std::move(scene)};
    made.solved = solve(made.scene);
    ++solves;
    made.plan = design_lighting(task, {made.scene, of.names}, made.solved, progress);
    return made;
  };
  MovedDesign best = design_of(of.scene);
  EarlierPlaces earlier{.positions = positions_of(best.plan),
                        .cost = best.plan.cost,
                        .meets_all = best.plan.meets_all()};
  std::vector<int> lamps;
  for (const AllowedPlace& place : allowed.moved) lamps.push_back(place.lamp);
  PlacedLightOptions effort;
  effort.progress = progress;
  const PlacedLight light(of.scene, lamps, receivers_of(task, best.plan),
                          task.design.luminous_height, effort);
  for (int descent = 0; descent < most_descents; ++descent) {
    const Eigen::Matrix3Xd here = places_of(best.scene, allowed);
    const PlaceOptimum found =
        descend({.light = light,
                 .allowed = allowed,
                 .measured = best.plan.measured,
                 .places = here,
                 .luminaire = luminaires_of_lamps(allowed, best.plan, best.solved.solution),
                 .factor = best.plan.maintenance_factor},
                progress);
    if (!is_worth_a_solve(found)) break;
    bool is_better = false;
    for (const double share : shares_of_way) {
      const auto places = nearest_allowed(allowed, here + share * (found.places - here));
      if (!places) continue;
      MovedDesign made = design_of(with_lamps_at(best.scene, allowed, *places));
      if (!is_better_design(made.plan, best.plan)) continue;
      best = std::move(made);
      is_better = true;
      break;
    }
    if (!is_better) break;
  }
  earlier.solves = solves;
  best.plan.earlier = std::move(earlier);
  return best;
}

}  // namespace lightwell
