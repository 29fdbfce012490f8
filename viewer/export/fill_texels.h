#pragma once

#include <span>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Fills texels of square pictures where `is_known` is 0; row y * size + x is texel (x, y). Up to
/// `rings` texels from a known one, a texel is the mean of its neighbours in the ring before.
/// Farther away a texel is a mean over ever larger blocks of known texels (the pull-push algorithm
/// of Gortler, Grzeszczuk, Szeliski & Cohen 1996). Without known texels pictures stay unchanged.
void fill_texels(int size, std::vector<char> is_known, int rings,
                 std::span<BandArray* const> pictures);

}  // namespace lightwell
