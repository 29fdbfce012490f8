#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/io/room_use.h"
#include "viewer/report/year_report.h"

namespace lightwell {

/// Gives rooms the use of the first table whose name or pattern fits theirs, and the area of their
/// grid where the table has none. Throws InputError for a table that fits no room, and for a power
/// without an area.
void use_rooms(std::span<const RoomUse> uses, std::vector<YearRoom>& rooms);

/// Throws InputError if no room is regularly occupied, so that nothing can be rated.
void require_occupied_rooms(std::span<const YearRoom> rooms);

/// A rating of a year, and the rooms' standing.
struct RatedYear {
  const DaylightRating& rating;
  RatedDaylight daylight{};
};

/// The regularly occupied rooms held to the ratings of the report; each room counts by its area,
/// or by its sensors where the area of one is not known.
std::vector<RatedYear> rate_year(const YearReport& report);

/// True if the area of each regularly occupied room is known.
bool has_areas(const YearReport& report);

/// Energy of a room's lamps in a year.
struct LampEnergy {
  BoundedFigure saved_share{};  ///< share that daylight saves of all energy in occupied hours
  /// LENI, kWh/m^2, and what daylight saves of it; without meaning where the power is not known.
  BoundedFigure indicator{}, saved{};
};

/// Energy of a room with `lighting`, by EN 15193-1 with F_D of the year's own hours.
LampEnergy lamp_energy(const YearRoom& room);

/// Text of a control: "dimmed, standby 10 %, each sensor by itself".
std::string control_text(const RoomLighting& lighting);

}  // namespace lightwell
