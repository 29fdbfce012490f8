#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "standards/requirement.h"

namespace lightwell {

/// A figure, and the ends of its bound with odds of about 19 to 1.
struct BoundedFigure {
  double value = 0.0, least = 0.0, most = 0.0;
};

/// Figures of daylight that rating systems limit.
enum class DaylightFigure {
  spatial_autonomy,   ///< sDA300/50%, % of the area
  sun_exposure,       ///< ASE1000,250h, % of the area
  mean_factor,        ///< mean daylight factor, %
  factor_uniformity,  ///< least over mean daylight factor
  least_factor,       ///< daylight factor of the darkest point, %
  factor_route,       ///< 1: the limits of daylight factors are met, else 0
  mean_hours,         ///< h of a year with a mean illuminance
  point_hours,        ///< h of a year with an illuminance, of the point that has fewest
  hours_route,        ///< 1: the limits of hours are met, else 0
  complying_area      ///< % of the area of all rooms, in rooms that meet one of the routes
};

/// A step of a rating: so many points from a share on.
struct RatingStep {
  double at_least = 0.0;  ///< %, (0,100]
  int points = 0;         ///< >= 1
};

/// Illuminance that must be there for some hours of the year; 0 h: no limit.
struct HoursLimit {
  double lux = 0.0, hours = 0.0;
};

/// A credit of a rating system. The credit gives points by the sDA of all rooms (`autonomy`), or by
/// the share of the area in rooms that comply (`area`). A room complies by its daylight factors, or
/// by the hours in which it has enough light.
struct DaylightRating {
  std::string key{}, title{};
  std::string source{};              ///< of the numbers
  std::string points = "points";     ///< the system's word for them
  std::vector<std::string> notes{};  ///< for people, a sentence each
  std::vector<RatingStep> autonomy{};
  /// Further points, up to the most of `autonomy`, if each room has this sDA.
  std::optional<RatingStep> autonomy_of_each{};
  double sun_exposure = 0.0;  ///< greatest ASE of a room, %, which gives no points; 0: no limit
  std::vector<RatingStep> area{};
  double daylight_factor = 0.0;  ///< least mean, %; 0: daylight factors do not count
  /// Least uniformity. Also met by a darkest point with this share of `daylight_factor`. 0: no
  /// limit.
  double uniformity = 0.0;
  HoursLimit mean{};   ///< of the room's mean illuminance
  HoursLimit point{};  ///< of each point

  bool has_hours() const { return mean.hours > 0.0 || point.hours > 0.0; }
};

/// The ratings that the program knows by itself: the contents of standards/daylight_ratings.toml.
std::vector<DaylightRating> usual_daylight_ratings();

/// Reads a table of ratings (TOML; its keys are in docs/daylight-year.md). Throws InputError naming
/// file, line and remedy.
std::vector<DaylightRating> read_daylight_ratings(const std::filesystem::path& file);

/// The rating of a key. Throws InputError that begins with `asked_by` and names the nearest key.
const DaylightRating& find_daylight_rating(const std::vector<DaylightRating>& ratings,
                                           const std::string& key, const std::string& asked_by);

/// The ratings of keys, of the table in a file, or of the program's own where `file` is empty.
/// Throws InputError as read_daylight_ratings() and find_daylight_rating() do.
std::vector<DaylightRating> find_daylight_ratings(std::span<const std::string> keys,
                                                  const std::filesystem::path& file,
                                                  const std::string& asked_by);

/// The figures of a room, or of a part that is rated by itself. Hours are those of the rating's
/// illuminances.
struct DaylitRoom {
  std::string name{};
  double area = 0.0;                                          ///< weight among the rooms, > 0: m^2
  BoundedFigure autonomy{}, sun_exposure{};                   ///< %
  BoundedFigure mean_factor{}, least_factor{}, uniformity{};  ///< %, %, [0,1]
  BoundedFigure mean_hours{}, point_hours{};                  ///< h
};

/// A figure that is held to a limit.
struct RatedFigure {
  std::string room{};  ///< empty: all rooms
  DaylightFigure figure = DaylightFigure::spatial_autonomy;
  double limit = 0.0;
  int points = 0;               ///< that the limit is for; 0: none
  bool is_upper = false;        ///< true: the figure must not exceed the limit
  bool is_recommended = false;  ///< true: without bearing on the points
  BoundedFigure value{};
};

/// Met or missed where both ends of the figure's bound meet or miss the limit.
Verdict verdict_of(const RatedFigure& figure);

/// Points of a rating at the value of all figures, and at both ends of their bounds.
struct RatingPoints {
  int value = 0, least = 0, most = 0;
  int available = 0;
};

struct RatedDaylight {
  std::vector<RatedFigure> figures{};  ///< room by room, then of all rooms
  RatingPoints points{};
};

/// Holds rooms, at least one, to a rating.
RatedDaylight rate_daylight(const DaylightRating& rating, std::span<const DaylitRoom> rooms);

namespace standards_data {
extern const std::string_view daylight_ratings;  ///< the bytes of daylight_ratings.toml
}  // namespace standards_data

}  // namespace lightwell
