#pragma once

#include <tuple>
#include <vector>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// What one method alone found out about the form factors of patch i, before it is joined with what
/// the patches at the other ends found out. Shares of what leaves the patch; in all they are 1.
struct EstimatedRow {
  /// How much S_ij = A_i F_ij from this row counts against S_ji from the other end: the inverse of
  /// its variance, up to a factor common to all rows of a method. 0: the row is empty.
  double inverse_variance = 0.0;
  std::vector<FormFactor> shares{};  ///< first arrivals at diffuse patches, ordered by patch
  /// Per share, if asked for: rays that would have met the front of the patch, had nothing stood
  /// before it.
  std::vector<int> hidden{};
  double escaped = 0.0;               ///< met nothing or a black back at once
  double specular = 0.0;              ///< first met something that is purely mirror or glass
  std::vector<int> specular_patch{};  ///< reached by way of mirrors and glass, ordered
  BandArray specular_share{};         ///< one row per specular_patch
  Spectrum specular_escaped{}, absorbed{}, cut{};  ///< lost behind mirrors and glass
  double rays = 0.0;                               ///< cast in all, for the report
};

/// What of a row is needed after `hidden` was looked at.
inline auto kept_parts(EstimatedRow& row) {
  return std::tie(row.inverse_variance, row.shares, row.escaped, row.specular, row.specular_patch,
                  row.specular_share, row.specular_escaped, row.absorbed, row.cut, row.rays);
}

}  // namespace lightwell
