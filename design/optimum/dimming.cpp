#include "design/optimum/dimming.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "design/optimum/linear_program.h"

namespace lightwell {
namespace {

// Programmes of one search at most: a longer one is taken to cycle.
constexpr int most_rounds = 200;

// 4 * 10^(UGR/8): the allowed ratio of sum a d^2 to sum b d.
double glare_ratio(double ugr) {
  return 4.0 * std::pow(10.0, ugr / 8.0);
}

const DimmedGrid& grid_of(const DimmingProblem& problem, const DimmingLimit& limit) {
  return problem.grids[static_cast<std::size_t>(limit.place)];
}

const DimmedObserver& observer_of(const DimmingProblem& problem, const DimmingLimit& limit) {
  return problem.observers[static_cast<std::size_t>(limit.place)];
}

/// A limit as rows of the programme. Each row is divided by `scale`, so that values are about 1.
struct LimitRows {
  int first = 0, count = 0;
  double scale = 1.0;
  int shortfall = -1;  // column of what the limit may be missed by, relative; -1: none
};

/// The linear programme of a dimming problem, and which rows stand for which limit.
class DimmingProgram {
 public:
  // Elastic limits may be missed. What the worst is missed by then costs, and nothing else.
  DimmingProgram(const DimmingProblem& problem, bool is_elastic) : problem_(problem) {
    for (const Dimmable& luminaire : problem.luminaires) total_cost_ += luminaire.cost;
    if (!(total_cost_ > 0.0)) total_cost_ = 1.0;
    for (const Dimmable& luminaire : problem.luminaires) {
      program_.add_column({.cost = is_elastic ? 0.0 : luminaire.cost / total_cost_,
                           .least = luminaire.least,
                           .most = luminaire.most});
    }
    add_squares();
    if (is_elastic) worst_ = program_.add_column({.cost = 1.0});
    for (const DimmingLimit& limit : problem.limits) add_limit(limit);
  }

  // Minimises the sum of what limits are missed by from here on, with the worst missed by no more
  // than in `optimum`.
  void minimise_sum(const LinearOptimum& optimum) {
    column(worst_) = {.cost = 0.0, .most = kept(optimum, worst_)};
    for (const LimitRows& rows : rows_) column(rows.shortfall).cost = 1.0;
  }

  // Minimises the cost of the luminaires from here on, with each limit missed by no more than in
  // `optimum`.
  void minimise_cost(const LinearOptimum& optimum) {
    for (int i = 0; i < count(); ++i) {
      column(i).cost = problem_.luminaires[static_cast<std::size_t>(i)].cost / total_cost_;
    }
    for (const LimitRows& rows : rows_) {
      column(rows.shortfall) = {.cost = 0.0, .most = kept(optimum, rows.shortfall)};
    }
  }

  // The optimum, with tangents added until squares are those of the levels. `rounds` counts the
  // programmes.
  LinearOptimum solve(int& rounds) {
    for (int round = 0; round < most_rounds; ++round) {
      LinearOptimum optimum = solve_linear(program_);
      ++rounds;
      if (!optimum.is_feasible || !add_tangents(optimum.x)) return optimum;
    }
    throw std::runtime_error("the levels for a limit of glare do not converge");
  }

  // The cost of all luminaires at full level, over which costs are those of the programme.
  double total_cost() const { return total_cost_; }

  Eigen::VectorXd levels(const LinearOptimum& optimum) const {
    Eigen::VectorXd d(static_cast<Eigen::Index>(problem_.luminaires.size()));
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      const Dimmable& luminaire = problem_.luminaires[static_cast<std::size_t>(i)];
      d[i] = std::clamp(optimum.x[i], luminaire.least, luminaire.most);
    }
    return d;
  }

  // Derivative of the least cost by the value of a limit: that of the rows' bounds or factors, by
  // the envelope theorem.
  double price(std::size_t k, const LinearOptimum& optimum) const {
    const DimmingLimit& limit = problem_.limits[k];
    const LimitRows& rows = rows_[k];
    double dual = 0.0;
    for (int r = 0; r < rows.count; ++r) dual += optimum.row_price[rows.first + r];
    dual *= total_cost_ / rows.scale;
    const Eigen::VectorXd d = levels(optimum);
    switch (limit.kind) {
      case LimitKind::uniformity_at_least:
        return dual * (grid_of(problem_, limit).lux * d).mean();
      case LimitKind::ugr_at_most:
        return -dual * glare_ratio(limit.value) * std::numbers::ln10 / 8.0 *
               observer_of(problem_, limit).background.dot(d);
      default:
        return dual;
    }
  }

