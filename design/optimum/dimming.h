#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lightwell {

/// A luminaire, or several that are dimmed together.
struct Dimmable {
  std::string name{};
  double cost = 0.0;   ///< at full level, >= 0: electric power in W, or luminous flux in lm
  double least = 0.0;  ///< lowest level, [0,1]
  double most = 1.0;   ///< highest level, [least,1]
};

/// Light of each luminaire at full level on a grid: points x luminaires, lx, >= 0. There is at
/// least one point.
struct DimmedGrid {
  std::string name{};
  Eigen::MatrixXd lux{};
};

/// Parts of the unified glare rating of an observer, per luminaire at full level. At levels
/// d, UGR = 8 log10(0.25 sum_i glare_i d_i^2 / sum_i background_i d_i): the luminance of a source
/// goes with its level, and so does the light of the background.
struct DimmedObserver {
  std::string name{};
  Eigen::VectorXd glare{};       ///< sum L^2 w / p^2, cd^2/m^4 sr (see GlareSource::share), >= 0
  Eigen::VectorXd background{};  ///< part of L_b, cd/m^2, >= 0
};

/// Quantities that are limited. On a grid: mean, least and greatest illuminance, lx, and uniformity
/// U_0 = least / mean; for an observer: UGR.
enum class LimitKind {
  mean_at_least,
  mean_at_most,
  least_at_least,
  greatest_at_most,
  uniformity_at_least,
  ugr_at_most
};

/// True if a value above that of the limit meets it.
bool is_lower_limit(LimitKind kind);

/// A limit on the light of a grid, or of an observer for LimitKind::ugr_at_most.
struct DimmingLimit {
  LimitKind kind = LimitKind::mean_at_least;
  int place = 0;       ///< index into the grids, or into the observers
  double value = 0.0;  ///< > 0; uniformity at most 1
};

struct DimmingProblem {
  std::vector<Dimmable> luminaires{};
  std::vector<DimmedGrid> grids{};
  std::vector<DimmedObserver> observers{};
  std::vector<DimmingLimit> limits{};
};

/// Derivatives of an optimum by the light of each luminaire at full level, in its unit over that of
/// the light; 0 where no limit binds.
struct LightPrices {
  std::vector<Eigen::MatrixXd> lux{};         ///< per grid, points x luminaires
  std::vector<Eigen::VectorXd> glare{};       ///< per observer, by DimmedObserver::glare
  std::vector<Eigen::VectorXd> background{};  ///< per observer, by DimmedObserver::background
};

/// The levels of the least cost.
struct DimmingPlan {
  bool is_feasible = false;       ///< true: all limits are met; false: the levels are the nearest
  Eigen::VectorXd levels{};       ///< per luminaire, [least, most]
  double cost = 0.0;              ///< sum_i cost_i d_i
  std::vector<double> reached{};  ///< per limit: the value at these levels
  /// Per limit: derivative of the least cost by the value of the limit (the dual value); 0 of a
  /// limit that does not bind, and for a plan that is not feasible.
  std::vector<double> price{};
  /// Largest miss of a limit, relative (see best_dimming()); 0 for a plan that is feasible.
  double worst_miss = 0.0;
  /// Derivatives of the least cost, or of `worst_miss` for a plan that is not feasible.
  LightPrices light_price{};
  int rounds = 0;  ///< linear programmes that were solved
};

/// The value of a limited quantity at the levels; 0 without light.
double value_at(const DimmingProblem& problem, const DimmingLimit& limit,
                const Eigen::VectorXd& levels);

/// The levels of least cost that meet all limits: a linear programme, since light is linear in the
/// levels. A limit of UGR is the convex constraint
///
///     sum_i a_i d_i^2 <= 4 * 10^(UGR/8) sum_i b_i d_i,
///
/// in which t_i stands for d_i^2. Tangents t_i >= 2 e d_i - e^2 are added at the levels e of each
/// optimum until squares are right to 4e-8 (cutting planes: Kelley 1960; a variable for each
/// square: Vielma, Dunning, Huchette & Lubin 2017).
///
/// If no levels meet all limits, the limits may be missed (elastic programming: Brown & Graves
/// 1975). What the worst is missed by, relative to its value, is then as small as possible
/// (Chebyshev goal programming: Flavell 1976); among such levels the sum of what all are missed by;
/// among these the cost. Uniformity is missed relative to the mean at full level, glare relative to
/// its sum there.
///
/// The light of a luminaire is a factor A_ri of the programme's rows, A d >= b, whose dual values y
/// are the derivatives of the least cost by b. By the envelope theorem (Milgrom & Segal 2002)
/// d cost / d A_ri = -y_r d_i; DimmingPlan::light_price has the sums of these. Throws as
/// solve_linear() does.
DimmingPlan best_dimming(const DimmingProblem& problem);

/// The same problem with all luminaires at one level, which is between the highest `least` and the
/// lowest `most`.
DimmingProblem dimmed_evenly(const DimmingProblem& problem);

}  // namespace lightwell
