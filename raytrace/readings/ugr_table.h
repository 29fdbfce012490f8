#pragma once

#include <Eigen/Core>
#include <array>

#include "scene/io/luminaires/luminaire_file.h"

namespace lightwell {

/// A room of the table: its sizes across and along the line of sight, in units of H = 2 m, the
/// height of the luminaires above the eye.
struct UgrRoom {
  int across = 0, along = 0;
};
inline constexpr std::array<UgrRoom, 19> ugr_rooms = {{{2, 2},
                                                       {2, 3},
                                                       {2, 4},
                                                       {2, 6},
                                                       {2, 8},
                                                       {2, 12},
                                                       {4, 2},
                                                       {4, 3},
                                                       {4, 4},
                                                       {4, 6},
                                                       {4, 8},
                                                       {4, 12},
                                                       {8, 4},
                                                       {8, 6},
                                                       {8, 8},
                                                       {8, 12},
                                                       {12, 4},
                                                       {12, 6},
                                                       {12, 8}}};

struct UgrReflectances {
  double ceiling = 0.0, walls = 0.0, floor = 0.0;
};
inline constexpr std::array<UgrReflectances, 5> ugr_reflectances = {
    {{0.7, 0.5, 0.2}, {0.7, 0.3, 0.2}, {0.5, 0.5, 0.2}, {0.5, 0.3, 0.2}, {0.3, 0.3, 0.2}}};

/// Unified glare ratings of one luminaire in all standard rooms: a row for each of `ugr_rooms`, a
/// column for each of `ugr_reflectances`. 0 if no luminaire is in sight.
struct UgrTable {
  using Ratings = Eigen::Array<double, ugr_rooms.size(), ugr_reflectances.size()>;
  /// Ratings for lines of sight along C0 and along C90: crosswise and endwise in EULUMDAT files,
  /// endwise and crosswise in IES files, whose C0 runs along a luminaire's length.
  Ratings along_c0{}, along_c90{};
};

/// Returns the table of a luminaire as in data sheets, for the flux of its file (CIE 117-1995, CIE
/// 190:2010).
///
/// - Luminaires hang in an even grid 0.25 H apart. The eye is at the middle of a wall and looks
///   level at the opposite wall.
/// - The luminance of a luminaire is its intensity over the projected area of its opening and
///   luminous sides, within counts_for_glare().
/// - The background is the indirect illuminance of the walls over pi, in a room of three evenly lit
///   surfaces: ceiling, walls and the plane at the eye.
///
/// Throws InputError if the file's intensities are radiant or the file gives no luminous area.
UgrTable ugr_table(const LuminaireFile& luminaire);

}  // namespace lightwell
