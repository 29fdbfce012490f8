#pragma once

#include <Eigen/Core>
#include <string>

#include "viewer/export/appearance.h"
#include "viewer/report/words.h"

namespace lightwell {

/// The false colour at a position on the scale in [0,1], clamped, as "#rrggbb".
std::string hex_colour(double place);

/// Steps of colour from bottom to top with their values, as SVG: a bar of 4 mm width at `corner`,
/// its upper left one, and of `height`, mm.
std::string colour_scale_svg(const LuxRange& range, const std::string& unit,
                             const Eigen::Vector2d& corner, double height,
                             Language language = Language::english);

}  // namespace lightwell
