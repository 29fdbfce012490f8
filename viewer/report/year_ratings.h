#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "viewer/report/year_report.h"

namespace lightwell {

/// Sections of a page on ratings and on the energy of lamps; empty without both.
std::string rating_sections(const YearReport& report);

/// Ratings with their figures, limits and verdicts, an object each.
nlohmann::ordered_json ratings_json(const YearReport& report);

/// Daylight dependency and energy of a room with lighting.
nlohmann::ordered_json lighting_json(const YearRoom& room);

/// Points of each rating, with a line for each limit that is not surely met; a line of energy for
/// each room with lighting.
std::string ratings_text(const YearReport& report);

/// The same figures as a table, CSV: a line for each figure of a rating and of the energy of lamps.
std::string rooms_csv(const YearReport& report);

}  // namespace lightwell
