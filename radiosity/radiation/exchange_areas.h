#pragma once

#include <Eigen/Core>

#include "radiosity/form_factors/view_factors.h"

namespace lightwell {

/// Most surfaces of an enclosure: matrices of so many rows take 0.13 GB each, and their
/// factorization half a minute.
inline constexpr int most_radiating_surfaces = 4096;

/// Exchange areas of the surfaces of an enclosure, and of its openings to the surroundings:
///
///     S_ij = A_i F_ij = S_ji,     sum_j S_ij + open_i = A_i.
struct ExchangeAreas {
  Eigen::ArrayXd area{};      ///< A_i, m^2, >= 0
  Eigen::ArrayXd open{};      ///< m^2: A_i times the share that reaches the surroundings
  Eigen::MatrixXd between{};  ///< S_ij, m^2

  int count() const { return static_cast<int>(area.size()); }
};

/// Exchange areas of areas A_i (m^2), view factors F_ij (n x n) and shares `open` of each row that
/// reach the surroundings. S_ij is the mean of A_i F_ij and A_j F_ji. The diagonal takes up what a
/// row lacks for closure, such as the rounding of its factors. A surface without area exchanges
/// nothing.
///
/// Throws InputError that names the row
///   - for sizes that differ, for no rows or more than most_radiating_surfaces, and for
///     numbers that are not finite or below 0;
///   - if A_i F_ij and A_j F_ji differ by more than 1 % of the smaller area, or a row and its open
///     share do not add up to 1 within 1 %;
///   - if symmetry and closure together move S_ii by more than 2 % of A_i from A_i F_ii: many small
///     differences between A_i F_ij and A_j F_ji add up.
ExchangeAreas exchange_areas(const Eigen::ArrayXd& area, const Eigen::MatrixXd& F,
                             const Eigen::ArrayXd& open);

/// Exchange areas of the rows of view factors. Shares that meet surfaces without a row count as
/// open.
ExchangeAreas exchange_areas(const ViewFactors& view_factors);

}  // namespace lightwell
