#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Indirect light that coated bases get, over the irradiance it makes, at vertices:
///
///     gain = int L g cos dw / int L cos dw,      g: CoatedBase::factor()
///
/// vertices x channels of `radiosity` (W/m^2, vertices x columns, as gatherable_radiosity() makes
/// it); 1 without a coat and in even light. Rays from the middle of each coated element find L:
/// `most_rays`, or fewer where there are many elements. Empty if no surface has a coat.
BandArray indirect_base_gains(const LitScene& lit, const BandArray& radiosity, int most_rays);

/// gatherable_radiosity() with the gains of indirect light, too: the rest of `irradiance` beside
/// `direct` counts times indirect_base_gains() of the radiosity without these gains.
BandArray gatherable_radiosity(const LitScene& lit, const BandArray& irradiance,
                               const Eigen::Ref<const BandArray>& direct);
/// The same for the light of a solution.
BandArray gatherable_radiosity(const LitScene& lit, const RadiositySolution& solution);

}  // namespace lightwell
