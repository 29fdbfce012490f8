#include "scene/io/toml/toml_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "scene/clear_sky.h"
#include "scene/errors.h"
#include "scene/io/pictures/environment_file.h"
#include "scene/limits.h"
#include "scene/perez_sky.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

// Luminous efficacy of daylight over its whole spectrum, lm/W: the mean of the values collected by
// Littlefair 1985 for clear and overcast skies. Converts readings of irradiance meters, in W
// including infrared.
constexpr double daylight_efficacy = 110.0;

Eigen::Vector3d direction(const TomlValue& value) {
  const Eigen::Vector3d v = value.vector();
  if (!(v.stableNorm() > 0.0)) value.fail("has no length; give a direction");
  return v.stableNormalized();
}

// Spectrum with the hue of `colour` and a luminous value in lux or cd/m^2.
Spectrum photometric(double luminous_value, const Spectrum& colour, const TomlValue& place,
                     const TomlBands& bands) {
  const double unit = luminous(bands.bands, colour);
  if (!(unit > 0.0)) {
    place.fail(
        "is a photometric value, but nothing of the light's colour is visible in the "
        "scene's bands; give it in watts");
  }
  return colour * static_cast<float>(luminous_value / unit);
}

// Refuses the keys of a chromaticity or a spectrum: beside a key that states each band, or, with
// an empty `how`, where nothing states a brightness.
void refuse_colour_beside(const TomlTable& table, const std::string& how) {
  for (const std::string& key : table.present({"color", "cct", "spectrum"})) {
    table.require(key).fail(
        how.empty()
            ? "has no meaning without a brightness; give 'illuminance' in lux beside it"
            : fmt::format(
                  "has no meaning beside '{}', which states each band; give the brightness in lux",
                  how));
  }
}

// Returns the key of `keys` that the table has, or an empty string; throws if there are several.
std::string one_of_present(const TomlTable& table, std::initializer_list<const char*> keys) {
  const auto given = table.present(keys);
  if (given.size() > 1) {
    table.require(given[1]).fail(fmt::format("is a second statement of what '{}' says", given[0]));
  }
  return given.empty() ? "" : given[0];
}

struct When {
  ClockTime time{};
  double latitude = 0.0, longitude = 0.0;
};

When read_when(const TomlTable& table) {
  When when;
  const TomlValue date = table.require("date"), time = table.require("time");
  const std::string day = date.string(), clock = time.string();
  int end = 0;
  if (std::sscanf(day.c_str(), "%4d-%2d-%2d%n", &when.time.year, &when.time.month, &when.time.day,
                  &end) != 3 ||
      end != static_cast<int>(day.size())) {
    date.fail(fmt::format("is '{}'; write \"2024-06-21\"", day));
  }
  int hour = 0, minute = 0;
  if (std::sscanf(clock.c_str(), "%2d:%2d%n", &hour, &minute, &end) != 2 ||
      end != static_cast<int>(clock.size()) || hour < 0 || hour > 23 || minute < 0 || minute > 59) {
    time.fail(fmt::format("is '{}'; write \"14:30\"", clock));
  }
  when.time.hour = hour + minute / 60.0;
  if (const auto zone = table.find("time_zone")) {
    when.time.hours_east = zone->number_within(-14.0, 14.0);
  }
  when.latitude = table.require("latitude").number_within(-90.0, 90.0);
  when.longitude = table.require("longitude").number_within(-180.0, 180.0);
  return when;
}

// Unit direction towards the sun.
Eigen::Vector3d read_sun_direction(const TomlTable& table, const Sky& sky) {
  const std::string how = one_of_present(table, {"direction", "altitude", "date"});
  if (how.empty()) {
    table.fail(
        "must say where it stands: with 'direction', with 'azimuth' and 'altitude', or with "
        "'date', 'time', 'latitude' and 'longitude'");
  }
  if (how == "direction") return direction(table.require("direction"));
  if (how == "altitude") {
    return sky_direction(sky, table.require("azimuth").number_within(-360.0, 360.0),
                         table.require("altitude").number_within(-90.0, 90.0));
  }
  const When when = read_when(table);
  try {
    const SunPosition at = sun_position(when.time, when.latitude, when.longitude);
    return sky_direction(sky, at.azimuth_degrees, at.altitude_degrees);
  } catch (const std::invalid_argument& error) {
    table.fail(fmt::format("stands nowhere: {}", error.what()));
  }
}

