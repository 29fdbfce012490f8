#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/optimum/dimming.h"
#include "design/places/allowed_places.h"
#include "design/places/placed_light.h"
#include "scene/progress.h"

namespace lightwell {

/// A dimming problem whose lamps may be moved. `measured` is the light with the lamps at `places`;
/// elsewhere, the light of a luminaire is what was measured plus what `light` says the move
/// changes:
///
///     E_i(p; x) = E_i(p; x0) + factor (L_i(p; x) - L_i(p; x0))
///
/// so that an error of `light` that is the same at x and x0 is none. The same holds for the parts
/// of glare, without the factor.
struct PlaceProblem {
  const PlacedLight& light;
  const AllowedPlaces& allowed;
  const DimmingProblem& measured;
  Eigen::Matrix3Xd places{};     ///< x0, 3 x lamps, m
  std::vector<int> luminaire{};  ///< of `measured`, for each moved lamp
  double factor = 1.0;           ///< of illuminance: the maintenance factor
};

/// Cost of the best levels with lamps in some places.
struct PlaceCost {
  DimmingPlan plan{};
  /// Derivative by the places of the lamps, 3 x lamps: of the least cost, 1/m, or of what the worst
  /// limit is missed by.
  Eigen::Matrix3Xd gradient{};
};

/// The least cost by best_dimming() with lamps at `places`, and its derivative by the chain rule,
///
///     d cost / d x_i = sum_p (d cost / d E_i(p)) dE_i(p)/dx_i
///
/// and the same for the parts of glare. d cost / d E is DimmingPlan::light_price, since the levels
/// are optimal (envelope theorem; Milgrom & Segal 2002).
PlaceCost cost_at(const PlaceProblem& problem, const Eigen::Matrix3Xd& places);

/// Places that a descent found.
struct PlaceOptimum {
  Eigen::Matrix3Xd places{};    ///< 3 x lamps, m
  DimmingPlan first{}, plan{};  ///< at the places of the problem, and at these
  int steps = 0;                ///< that were taken
  int evaluations = 0;          ///< of cost_at()
};

/// Descends from the places of the problem by projected gradients with backtracking (Goldstein
/// 1964; Armijo 1966): x <- P(x - t g), where P is nearest_allowed() and t is halved until the cost
/// falls by a share of what the gradient promises, and doubled after that.
///
/// The cost has kinks, where another point of a grid becomes the darkest. After a step that failed,
/// g is the shortest vector of the convex hull of the gradients here and where steps failed, which
/// descends on both sides of a kink between (Wolfe 1975). The descent ends where no step of a
/// millimetre helps. The places are no worse than the first ones; others far away may be better.
PlaceOptimum descend(const PlaceProblem& problem, const Progress& progress = {});

}  // namespace lightwell
