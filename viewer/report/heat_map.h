#pragma once

#include <span>
#include <string>

#include "viewer/export/appearance.h"

namespace lightwell {

/// The hours of a year in false colours, as SVG in millimetres of paper: days from left to right,
/// hours of the day in standard time from bottom to top. `values` has one for each hour of the
/// year, 8760 or 8784.
std::string heat_map_svg(std::span<const float> values, const LuxRange& range,
                         const std::string& unit);

}  // namespace lightwell
