#include "radiosity/radiation/exchange_areas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr double most_deviation = 0.01;
// Change of S_ii as a share of A_i: most_deviation for closure, and as much for symmetry.
constexpr double most_change = 2.0 * most_deviation;

void check_size(Eigen::Index rows) {
  if (rows == 0) throw InputError("there are no surfaces, so there is no radiant exchange");
  if (rows <= most_radiating_surfaces) return;
  throw InputError(
      fmt::format("{} surfaces are too many for radiant exchange, whose matrices are full; there "
                  "may be {}: join faces, or make fewer",
                  rows, most_radiating_surfaces));
}

void check_numbers(const Eigen::ArrayXd& area, const Eigen::MatrixXd& F,
                   const Eigen::ArrayXd& open) {
  const Eigen::Index n = area.size();
  if (F.rows() != n || F.cols() != n || open.size() != n) {
    throw InputError(
        fmt::format("{} areas, {} x {} view factors and {} open shares do not fit each other", n,
                    F.rows(), F.cols(), open.size()));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_sound = std::isfinite(area[i]) && area[i] >= 0.0 && std::isfinite(open[i]) &&
                          open[i] >= 0.0 && F.row(i).allFinite() && F.row(i).minCoeff() >= 0.0;
    if (is_sound) continue;
    throw InputError(
        fmt::format("row {} of the view factors, its area or its open share has a number that is "
                    "not finite or below 0",
                    i));
  }
}

void check_laws(const Eigen::ArrayXd& area, const Eigen::MatrixXd& F, const Eigen::ArrayXd& open) {
  const Eigen::Index n = area.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double sum = F.row(i).sum() + open[i];
    if (area[i] > 0.0 && !(std::abs(sum - 1.0) <= most_deviation)) {
      throw InputError(
          fmt::format("row {} of the view factors and its open share add up to {:.6g}; they must "
                      "add up to 1, so give what leaves through openings as the open share",
                      i, sum));
    }
    for (Eigen::Index j = 0; j < i; ++j) {
      const double difference = std::abs(area[i] * F(i, j) - area[j] * F(j, i));
      if (difference <= most_deviation * std::min(area[i], area[j])) continue;
      throw InputError(
          fmt::format("view factors {} to {} and back are not reciprocal: A_i F_ij is {:.6g}, "
                      "A_j F_ji {:.6g} m^2",
                      i, j, area[i] * F(i, j), area[j] * F(j, i)));
    }
  }
}

}  // namespace

ExchangeAreas exchange_areas(const Eigen::ArrayXd& area, const Eigen::MatrixXd& F,
                             const Eigen::ArrayXd& open) {
  check_size(area.size());
  check_numbers(area, F, open);
  check_laws(area, F, open);
  ExchangeAreas areas{.area = area, .open = area * open};
  const Eigen::MatrixXd S = area.matrix().asDiagonal() * F;
  areas.between = 0.5 * (S + S.transpose());
  for (Eigen::Index i = 0; i < area.size(); ++i) {
    if (!(area[i] > 0.0)) {
      areas.between.row(i).setZero();
      areas.between.col(i).setZero();
    }
  }
  for (Eigen::Index i = 0; i < area.size(); ++i) {
    areas.between(i, i) = 0.0;
    areas.between(i, i) = area[i] - areas.open[i] - areas.between.row(i).sum();
    const double change = areas.between(i, i) - S(i, i);
    if (std::abs(change) <= most_change * area[i]) continue;
    throw InputError(
        fmt::format("row {} of the view factors is not reciprocal with the others: its factor to "
                    "itself would have to change by {:.3g}; check that the areas are in the order "
                    "of the rows",
                    i, change / area[i]));
  }
  return areas;
}

ExchangeAreas exchange_areas(const ViewFactors& view_factors) {
  const int n = view_factors.row_count();
  check_size(n);
  Eigen::ArrayXd area(n), open(n);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    const auto r = static_cast<std::size_t>(i);
    area[i] = view_factors.area[r];
    open[i] = view_factors.open[r] + view_factors.blocked[r];
    for (const FormFactor& f : view_factors.row(i)) F(i, f.patch) = f.value;
  }
  return exchange_areas(area, F, open);
}

}  // namespace lightwell
