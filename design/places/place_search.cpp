#include "design/places/place_search.h"

#include <algorithm>
#include <utility>

namespace lightwell {
namespace {

// Luminaires are not hung more exactly, m.
constexpr double shortest_step = 1e-3;

// Evaluations of one descent at most; each takes the direct light of all lamps on all patches.
constexpr int most_evaluations = 80;

// Objective of a plan, to be compared between plans that are both feasible or both not.
double objective(const DimmingPlan& plan) {
  return plan.is_feasible ? plan.cost : plan.worst_miss;
}

// True if the step from `from` to `to` lowers the objective by a share of what the gradient
// promises (Armijo's rule).
bool falls_enough(const PlaceCost& from, const DimmingPlan& to, const Eigen::Matrix3Xd& step) {
  if (from.plan.is_feasible != to.is_feasible) return to.is_feasible;
  constexpr double share = 1e-4;
  const double promised = std::min(0.0, from.gradient.cwiseProduct(step).sum());
  const double fall = objective(from.plan) - objective(to);
  return fall > 0.0 && fall >= -share * promised;
}

double longest_step(const Eigen::Matrix3Xd& step) {
  return step.cols() > 0 ? step.colwise().norm().maxCoeff() : 0.0;
}

// The gradient along the axes that lamps may be moved on, and not out of their boxes.
Eigen::Matrix3Xd free_part(const AllowedPlaces& allowed, const Eigen::Matrix3Xd& places,
                           Eigen::Matrix3Xd gradient) {
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const AllowedPlace& box = allowed.moved[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_low = places(axis, i) <= box.low[axis] && gradient(axis, i) > 0.0;
      const bool is_high = places(axis, i) >= box.high[axis] && gradient(axis, i) < 0.0;
      if (is_low || is_high) gradient(axis, i) = 0.0;
    }
  }
  return gradient;
}

// The problem with the light that moves change. What was measured has noise, which a change may
// leave below zero.
DimmingProblem moved_problem(const PlaceProblem& problem, const PlacedReadings& before,
                             const PlacedReadings& here) {
  DimmingProblem moved = problem.measured;
  for (Eigen::Index i = 0; i < here.lux.value.cols(); ++i) {
    const int luminaire = problem.luminaire[static_cast<std::size_t>(i)];
    const auto change = [&](const PlacedValues PlacedReadings::*of) -> Eigen::VectorXd {
      return (here.*of).value.col(i) - (before.*of).value.col(i);
    };
    const Eigen::VectorXd lux = problem.factor * change(&PlacedReadings::lux);
    Eigen::Index first = 0;
    for (DimmedGrid& grid : moved.grids) {
      grid.lux.col(luminaire) += lux.segment(first, grid.lux.rows());
      first += grid.lux.rows();
    }
    const Eigen::VectorXd glare = change(&PlacedReadings::glare),
                          background = change(&PlacedReadings::background);
    for (std::size_t o = 0; o < moved.observers.size(); ++o) {
      moved.observers[o].glare[luminaire] += glare[static_cast<Eigen::Index>(o)];
      moved.observers[o].background[luminaire] += background[static_cast<Eigen::Index>(o)];
    }
  }
  for (DimmedGrid& grid : moved.grids) grid.lux = grid.lux.cwiseMax(0.0);
  for (DimmedObserver& observer : moved.observers) {
    observer.glare = observer.glare.cwiseMax(0.0);
    observer.background = observer.background.cwiseMax(0.0);
  }
  return moved;
}

PlaceCost cost_of(const PlaceProblem& problem, const PlacedReadings& before,
                  const PlacedReadings& here) {
  const Eigen::Index lamps = here.lux.value.cols();
  PlaceCost cost{.plan = best_dimming(moved_problem(problem, before, here)),
                 .gradient = Eigen::Matrix3Xd::Zero(3, lamps)};
  const LightPrices& price = cost.plan.light_price;
  for (Eigen::Index i = 0; i < lamps; ++i) {
    const int luminaire = problem.luminaire[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      const auto slope = [&](const PlacedValues& of) {
        return of.slope[static_cast<std::size_t>(axis)].col(i);
      };
      double& sum = cost.gradient(axis, i);
      Eigen::Index first = 0;
      for (const Eigen::MatrixXd& of_grid : price.lux) {
        sum += problem.factor *
               of_grid.col(luminaire).dot(slope(here.lux).segment(first, of_grid.rows()));
        first += of_grid.rows();
      }
      for (std::size_t o = 0; o < price.glare.size(); ++o) {
        const auto eye = static_cast<Eigen::Index>(o);
        sum += price.glare[o][luminaire] * slope(here.glare)[eye] +
               price.background[o][luminaire] * slope(here.background)[eye];
      }
    }
  }
  return cost;
}

}  // namespace