  // Derivatives of the optimum, `unit` times the objective: -y_r d_i for each factor of d_i in a
  // row, and what the scale of the row, which is light as well, changes in the row's value.
  LightPrices light_price(const LinearOptimum& optimum, double unit) const {
    LightPrices prices;
    for (const DimmedGrid& grid : problem_.grids) {
      prices.lux.push_back(Eigen::MatrixXd::Zero(grid.lux.rows(), grid.lux.cols()));
    }
    prices.glare.assign(problem_.observers.size(), Eigen::VectorXd::Zero(count()));
    prices.background = prices.glare;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const auto place = static_cast<std::size_t>(problem_.limits[k].place);
      const LimitRows& rows = rows_[k];
      const Eigen::VectorXd y =
          unit / rows.scale * optimum.row_price.segment(rows.first, rows.count);
      if (problem_.limits[k].kind == LimitKind::ugr_at_most) {
        add_glare_price(k, y[0], optimum, prices.glare[place], prices.background[place]);
      } else {
        add_lux_price(k, y, levels(optimum), prices.lux[place]);
      }
    }
    return prices;
  }

 private:
  int count() const { return static_cast<int>(problem_.luminaires.size()); }
  LinearColumn& column(int i) { return program_.columns[static_cast<std::size_t>(i)]; }

  static double kept(const LinearOptimum& optimum, int column) {
    constexpr double slack = 1e-8;  // the tolerance of rows
    return std::max(0.0, optimum.x[column]) + slack;
  }

  void add_lux_price(std::size_t k, const Eigen::VectorXd& y, const Eigen::VectorXd& d,
                     Eigen::MatrixXd& price) const {
    const DimmingLimit& limit = problem_.limits[k];
    const double points = static_cast<double>(price.rows());
    if (limit.kind == LimitKind::uniformity_at_least) {
      const Eigen::VectorXd E = grid_of(problem_, limit).lux * d;
      const Eigen::VectorXd above = E.array() - limit.value * E.mean();
      price -= (y.array() - limit.value * y.sum() / points).matrix() * d.transpose();
      price.array() += y.dot(above) / rows_[k].scale / points;
    } else if (is_of_mean(limit.kind)) {
      price.rowwise() -= y[0] / points * d.transpose();
    } else {
      price -= y * d.transpose();
    }
  }

  void add_glare_price(std::size_t k, double y, const LinearOptimum& optimum,
                       Eigen::VectorXd& glare, Eigen::VectorXd& background) const {
    const DimmingLimit& limit = problem_.limits[k];
    const DimmedObserver& observer = observer_of(problem_, limit);
    const double ratio = glare_ratio(limit.value);
    const Eigen::VectorXd d = levels(optimum);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(count());
    for (int i = 0; i < count(); ++i) {
      const int t = square_[static_cast<std::size_t>(i)];
      squares[i] = t >= 0 ? optimum.x[t] : d[i] * d[i];
    }
    background -= y * ratio * d;
    glare += y * squares;
    const double value = ratio * observer.background.dot(d) - observer.glare.dot(squares);
    const double of_scale = y * value / rows_[k].scale;
    const bool is_of_background = ratio * observer.background.sum() >= observer.glare.sum();
    (is_of_background ? background : glare).array() += of_scale * (is_of_background ? ratio : 1.0);
  }

  static bool is_of_mean(LimitKind kind) {
    return kind == LimitKind::mean_at_least || kind == LimitKind::mean_at_most;
  }

  // A column t >= d^2 for each luminaire that an observer with a limit sees.
  void add_squares() {
    square_.assign(problem_.luminaires.size(), -1);
    tangents_.resize(problem_.luminaires.size());
    for (const DimmingLimit& limit : problem_.limits) {
      if (limit.kind != LimitKind::ugr_at_most) continue;
      const Eigen::VectorXd& a = observer_of(problem_, limit).glare;
      for (int i = 0; i < count(); ++i) {
        int& column = square_[static_cast<std::size_t>(i)];
        if (!(a[i] > 0.0) || column >= 0) continue;
        column = program_.add_column({});
        const Dimmable& luminaire = problem_.luminaires[static_cast<std::size_t>(i)];
        add_tangent(i, luminaire.most);
        add_tangent(i, 0.5 * (luminaire.least + luminaire.most));
      }
    }
  }

