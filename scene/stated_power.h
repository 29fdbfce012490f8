#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Amount of the light `power`, W in each band, in the unit of a statement: lm, or the watts of all
/// bands together.
double stated_amount(const Bands& bands, StatedPower unit, const Spectrum& power);

/// Multiplies the emission of a material, even or by a picture, with the same factor in all bands.
void scale_emission(Material& material, float factor);

}  // namespace lightwell
