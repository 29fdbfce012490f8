#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/limits_file.h"
#include "design/luminaires.h"
#include "scene/progress.h"
#include "standards/requirement.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/make_report.h"

namespace lightwell {

/// Request for the levels that meet limits.
struct DesignRequest {
  LightingLimits limits{};
  std::vector<NamedNumber> watts{};  ///< electric power of each luminaire of the name, W, > 0
  int rays = 1024;                   ///< of the gather at each point, a power of two
};

/// A request whose names were found.
struct DesignTask {
  DesignRequest request{};
  LightingDesign design{};
  std::vector<int> grids{};            ///< limited ones: indices into LightingDesign::grids
  std::vector<Camera> eyes{};          ///< of the limited observers
  std::vector<DimmingLimit> limits{};  ///< in the order of the request
  AllowedPlaces places{};              ///< of the luminaires that may be moved
};

/// Reads the lighting design of a scene and looks up the names of grids and observers, before
/// anything is computed. Throws InputError for a scene without units of light or without
/// luminaires, for a name that is not there, and what read_lighting_design() and allowed_places()
/// throw.
DesignTask plan_design(const Scene& scene, DesignRequest request);

/// A limit, and what was measured at the levels of a plan.
struct LimitOutcome {
  WordedLimit limit{};
  double reached = 0.0;  ///< lx, U_0 or UGR
  /// Bound of the error of `reached`, with odds of about 19 to 1; NaN: unknown. Of UGR: that of the
  /// background luminance, taken as twice the error estimate of the solution.
  double within = 0.0;
  Verdict verdict = Verdict::too_close;
  double at_full = 0.0;  ///< value with all luminaires at full level
  double price = 0.0;    ///< derivative of the least cost by the limit, W or lm for each unit
};

/// A design before its luminaires were moved.
struct EarlierPlaces {
  std::vector<Eigen::Vector3d> positions{};  ///< m, of LightingPlan::luminaires
  double cost = 0.0;                         ///< the least there, W or lm
  bool meets_all = false;                    ///< false: not all limits were met there
  int solves = 0;  ///< of the scene, each with the luminaires in other places
};

/// Levels of luminaires for the least electric power.
struct LightingPlan {
  bool is_feasible = false;  ///< false: no levels meet all limits, and these are the nearest
  bool is_in_watts =
      false;  ///< costs are W; otherwise lm, since the power of a luminaire is unknown
  std::vector<Luminaire> luminaires{};
  std::vector<std::string> groups{};  ///< names of the solution's channels
  std::vector<double> levels{};       ///< per channel, [0,1]; daylight is switched off
  double cost_at_full = 0.0, cost = 0.0;
  /// The least cost for the limits themselves, without the margin that the error of the light asks
  /// for.
  double cost_without_margin = 0.0;
  /// The least cost with all luminaires at one level; empty: no such level meets the limits.
  std::optional<double> cost_of_even{};
  std::vector<LimitOutcome> limits{};
  /// The measured light of each luminaire or group at full level, and the limits without margins.
  DimmingProblem measured{};
  std::vector<int> dimmed{};                   ///< channel of each of `measured`.luminaires
  std::optional<EarlierPlaces> earlier{};      ///< empty: luminaires were not moved
  std::vector<CalculationSurface> surfaces{};  ///< the limited grids, with the light of the levels
  double maintenance_factor = 1.0;
  int rays = 0;
  int measurements = 0;  ///< of levels, each with other random numbers
  std::vector<std::string> notes{};

  /// True if every limit is met, with the bound of the error.
  bool meets_all() const;
};

/// Finds the levels:
///
/// 1. measures the light of each channel by itself, on the grids and for the eyes;
/// 2. solves for the levels of least cost, see best_dimming();
/// 3. relights the solution with them and measures anew, with other random numbers;
/// 4. tightens the limits that are not met by more than the error's bound, and goes back to 2, a
///    few times at most.
///
/// `solved` has channels, of which none mixes luminaires with daylight; afterwards it is relit with
/// the levels. Illuminance is maintained, glare is that of new luminaires. Throws InputError for a
/// solution without such channels, Interrupted when progress
/// says stop.
LightingPlan design_lighting(const DesignTask& task, const ReportedScene& of, SolvedScene& solved,
                             const Progress& progress);

}  // namespace lightwell
