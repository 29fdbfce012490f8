#pragma once

#include <span>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Continues square pictures, row y * size + x for a texel, where `is_known` is 0: `rings` texels
/// outwards by the mean of the neighbours in the ring before, and farther off by ever coarser means
/// of what is around (the pull-push of Gortler, Grzeszczuk, Szeliski & Cohen 1996). Leaves all as
/// it is where nothing is known.
void fill_texels(int size, std::vector<char> is_known, int rings,
                 std::span<BandArray* const> pictures);

}  // namespace lightwell
