#pragma once

#include <filesystem>
#include <span>

#include "viewer/report/year_study.h"

namespace lightwell {

/// Throws InputError for a mesh that is too large for the page of write_walk(), before form
/// factors, which take long. `hours` are those of sky_hours().
void check_walk(const DaylightStudy& study, std::span<const SkyHour> hours);

/// Figures of a page to walk in.
struct WrittenWalk {
  int vertices = 0;
  int terms = 0;       ///< of the light of all hours, see YearBasis
  double error = 0.0;  ///< of the terms, see YearBasis::error
};

/// Writes a page to walk in at all hours of the year: light on all surfaces, with windows in their
/// first states. The page of a scene without cameras begins with the view from the sensor of the
/// first room with the least daylight to that with the most, at the height of eyes over the floor.
/// Throws as find_year_basis() and write_walkthrough() do.
WrittenWalk write_walk(const std::filesystem::path& page, const DaylightStudy& study,
                       const StudiedModel& of, const StudiedYear& year);

}  // namespace lightwell