  // t_i >= 2 e d_i - e^2.
  void add_tangent(int i, double e) {
    tangents_[static_cast<std::size_t>(i)].push_back(e);
    program_.rows.push_back(
        {.terms = {{square_[static_cast<std::size_t>(i)], 1.0}, {i, -2.0 * e}}, .least = -e * e});
  }

  // Returns false if t is d^2 already, up to the tolerance of rows. The slopes of the tangents that
  // hold are then right to the root of that, and so are prices.
  bool add_tangents(const Eigen::VectorXd& x) {
    constexpr double exact = 4e-8;
    bool any = false;
    for (int i = 0; i < count(); ++i) {
      const int t = square_[static_cast<std::size_t>(i)];
      if (t < 0 || x[i] * x[i] <= x[t] + exact) continue;
      // A tangent that is there already has the square as exactly as the rows of the programme
      // hold.
      const bool is_there =
          std::ranges::any_of(tangents_[static_cast<std::size_t>(i)],
                              [&](double e) { return (x[i] - e) * (x[i] - e) <= exact; });
      if (is_there) continue;
      add_tangent(i, x[i]);
      any = true;
    }
    return any;
  }

  // An empty row with what the limit may be missed by.
  LinearRow row_with_shortfall(const LimitRows& rows, double sign) const {
    LinearRow row;
    if (rows.shortfall >= 0) row.terms.emplace_back(rows.shortfall, sign);
    return row;
  }

  void add_light(LinearRow& row, const Eigen::Ref<const Eigen::RowVectorXd>& lux) const {
    for (int i = 0; i < count(); ++i) row.terms.emplace_back(i, lux[i]);
  }

  void add_limit(const DimmingLimit& limit) {
    LimitRows rows{.first = static_cast<int>(program_.rows.size()), .scale = limit.value};
    if (worst_ >= 0) {
      rows.shortfall = program_.add_column({});
      program_.rows.push_back({.terms = {{worst_, 1.0}, {rows.shortfall, -1.0}}, .least = 0.0});
      ++rows.first;
    }
    if (limit.kind == LimitKind::ugr_at_most) {
      add_glare(limit, rows);
    } else {
      const Eigen::MatrixXd& lux = grid_of(problem_, limit).lux;
      const Eigen::RowVectorXd mean = lux.colwise().mean();
      if (limit.kind == LimitKind::uniformity_at_least) {
        add_uniformity(limit, lux, mean, rows);
      } else {
        add_illuminance(limit, is_of_mean(limit.kind) ? Eigen::MatrixXd(mean) : lux, rows);
      }
    }
    rows.count = static_cast<int>(program_.rows.size()) - rows.first;
    rows_.push_back(rows);
  }

  // E / value >= 1 - shortfall, or <= 1 + shortfall.
  void add_illuminance(const DimmingLimit& limit, const Eigen::MatrixXd& lux,
                       const LimitRows& rows) {
    const bool is_lower = is_lower_limit(limit.kind);
    for (Eigen::Index p = 0; p < lux.rows(); ++p) {
      LinearRow row = row_with_shortfall(rows, is_lower ? 1.0 : -1.0);
      add_light(row, lux.row(p) / rows.scale);
      (is_lower ? row.least : row.most) = 1.0;
      program_.rows.push_back(std::move(row));
    }
  }

  // E_p - U_0 E_m >= -shortfall U_0 E, all over E, the mean at full level.
  void add_uniformity(const DimmingLimit& limit, const Eigen::MatrixXd& lux,
                      const Eigen::RowVectorXd& mean, LimitRows& rows) {
    rows.scale = mean.sum() > 0.0 ? mean.sum() : 1.0;
    for (Eigen::Index p = 0; p < lux.rows(); ++p) {
      LinearRow row = row_with_shortfall(rows, limit.value);
      add_light(row, (lux.row(p) - limit.value * mean) / rows.scale);
      row.least = 0.0;
      program_.rows.push_back(std::move(row));
    }
  }

  // ratio sum b d - sum a t >= -shortfall S, all over S, the larger sum at full level.
  void add_glare(const DimmingLimit& limit, LimitRows& rows) {
    const DimmedObserver& observer = observer_of(problem_, limit);
    const double ratio = glare_ratio(limit.value);
    const double sum = std::max(ratio * observer.background.sum(), observer.glare.sum());
    rows.scale = sum > 0.0 ? sum : 1.0;
    LinearRow row = row_with_shortfall(rows, 1.0);
    add_light(row, ratio / rows.scale * observer.background.transpose());
    for (int i = 0; i < count(); ++i) {
      const int t = square_[static_cast<std::size_t>(i)];
      if (t >= 0) row.terms.emplace_back(t, -observer.glare[i] / rows.scale);
    }
    row.least = 0.0;
    program_.rows.push_back(std::move(row));
  }

