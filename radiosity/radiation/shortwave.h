#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "radiosity/form_factors/view_factors.h"

namespace lightwell {

/// Highest albedo for which shortwave_exchange() finds the sum of all reflections.
inline constexpr double highest_albedo = 0.99;

/// Sun and sky on diffuse surfaces, with all reflections; one entry for each row, W/m^2.
struct ShortwaveExchange {
  Eigen::ArrayXd reflected{};  ///< irradiance by light that other rows, or the row itself, reflect
  Eigen::ArrayXd net{};        ///< absorbed, (1 - albedo) E: net shortwave flux into the surface
  double arriving = 0.0;       ///< W, from sun and sky on all rows
  double absorbed = 0.0;       ///< W, by all rows
  double escaped = 0.0;        ///< W, reflected out of the openings
};

/// Solves E_i = first_i + sum_j F_ij albedo_j E_j by Gauss-Seidel's method.
///
/// `first`: irradiance by sun and sky, W/m^2, >= 0; `albedo`: [0, highest_albedo]. Absorbed and
/// escaped power add up to what arrives within 1e-6, the rounding of view factors. Throws
/// InputError that names the row for numbers out of range, and if there are not as many as rows.
ShortwaveExchange shortwave_exchange(const ViewFactors& view_factors, const Eigen::ArrayXd& first,
                                     const Eigen::ArrayXd& albedo);

/// The same for each of many instants, `first`, in parallel.
std::vector<ShortwaveExchange> shortwave_exchanges(const ViewFactors& view_factors,
                                                   std::span<const Eigen::ArrayXd> first,
                                                   const Eigen::ArrayXd& albedo);

}  // namespace lightwell
