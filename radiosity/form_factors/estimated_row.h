#pragma once

#include <tuple>
#include <vector>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// Estimate of the form factors of patch i by one method, before it is joined with the estimates of
/// the patches at the other ends. Shares of what leaves the patch; their sum is 1, or 1 in the mean
/// where rays are aimed at openings.
struct EstimatedRow {
  /// Weight of S_ij = A_i F_ij of this row against S_ji from the other end: the inverse of its
  /// variance, up to a factor common to all rows of a method. 0: the row is empty.
  double inverse_variance = 0.0;
  std::vector<FormFactor> shares{};  ///< first arrivals at diffuse patches, ordered by patch
  /// Per share, with count_hidden: rays that would have met the front of the patch without
  /// occluders. Otherwise empty.
  std::vector<int> hidden{};
  double escaped = 0.0;  ///< share that met nothing or a black back at once
  /// Share that first met a purely specular surface (mirror or glass).
  double specular = 0.0;
  std::vector<int> specular_patch{};  ///< patches reached through mirrors and glass, ascending
  BandArray specular_share{};         ///< one row per entry of specular_patch
  Spectrum specular_escaped{}, absorbed{}, cut{};  ///< lost behind mirrors and glass, per band
  double rays = 0.0;                               ///< number of rays, for the report
};

/// The parts of a row that a journal keeps: all but `hidden`.
inline auto kept_parts(EstimatedRow& row) {
  return std::tie(row.inverse_variance, row.shares, row.escaped, row.specular, row.specular_patch,
                  row.specular_share, row.specular_escaped, row.absorbed, row.cut, row.rays);
}

}  // namespace lightwell