  const DimmingProblem& problem_;
  double total_cost_ = 0.0;
  LinearProgram program_{};
  int worst_ = -1;             // column of the largest shortfall; -1: limits are not elastic
  std::vector<int> square_{};  // column of t_i per luminaire; -1: none
  std::vector<std::vector<double>> tangents_{};  // places per luminaire
  std::vector<LimitRows> rows_{};
};

}  // namespace

bool is_lower_limit(LimitKind kind) {
  return kind == LimitKind::mean_at_least || kind == LimitKind::least_at_least ||
         kind == LimitKind::uniformity_at_least;
}

double value_at(const DimmingProblem& problem, const DimmingLimit& limit,
                const Eigen::VectorXd& levels) {
  if (limit.kind == LimitKind::ugr_at_most) {
    const DimmedObserver& observer = observer_of(problem, limit);
    const double background = observer.background.dot(levels);
    const double glare = observer.glare.dot(levels.cwiseAbs2());
    if (!(glare > 0.0)) return 0.0;
    if (!(background > 0.0)) return std::numeric_limits<double>::infinity();
    return std::max(0.0, 8.0 * std::log10(0.25 * glare / background));
  }
  const Eigen::VectorXd lux = grid_of(problem, limit).lux * levels;
  switch (limit.kind) {
    case LimitKind::least_at_least:
      return lux.minCoeff();
    case LimitKind::greatest_at_most:
      return lux.maxCoeff();
    case LimitKind::uniformity_at_least:
      return lux.mean() > 0.0 ? lux.minCoeff() / lux.mean() : 0.0;
    default:
      return lux.mean();
  }
}

DimmingPlan best_dimming(const DimmingProblem& problem) {
  DimmingPlan plan;
  DimmingProgram strict(problem, false);
  LinearOptimum optimum = strict.solve(plan.rounds);
  plan.is_feasible = optimum.is_feasible;
  if (plan.is_feasible) {
    plan.levels = strict.levels(optimum);
    for (std::size_t k = 0; k < problem.limits.size(); ++k) {
      plan.price.push_back(strict.price(k, optimum));
    }
    plan.light_price = strict.light_price(optimum, strict.total_cost());
  } else {
    DimmingProgram elastic(problem, true);
    optimum = elastic.solve(plan.rounds);
    if (!optimum.is_feasible) {
      throw std::runtime_error("the linear programme of the nearest levels has no solution");
    }
    plan.worst_miss = std::max(0.0, optimum.cost);
    plan.light_price = elastic.light_price(optimum, 1.0);
    for (const auto next : {&DimmingProgram::minimise_sum, &DimmingProgram::minimise_cost}) {
      (elastic.*next)(optimum);
      LinearOptimum better = elastic.solve(plan.rounds);
      if (!better.is_feasible) break;  // by rounding
      optimum = std::move(better);
    }
    plan.levels = elastic.levels(optimum);
    plan.price.assign(problem.limits.size(), 0.0);
  }
  for (Eigen::Index i = 0; i < plan.levels.size(); ++i) {
    plan.cost += problem.luminaires[static_cast<std::size_t>(i)].cost * plan.levels[i];
  }
  for (const DimmingLimit& limit : problem.limits) {
    plan.reached.push_back(value_at(problem, limit, plan.levels));
  }
  return plan;
}

DimmingProblem dimmed_evenly(const DimmingProblem& problem) {
  DimmingProblem even{.luminaires = {{.name = "all"}}, .limits = problem.limits};
  Dimmable& all = even.luminaires.front();
  for (const Dimmable& luminaire : problem.luminaires) {
    all.cost += luminaire.cost;
    all.least = std::max(all.least, luminaire.least);
    all.most = std::min(all.most, luminaire.most);
  }
  all.least = std::min(all.least, all.most);
  for (const DimmedGrid& grid : problem.grids) {
    even.grids.push_back({.name = grid.name, .lux = grid.lux.rowwise().sum()});
  }
  for (const DimmedObserver& observer : problem.observers) {
    even.observers.push_back(
        {.name = observer.name,
         .glare = Eigen::VectorXd::Constant(1, observer.glare.sum()),
         .background = Eigen::VectorXd::Constant(1, observer.background.sum())});
  }
  return even;
}

}  // namespace lightwell
