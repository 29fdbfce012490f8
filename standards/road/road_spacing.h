#pragma once

#include <optional>
#include <vector>

#include "scene/progress.h"
#include "standards/road/road.h"

namespace lightwell {

/// Spacings from `least` to `greatest`, m, at each of which a road meets its classes.
struct SpacingRange {
  double least = 0.0, greatest = 0.0;
};

/// The spacings at which a road meets all of its classes, whatever its own spacing is: ranges in
/// rising order, empty if there is none. Tried are all multiples of 0.1 m from half the mounting
/// height, at least 1 m, to 17 mounting heights, 34 of a staggered arrangement, at most 500 m. The
/// luminance of a point is that of luminaires from 5 heights before it to 12 beyond it, and its
/// illuminance that of luminaires within 5 heights, so some point has neither where the next
/// luminaires of all rows are farther apart. Throws Interrupted.
std::vector<SpacingRange> spacings_that_meet(const Road& road, const Progress& progress = {});

/// Distance between the spacings that are tried, m.
inline constexpr double spacing_step = 0.1;

}  // namespace lightwell