struct SunTable {
  Sun sun{};
  bool has_brightness = true;
  std::optional<double> direct_normal{};  // W/m^2 of the whole spectrum; empty: not known
  int day = 172;                          // of the year
};

// Sets the irradiance of `result`; false if the table does not state it.
bool read_brightness(const TomlTable& table, const TomlBands& bands, SunTable& result) {
  const std::string how = one_of_present(table, {"illuminance", "irradiance", "direct_normal"});
  if (how.empty()) {
    refuse_colour_beside(table, how);
    return false;
  }
  const TomlValue amount = table.require(how);
  if (how == "irradiance") {
    refuse_colour_beside(table, how);
    result.sun.irradiance = read_toml_emission(amount, bands);
    const bool is_rgb = bands.bands.wavelengths_nm.empty();
    if (is_rgb) {
      result.direct_normal = luminous(bands.bands, result.sun.irradiance) / daylight_efficacy;
    }
  } else {
    const double given = amount.number_at_least(0.0);
    const bool is_lux = how == "illuminance";
    const double lux = is_lux ? given : daylight_efficacy * given;
    result.direct_normal = is_lux ? lux / daylight_efficacy : given;
    result.sun.irradiance =
        photometric(lux, read_toml_daylight_colour(table, bands), amount, bands);
  }
  return true;
}

SunTable read_sun(const TomlValue& value, const Sky& sky, const TomlBands& bands,
                  bool needs_brightness) {
  const TomlTable table = value.table(
      {"direction", "azimuth", "altitude", "date", "time", "time_zone", "latitude", "longitude",
       "illuminance", "irradiance", "direct_normal", "color", "cct", "spectrum", "angle"});
  SunTable result{.sun = {.direction = read_sun_direction(table, sky),
                          .irradiance = constant_spectrum(bands.bands, 0.0f)}};
  if (table.has("date")) {
    const ClockTime time = read_when(table).time;
    result.day = day_of_year(time.year, time.month, time.day);
  }
  result.has_brightness = read_brightness(table, bands, result);
  if (!result.has_brightness && needs_brightness) {
    table.fail(
        "must say how bright it is across its rays: with 'illuminance' in lux, 'irradiance' "
        "in W/m2 per band, or 'direct_normal' in W/m2 of all wavelengths");
  }
  if (const auto angle = table.find("angle")) {
    result.sun.angle_degrees = angle->positive();
    if (!(result.sun.angle_degrees <= 10.0)) angle->fail("is more than 10 degrees; a sun is small");
  }
  return result;
}

// Checks that there is a sun above the horizon; returns its altitude in degrees.
double require_sun_above(const TomlTable& table, const std::string& kind,
                         const std::optional<SunTable>& sun, const Sky& sky) {
  if (!sun) table.fail(fmt::format("is of the kind '{}', which needs a [sky.sun]", kind));
  const double sine = sun->sun.direction.dot(sky.up);
  if (!(sine > 0.0)) {
    table.fail(fmt::format("is of the kind '{}', which needs a sun above the horizon", kind));
  }
  return std::asin(std::min(1.0, sine)) * 180.0 / std::numbers::pi;
}

void read_gradation(const TomlTable& table, const std::string& kind,
                    const std::optional<SunTable>& sun, Sky& sky) {
  const auto require_sun = [&] {
    const double altitude = require_sun_above(table, kind, sun, sky);
    sky.bright = sun->sun.direction;
    return altitude;
  };
  if (kind == "cie-overcast") {
    sky.kind = SkyKind::overcast;
    sky.name = "CIE overcast";
  } else if (kind == "cie-clear") {
    sky.gradation = standard_sky(12);
    sky.name = "CIE clear";
    require_sun();
  } else if (kind == "cie") {
    const auto type = static_cast<int>(table.require("type").integer_within(1, 15));
    sky.gradation = standard_sky(type);
    sky.name = fmt::format("CIE standard sky {}", type);
    if (sky.gradation.c != 0.0) require_sun();
  } else if (kind == "perez") {
    const double altitude = require_sun();
    const double diffuse = table.require("diffuse_horizontal").positive();
    if (!sun->direct_normal) {
      table.require("sun").fail(
          "gives the irradiance of some wavelengths, and a sky of the kind 'perez' needs that of "
          "all; give 'direct_normal' in W/m2 or 'illuminance' in lux instead");
    }
    sky.gradation = perez_sky(*sun->direct_normal, diffuse, altitude, sun->day);
    sky.name =
        fmt::format("Perez, {:g} W/m2 direct and {:g} diffuse", *sun->direct_normal, diffuse);
  } else {
    sky.name = "uniform";
  }
}

