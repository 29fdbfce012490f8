#pragma once

#include <Eigen/Core>
#include <array>

#include "scene/io/luminaires/luminaire_file.h"

namespace lightwell {

/// A room of the table, in heights H = 2 m of its luminaires above the eye: across the line of
/// sight and along it.
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

/// The unified glare rating of one luminaire in all standard rooms: a row for each of `ugr_rooms`,
/// a column for each of `ugr_reflectances`. 0 where none is seen.
struct UgrTable {
  using Ratings = Eigen::Array<double, ugr_rooms.size(), ugr_reflectances.size()>;
  /// Looking along C0 and along C90: EULUMDAT's crosswise and endwise, and the other way about in
  /// IES files, whose C0 runs along a luminaire's length.
  Ratings along_c0{}, along_c90{};
};

/// The table that makers print, for the file's own flux (CIE 117-1995, CIE 190:2010). Luminaires
/// hang in an even grid 0.25 H apart, the eye is at the middle of a wall and looks level at the
/// opposite one. A luminaire's luminance is its intensity over the area seen of its opening and
/// luminous sides, where that counts_for_glare(). The background is what walls receive
/// indirectly in a room of three surfaces, ceiling, walls and the plane at the eye, each evenly
/// lit. Throws InputError if the file is radiant or says of no luminous area.
UgrTable ugr_table(const LuminaireFile& luminaire);

}  // namespace lightwell
