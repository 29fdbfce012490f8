#pragma once

#include <functional>

#include "mesh/patches/patch_outline.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Patches whose pairs exchange light, and the accuracy of their visibility.
struct PolygonPairs {
  const ElementCaster& caster;
  const std::vector<PatchOutline>& outlines;
  const std::vector<char>& receives;  ///< per patch: takes part in diffuse exchange
  double target_error = 0.0;          ///< wanted standard error of F_ij; 0: 1e-3
};

/// Errors that analytic_exchange() fills in, one entry per patch each: standard errors of sampled
/// visibility, bounds of closed forms, and the rounding of the stored floats.
struct AnalyticErrors {
  std::vector<float>& worst;  ///< raised to the error of the row's worst F_ij
  std::vector<float>& sum;    ///< raised by the errors of all F_ij of the row
  std::vector<float>& bias;   ///< raised by the bounds of the closed forms of the row
};

/// Exchange areas S_ij = A_i F_ij of all pairs of polygons: the closed form times the visibility of
/// the pair. Methods for the visibility:
///   - 1 where the shaft between the patches (Shafts) is empty;
///   - exact where the shaft holds few polygons (visible_exchange): F_ij has an error of at most
///     1e-6, or of a tenth of `target_error` if that is less;
///   - sampled where round shapes or many polygons stand between, or a surface lies on one of the
///     patches: shadow rays between stratified points of both, weighted by the kernel of the form
///     factor. 16 or 64 rays at first, up to 2^18 while the standard error of F_ij is above
///     `target_error` (0: 1e-3).
///
/// Patches of round shapes, and patches that lie on each other, are left to other methods. `take(i,
/// row)` gets the exchange of patch i with patches j > i, row after row. Rows that `phase` holds
/// are recalled.
void analytic_exchange(const PolygonPairs& pairs, const Progress& progress, AnalyticErrors errors,
                       const std::function<void(int, std::vector<FormFactor>&)>& take,
                       const JournalPhase& phase = {});

}  // namespace lightwell
