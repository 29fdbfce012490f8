#include "radiosity/radiation/shortwave.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/errors.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

void check_light(const ViewFactors& view_factors, const Eigen::ArrayXd& first,
                 const Eigen::ArrayXd& albedo) {
  const int n = view_factors.row_count();
  if (first.size() != n || albedo.size() != n) {
    throw InputError(fmt::format("{} irradiances and {} albedos are given for {} rows",
                                 first.size(), albedo.size(), n));
  }
  for (int i = 0; i < n; ++i) {
    if (!(albedo[i] >= 0.0 && albedo[i] <= highest_albedo)) {
      throw InputError(fmt::format("row {}: its albedo is {}; it must lie between 0 and {}", i + 1,
                                   albedo[i], highest_albedo));
    }
    if (!(first[i] >= 0.0 && std::isfinite(first[i]))) {
      throw InputError(
          fmt::format("row {}: its irradiance by sun and sky is {} W/m2; it must be a "
                      "number from 0 up",
                      i + 1, first[i]));
    }
  }
}

double reflected_onto(const ViewFactors& F, int i, const Eigen::ArrayXd& albedo,
                      const Eigen::ArrayXd& E) {
  double sum = 0.0;
  for (const FormFactor& f : F.row(i)) sum += double{f.value} * albedo[f.patch] * E[f.patch];
  return sum;
}

}  // namespace

ShortwaveExchange shortwave_exchange(const ViewFactors& view_factors, const Eigen::ArrayXd& first,
                                     const Eigen::ArrayXd& albedo) {
  check_light(view_factors, first, albedo);
  const int n = view_factors.row_count();
  Eigen::ArrayXd E = first;
  // Light loses at least the share 1 - highest_albedo in each sweep: a change of 1e-10 leaves an
  // error of 1e-8, and 2500 sweeps lead there.
  constexpr double least_change = 1e-10;
  constexpr int most_sweeps = 4000;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0.0;
    for (int i = 0; i < n; ++i) {
      const double here = first[i] + reflected_onto(view_factors, i, albedo, E);
      change = std::max(change, std::abs(here - E[i]));
      E[i] = here;
    }
    if (n == 0 || change <= least_change * E.maxCoeff()) break;
  }
  ShortwaveExchange result{.reflected = E - first, .net = (1.0 - albedo) * E};
  for (int i = 0; i < n; ++i) {
    const auto r = static_cast<std::size_t>(i);
    const double A = view_factors.area[r];
    result.arriving += A * first[i];
    result.absorbed += A * result.net[i];
    result.escaped += A * (view_factors.open[r] + view_factors.blocked[r]) * albedo[i] * E[i];
  }
  return result;
}

std::vector<ShortwaveExchange> shortwave_exchanges(const ViewFactors& view_factors,
                                                   std::span<const Eigen::ArrayXd> first,
                                                   const Eigen::ArrayXd& albedo) {
  std::vector<ShortwaveExchange> results(first.size());
  parallel_for(static_cast<int>(first.size()), 1, [&](int begin, int end) {
    for (auto h = static_cast<std::size_t>(begin); h < static_cast<std::size_t>(end); ++h) {
      results[h] = shortwave_exchange(view_factors, first[h], albedo);
    }
  });
  return results;
}

}  // namespace lightwell