PlaceCost cost_at(const PlaceProblem& problem, const Eigen::Matrix3Xd& places) {
  return cost_of(problem, problem.light.at(problem.places), problem.light.at(places));
}

namespace {

// The shortest vector of the convex hull of gradients, which descends on both sides of a kink
// (Wolfe 1975): by exact steps towards the gradient that most lowers the length (Gilbert 1966).
Eigen::Matrix3Xd shortest_of_hull(const std::vector<Eigen::Matrix3Xd>& gradients) {
  Eigen::Matrix3Xd shortest = gradients.front();
  constexpr int most_approaches = 100;  // the length falls as 1 over their number
  for (int i = 0; i < most_approaches; ++i) {
    const auto product = [&](const Eigen::Matrix3Xd& g) { return g.cwiseProduct(shortest).sum(); };
    const Eigen::Matrix3Xd& g = *std::ranges::min_element(gradients, {}, product);
    const Eigen::Matrix3Xd way = g - shortest;
    const double length = way.squaredNorm();
    if (!(length > 0.0)) break;
    const double t = std::clamp(-way.cwiseProduct(shortest).sum() / length, 0.0, 1.0);
    if (!(t > 0.0)) break;
    shortest += t * way;
  }
  return shortest;
}

// Length of the longest edge of the boxes, m.
double longest_edge(const AllowedPlaces& allowed) {
  double longest = 0.0;
  for (const AllowedPlace& box : allowed.moved) {
    longest = std::max(longest, (box.high - box.low).maxCoeff());
  }
  return longest;
}

}  // namespace

PlaceOptimum descend(const PlaceProblem& problem, const Progress& progress) {
  PlaceOptimum best{.places = problem.places};
  const PlacedReadings before = problem.light.at(problem.places);
  PlaceCost here = cost_of(problem, before, before);
  best.first = here.plan;
  const double longest = longest_edge(problem.allowed);
  double reach = 0.125 * longest;  // m: a few steps lead through a room, and each can turn
  const auto free_gradient = [&](const PlaceCost& cost) {
    return free_part(problem.allowed, best.places, cost.gradient);
  };
  std::vector<Eigen::Matrix3Xd> gradients = {free_gradient(here)};  // here and where steps failed
  while (reach >= shortest_step && best.evaluations < most_evaluations) {
    report(progress, "places", static_cast<double>(best.evaluations) / most_evaluations);
    const Eigen::Matrix3Xd g = shortest_of_hull(gradients);
    const double steepest = longest_step(g);
    if (!(steepest > 0.0)) break;
    const auto places = nearest_allowed(problem.allowed, best.places - reach / steepest * g);
    if (!places || longest_step(*places - best.places) < 0.5 * shortest_step) {
      reach *= 0.5;
      continue;
    }
    ++best.evaluations;
    PlaceCost there = cost_of(problem, before, problem.light.at(*places));
    if (!falls_enough(here, there.plan, *places - best.places)) {
      if (there.plan.is_feasible == here.plan.is_feasible)
        gradients.push_back(free_gradient(there));
      reach *= 0.5;
      continue;
    }
    best.places = *places;
    here = std::move(there);
    gradients = {free_gradient(here)};
    reach = std::min(2.0 * reach, longest);
    ++best.steps;
  }
  best.plan = std::move(here.plan);
  return best;
}

}  // namespace lightwell
