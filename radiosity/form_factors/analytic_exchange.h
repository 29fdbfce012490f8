#pragma once

#include <functional>

#include "mesh/patches/patch_outline.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// The closed form of every pair of polygons times their visibility. That is 1 where the shaft
/// between the two (Shafts) holds nothing; exact where it holds a few polygons (visible_exchange):
/// F_ij is good to 1e-6, or to a tenth of `target_error` if that is less. Where spheres or very
/// many polygons stand between, or something lies on one of the two, shadow rays between stratified
/// points of both sample it, weighted as the form factor is: 16 or 64 rays to begin with, up to
/// 2^18 while the standard error of F_ij is above `target_error` (0: 1e-3). Patches of spheres, and
/// patches that lie on each other, are left to other methods. `row_error`, one per
/// patch, is raised to the standard error of the row's worst F_ij. `take(i, row)` gets the exchange
/// of patch i with patches j > i, one row after another. Rows that `phase` holds are not computed
/// again.
void analytic_exchange(const ElementCaster& caster, const std::vector<PatchOutline>& outlines,
                       const std::vector<char>& receives, double target_error,
                       const Progress& progress, std::vector<float>& row_error,
                       const std::function<void(int, std::vector<FormFactor>&)>& take,
                       const JournalPhase& phase = {});

}  // namespace lightwell
