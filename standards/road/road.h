#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/luminaires/luminaire_file.h"
#include "standards/road/r_table.h"
#include "standards/road/road_class.h"

namespace lightwell {

/// Arrangements of luminaires along a straight road, as its drivers see them. Of two rows, those of
/// `staggered` are half a spacing apart. `median`: two luminaires on each mast in the middle of the
/// strip between two carriageways.
enum class RoadArrangement { single_right, single_left, opposite, staggered, median };

/// Luminaires of a road, all of one kind. Lengths in metres.
struct RoadLuminaires {
  std::shared_ptr<const LuminaireFile> file{};  ///< photometric, never null
  double flux_factor = 1.0;                     ///< on the intensities of the file, > 0
  double watts = 0.0;                           ///< of each; 0: unknown
  double street_side = 90.0;  ///< degrees, the C-plane that faces the road, [0,360)
  RoadArrangement arrangement = RoadArrangement::single_right;
  double spacing = 0.0;      ///< m along the road between neighbours in one row, > 0
  double height = 0.0;       ///< m of the luminaires above the road, > 0
  double overhang = 0.0;     ///< m from the edge of the carriageway to the luminaire; beside it < 0
  double tilt = 0.0;         ///< degrees by which the side of the road is lifted, [-90,90]
  double maintenance = 1.0;  ///< maintenance factor, (0,1]
};

/// A strip beside the carriageway, such as a footway or a cycle path.
struct RoadStrip {
  std::string name{};
  bool is_left = false;
  double gap = 0.0;    ///< m between the edge of the carriageway and the strip, >= 0
  double width = 0.0;  ///< m, > 0
  std::vector<RoadClass> classes{};
};

/// A straight road of one carriageway that is lit by rows of luminaires without end, or one of two
/// equal carriageways beside a median. x runs along the road as the traffic of the right lanes
/// does, y to the left from the right edge of the carriageway, z upwards; m.
struct Road {
  std::filesystem::path file{};
  std::string title{};
  double width = 0.0;  ///< m of the carriageway, > 0
  int lanes = 2;       ///< of the carriageway, >= 1
  int oncoming = 0;    ///< of these, lanes with traffic in the other direction
  bool drives_on_left = false;
  double median = 0.0;  ///< m between the carriageways; 0: there is one carriageway
  std::vector<RoadClass> classes{};
  RTable surface{};
  std::optional<RTable> wet_surface{};
  RoadLuminaires luminaires{};
  std::vector<RoadStrip> strips{};
  double hours = 0.0;  ///< of light at full power in a year; 0: not known

  double lane_width() const { return width / lanes; }
  /// True if the median lies beside the left or the right edge of the carriageway.
  bool has_median_at(bool is_left) const { return median > 0.0 && is_left != drives_on_left; }
  /// True if a lane, counted from 0 at the right, has oncoming traffic.
  bool is_oncoming(int lane) const {
    return drives_on_left ? lane < oncoming : lane >= lanes - oncoming;
  }
};

/// Reads a road from a TOML file (docs/road.md). Throws InputError naming file, line, key and
/// remedy.
Road read_road(const std::filesystem::path& path);

/// A row of luminaires along a road.
struct LuminaireRowPlace {
  double y = 0.0;       ///< m, of the luminaires
  double facing = 1.0;  ///< +1 or -1: the street side looks along `facing` times y
  double first = 0.0;   ///< m along x of one luminaire, in [0,spacing)
};

/// The rows of a road's luminaires: one or two.
std::vector<LuminaireRowPlace> luminaire_rows(const Road& road);

/// "single-right", ..., "median".
const char* arrangement_name(RoadArrangement arrangement);

}  // namespace lightwell
