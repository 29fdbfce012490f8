#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/degree.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// Words of a call of gensky or gendaylit, read one after another.
class SkyCall {
 public:
  SkyCall(const std::vector<std::string>& words, const RadianceLocation& location)
      : words_(words), location_(location) {}

  bool at_end() const { return next_ == words_.size(); }
  const RadianceLocation& location() const { return location_; }
  /// The next word; throws InputError if the call "lacks `what`".
  const std::string& word(std::string_view what);
  /// The next word as a number, in the second form from `least` to `most`.
  double number(std::string_view what);
  double number(std::string_view what, double least, double most);
  /// Throws InputError "file:line: gensky problem".
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  const std::vector<std::string>& words_;
  const RadianceLocation& location_;
  std::size_t next_ = 1;  // after the program
};

/// Time and place, or the sun's angles themselves. Longitudes are west of Greenwich, as in both
/// programs, and the default is near San Francisco.
struct SunGiven {
  int month = 0, day = 0;
  std::optional<int> year{};
  double hour = 12.0;
  bool is_solar_time = false, has_zone = false;
  double latitude = 37.8, west = 122.0, meridian_west = 120.0;  ///< degrees
  std::optional<std::pair<double, double>> angles{};  ///< degrees: altitude, azimuth west of south
};

/// Reads "-ang altitude azimuth" or "month day time".
SunGiven read_date(SkyCall& call);
/// Reads the value of an option of place and time; false for other options.
bool read_place(std::string_view option, SkyCall& call, SunGiven& sun);
/// Day of the year as both programs count: every year has 365. Without a date the day is 0.
int day_number(const SunGiven& sun);

struct SunAngles {
  double altitude = 0.0, azimuth = 0.0;  ///< radians; azimuth west of south

  Eigen::Vector3d direction() const;  ///< unit, x east, y north, z up
};

/// Angles of the sun. Without a year by the formulas of both programs, up to a degree off; with a
/// year by the Astronomical Almanac.
SunAngles sun_angles(const SunGiven& sun, const SkyCall& call);

/// Altitude to which both programs lower a sun nearer to the zenith, radians.
inline constexpr double highest_sun = 87.0 * degree;

/// Light of a sky as both programs write it.
struct SkyLightGiven {
  double sun_radiance = 0.0;  ///< W/(m^2 sr); 0: no sun
  double sun_degrees = 0.5;   ///< across
  Eigen::Vector3d sun = Eigen::Vector3d::UnitZ();
  const char* function = "";
  const char* file = "";
  std::vector<double> arguments{};
};

/// Passes the material "solar" and the source "sun" where the sun shines, and the pattern
/// "skyfunc".
void pass_sky(SkyLightGiven light, const RadianceLocation& location, const RadianceSink& sink);

/// Kinds of sky of gensky, by the numbers of skybright.cal.
enum class SkyOfGensky { clear = 1, overcast = 2, uniform = 3, intermediate = 4 };

/// Distribution of such a sky towards the zenith, and its horizontal irradiance over pi times the
/// radiance of the zenith. Polynomials of the sun's altitude (radians), as in gensky.
struct ZenithShape {
  double at_zenith = 1.0, horizontal = 1.0;
};
ZenithShape zenith_shape(SkyOfGensky kind, double altitude);

void pass_gensky(SkyCall& call, const RadianceSink& sink);
void pass_gendaylit(SkyCall& call, Remarks& remarks, const RadianceSink& sink);

}  // namespace lightwell