void read_sky_map(const TomlTable& table, Sky& sky) {
  sky.kind = SkyKind::map;
  const TomlValue file = table.require("file");
  const auto path = (file.file().parent_path() / file.name()).lexically_normal();
  try {
    sky.map = read_environment_map(path);
  } catch (const InputError& error) {
    file.fail(fmt::format("cannot be used: {}", error.what()));
  }
  sky.name = fmt::format("map '{}', {} x {}", path.filename().string(), sky.map->width(),
                         sky.map->height());
  // The picture's centre lies in the north, `rotation` degrees further clockwise.
  const double turn = table.has("rotation") ? table.require("rotation").number() : 0.0;
  sky.to_map = to_map_around(sky.up, sky_direction(sky, turn, 0.0));
}

// Sets the sky's scale from exactly one of four keys.
void read_scale(const TomlTable& table, const TomlBands& bands, Sky& sky) {
  const std::string how =
      one_of_present(table, {"illuminance", "zenith_luminance", "radiance", "diffuse_horizontal"});
  const bool is_map = sky.kind == SkyKind::map;
  const Spectrum one = constant_spectrum(bands.bands, 1.0f);
  if (how.empty()) {
    if (!is_map) {
      table.fail(
          "must say how bright it is: with 'illuminance' in lux on open ground, "
          "'zenith_luminance' in cd/m2, 'radiance' of the zenith in W/(m2 sr) per band, or "
          "'diffuse_horizontal' in W/m2 of all wavelengths");
    }
    sky.scale = one;
    return;
  }
  const TomlValue amount = table.require(how);
  if (is_map && how != "illuminance") {
    amount.fail("has no meaning for a map; give 'illuminance', 'scale' or nothing");
  }
  sky.scale = is_map ? one : read_toml_daylight_colour(table, bands);
  if (how == "illuminance" || how == "diffuse_horizontal") {
    const double lux =
        amount.number_at_least(0.0) * (how == "illuminance" ? 1.0 : daylight_efficacy);
    const double unit = luminous(bands.bands, diffuse_horizontal_irradiance(sky));
    if (!(unit > 0.0)) amount.fail("cannot be reached: the sky has no visible light");
    sky.scale *= static_cast<float>(lux / unit);
    return;
  }
  const Spectrum zenith = sky_radiance(sky, sky.up);
  if (how == "radiance") {
    refuse_colour_beside(table, how);
    // The radiance is the zenith's, for any phi and f there (Sky).
    const float factor = zenith.maxCoeff() / sky.scale.maxCoeff();
    sky.scale = read_toml_emission(amount, bands) / factor;
  } else {
    const double unit = luminous(bands.bands, zenith);
    if (!(unit > 0.0)) amount.fail("cannot be reached: the sky has no visible light");
    sky.scale *= static_cast<float>(amount.number_at_least(0.0) / unit);
  }
}

// Reflectance of the ground, which is that of land unless the table says otherwise.
Spectrum ground_reflectance(const TomlTable& table, const TomlBands& bands) {
  constexpr float of_land = 0.2f;
  return table.has("ground_reflectance")
             ? read_toml_share(table.require("ground_reflectance"), bands)
             : constant_spectrum(bands.bands, of_land);
}

// Radiance of the ground under the irradiance E.
Spectrum read_ground(const TomlTable& table, const TomlBands& bands, const Spectrum& E) {
  if (one_of_present(table, {"ground_reflectance", "ground_radiance"}) == "ground_radiance") {
    return read_toml_emission(table.require("ground_radiance"), bands);
  }
  return ground_reflectance(table, bands) * E * std::numbers::inv_pi_v<float>;
}

void require_rgb(const TomlValue& place, const TomlBands& bands) {
  if (bands.bands.count() == 3 && bands.bands.wavelengths_nm.empty()) return;
  place.fail(
      "is in r, g and b, and the scene has other bands; use another kind of sky, or RGB bands");
}

