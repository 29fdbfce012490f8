#pragma once

#include <string>

#include "standards/road/road_figures.h"

namespace lightwell {

/// A plan of values over a road in false colours with lines of equal values, as SVG in millimetres
/// of paper: edges of the carriageway, lanes, strips, luminaires. `number` differs for the plans of
/// one page.
std::string road_plan_svg(const Road& road, const RoadField& values, const std::string& unit,
                          int number);

/// A cross-section of a road as its drivers see it, as SVG in millimetres of paper: carriageways,
/// lanes, strips, masts and luminaires, with their measures.
std::string road_section_svg(const Road& road);

}  // namespace lightwell