// A clear day by turbidity. What is not stated of the brightness of dome and sun is the model's.
void read_clear_day(const TomlTable& table, const std::string& kind, const TomlBands& bands,
                    const std::optional<SunTable>& sun, Sky& sky) {
  const TomlValue turbidity = table.require("turbidity");
  require_rgb(turbidity, bands);
  const ClearDay day{.turbidity = turbidity.number_within(1.0, 10.0),
                     .sun_altitude_degrees = require_sun_above(table, kind, sun, sky),
                     .albedo = ground_reflectance(table, bands)};
  const auto per_band = static_cast<float>(luminous_width_nm);
  Spectrum E = clear_sky_irradiance(day) * per_band;
  double factor = 1.0;
  if (const auto given = table.find("illuminance")) {
    factor = given->number_at_least(0.0) / luminous(bands.bands, E);
    E *= static_cast<float>(factor);
  }
  if (!sun->has_brightness) {
    sky.sun->irradiance = per_band * clear_sun_irradiance(ClearSunModel::hosek_wilkie,
                                                          day.turbidity, day.sun_altitude_degrees);
  }
  const Spectrum below = read_ground(table, bands, E + sun_horizontal_irradiance(sky));
  set_clear_dome(day, {.scale = factor * luminous_width_nm, .below = below}, sky.sun->direction,
                 sky);
}

// Reads `up` and `north`.
void read_axes(const TomlTable& table, Sky& sky) {
  if (const auto up = table.find("up")) sky.up = direction(*up);
  if (const auto north = table.find("north")) {
    sky.north = direction(*north);
  } else if (std::abs(sky.north.dot(sky.up)) > 0.9) {
    sky.north = Eigen::Vector3d::UnitY();
  }
  const Eigen::Vector3d level = sky.north - sky.north.dot(sky.up) * sky.up;
  if (!(level.norm() > parallel_sine)) {
    table.fail("has a north that points up; give one on the horizon");
  }
  sky.north = level.normalized();
  sky.bright = sky.up;
}

// Refuses keys that the kind of the sky gives no meaning.
void check_keys(const TomlTable& table, const std::string& kind) {
  const auto only_for = [&](std::initializer_list<const char*> keys,
                            std::initializer_list<std::string_view> kinds) {
    if (std::ranges::find(kinds, kind) != kinds.end()) return;
    for (const char* key : keys) {
      if (!table.has(key)) continue;
      table.require(key).fail(fmt::format("has no meaning for a sky of the kind '{}'", kind));
    }
  };
  const auto not_for = [&](std::initializer_list<const char*> keys, std::string_view other) {
    if (kind == other) only_for(keys, {});
  };
  only_for({"type"}, {"cie"});
  only_for({"file", "rotation", "scale"}, {"map"});
  only_for({"turbidity"}, {"turbidity"});
  not_for({"ground_reflectance", "ground_radiance", "color", "cct", "spectrum"}, "map");
  not_for({"color", "cct", "spectrum", "zenith_luminance", "radiance", "diffuse_horizontal"},
          "turbidity");
  not_for({"color", "cct", "spectrum", "illuminance", "zenith_luminance", "radiance",
           "diffuse_horizontal"},
          "none");
}

}  // namespace

Sky read_toml_sky(const TomlValue& value, const TomlBands& bands) {
  const TomlTable table =
      value.table({"kind", "type", "up", "north", "illuminance", "zenith_luminance", "radiance",
                   "diffuse_horizontal", "color", "cct", "spectrum", "ground_reflectance",
                   "ground_radiance", "file", "rotation", "scale", "turbidity", "sun"});
  Sky sky;
  read_axes(table, sky);
  sky.scale = sky.ground = constant_spectrum(bands.bands, 0.0f);
  const std::string kind = table.require("kind").one_of(
      {"uniform", "cie-overcast", "cie-clear", "cie", "perez", "turbidity", "map", "none"});
  std::optional<SunTable> sun;
  if (const auto given = table.find("sun")) {
    sun = read_sun(*given, sky, bands, kind != "turbidity");
    if (sun->sun.direction.dot(sky.up) > 0.0) sky.sun = sun->sun;
  }
  check_keys(table, kind);
  if (kind == "map") {
    require_rgb(table.require("file"), bands);
    read_sky_map(table, sky);
    read_scale(table, bands, sky);
    if (const auto scale = table.find("scale")) {
      sky.scale *= static_cast<float>(scale->number_at_least(0.0));
    }
    return sky;
  }
  if (kind == "turbidity") {
    read_clear_day(table, kind, bands, sun, sky);
    return sky;
  }
  if (kind == "none") {
    sky.name = "dark";
  } else {
    read_gradation(table, kind, sun, sky);
    read_scale(table, bands, sky);
  }
  sky.ground = read_ground(table, bands,
                           diffuse_horizontal_irradiance(sky) + sun_horizontal_irradiance(sky));
  return sky;
}

}  // namespace lightwell
