#include "scene/io/radiance/generators/radiance_sky_call.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "scene/io/text_file.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Degrees west of Greenwich of the meridians of time zones.
const std::map<std::string, double, std::less<>>& zone_meridians() {
  static const std::map<std::string, double, std::less<>> table = {
      {"YST", 135},  {"YDT", 120},   {"PST", 120},  {"PDT", 105}, {"MST", 105}, {"MDT", 90},
      {"CST", 90},   {"CDT", 75},    {"EST", 75},   {"EDT", 60},  {"AST", 60},  {"ADT", 45},
      {"NST", 52.5}, {"NDT", 37.5},  {"GMT", 0},    {"UTC", 0},   {"BST", -15}, {"CET", -15},
      {"CEST", -30}, {"EET", -30},   {"EEST", -45}, {"GST", -60}, {"GDT", -75}, {"IST", -82.5},
      {"JST", -135}, {"NZST", -180}, {"NZDT", -195}};
  return table;
}

void read_time(SkyCall& call, SunGiven& sun) {
  const std::string& given = call.word("a time");
  std::string_view text = given;
  sun.is_solar_time = text.starts_with('+');
  if (sun.is_solar_time) text.remove_prefix(1);
  const auto letters = static_cast<std::size_t>(
      std::ranges::find_if(text, [](unsigned char c) { return std::isalpha(c); }) - text.begin());
  std::string zone(text.substr(letters));
  text = text.substr(0, letters);
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto hours = parse_finite(text.substr(0, colon));
  const auto minutes =
      colon == text.size() ? std::optional(0.0) : parse_finite(text.substr(colon + 1));
  if (!hours || !minutes || !(*minutes >= 0.0 && *minutes < 60.0)) {
    call.fail(fmt::format("has the time '{}'; write 14.5, 14:30 or 14:30EST", excerpt(given)));
  }
  sun.hour = *hours + *minutes / 60.0;
  if (!(sun.hour >= 0.0 && sun.hour < 24.0)) {
    call.fail(fmt::format("has the time '{}'; a day has 24 hours", excerpt(given)));
  }
  if (zone.empty()) return;
  for (char& c : zone) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto known = zone_meridians().find(zone);
  if (known == zone_meridians().end()) {
    call.fail(fmt::format("has the time zone '{}', which is not known; give its meridian with -m",
                          excerpt(zone)));
  }
  sun.has_zone = true;
  sun.meridian_west = known->second;
}

}  // namespace

const std::string& SkyCall::word(std::string_view what) {
  if (at_end()) fail(fmt::format("lacks {}", what));
  return words_[next_++];
}

double SkyCall::number(std::string_view what) {
  const std::string& given = word(what);
  const auto value = parse_finite(given);
  if (!value) fail(fmt::format("has '{}' where {} should stand", excerpt(given), what));
  return *value;
}

double SkyCall::number(std::string_view what, double least, double most) {
  const double value = number(what);
  if (!(value >= least && value <= most)) {
    fail(fmt::format("has {} for {}; give a number from {} to {}", value, what, least, most));
  }
  return value;
}

void SkyCall::fail(std::string_view problem) const {
  location_.fail(fmt::format("{} {}", words_.front(), problem));
}

SunGiven read_date(SkyCall& call) {
  SunGiven sun;
  const std::string& first = call.word("a month, or -ang");
  if (first == "-ang") {
    const double altitude = call.number("the sun's altitude", -90.0, 90.0);
    sun.angles = {altitude, call.number("the sun's azimuth")};
    return sun;
  }
  const auto month = parse_finite(first);
  if (!month || !(*month >= 1.0 && *month < 13.0)) {
    call.fail(fmt::format("has the month '{}'; give 1 to 12", excerpt(first)));
  }
  sun.month = static_cast<int>(*month);
  sun.day = static_cast<int>(call.number("a day of the month", 1.0, 31.0));
  read_time(call, sun);
  return sun;
}

bool read_place(std::string_view option, SkyCall& call, SunGiven& sun) {
  if (option == "-a") {
    sun.latitude = call.number("a latitude", -90.0, 90.0);
  } else if (option == "-o") {
    sun.west = call.number("a longitude", -360.0, 360.0);
  } else if (option == "-m") {
    const double meridian = call.number("a meridian", -360.0, 360.0);
    if (!sun.has_zone) sun.meridian_west = meridian;
  } else if (option == "-y") {
    sun.year = static_cast<int>(call.number("a year", 1900.0, 2100.0));
  } else {
    return false;
  }
  return true;
}

int day_number(const SunGiven& sun) {
  if (sun.angles) return 0;
  constexpr std::array<int, 12> before = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  return before[static_cast<std::size_t>(sun.month - 1)] + sun.day;
}

SunAngles sun_angles(const SunGiven& sun, const SkyCall& call) {
  if (sun.angles) return {sun.angles->first * degree, sun.angles->second * degree};
  if (sun.year && !sun.is_solar_time) {
    try {
      const SunPosition at =
          sun_position({*sun.year, sun.month, sun.day, sun.hour, -sun.meridian_west / 15.0},
                       sun.latitude, -sun.west);
      return {at.altitude_degrees * degree, (at.azimuth_degrees - 180.0) * degree};
    } catch (const std::invalid_argument& error) {
      call.fail(fmt::format("has a date or place that cannot be: {}", error.what()));
    }
  }
  const double day = day_number(sun), latitude = sun.latitude * degree;
  const double declination = 0.4093 * std::sin(2.0 * pi / 368.0 * (day - 81.0));
  const double equation_of_time = 0.170 * std::sin(4.0 * pi / 373.0 * (day - 80.0)) -
                                  0.129 * std::sin(2.0 * pi / 355.0 * (day - 8.0));
  const double solar_time =
      sun.hour +
      (sun.is_solar_time ? 0.0 : equation_of_time + (sun.meridian_west - sun.west) / 15.0);
  const double turn = solar_time * pi / 12.0;
  return {std::asin(std::sin(latitude) * std::sin(declination) -
                    std::cos(latitude) * std::cos(declination) * std::cos(turn)),
          -std::atan2(std::cos(declination) * std::sin(turn),
                      -std::cos(latitude) * std::sin(declination) -
                          std::sin(latitude) * std::cos(declination) * std::cos(turn))};
}

Eigen::Vector3d SunAngles::direction() const {
  return {-std::sin(azimuth) * std::cos(altitude), -std::cos(azimuth) * std::cos(altitude),
          std::sin(altitude)};
}

void pass_sky(SkyLightGiven light, const RadianceLocation& location, const RadianceSink& sink) {
  RadiancePrimitive p{.modifier = std::string(radiance_void), .location = location};
  if (light.sun_radiance > 0.0) {
    p.type = "light";
    p.name = "solar";
    p.reals.assign(3, light.sun_radiance);
    sink(p);
    p.modifier = "solar";
    p.type = "source";
    p.name = "sun";
    p.reals = {light.sun.x(), light.sun.y(), light.sun.z(), light.sun_degrees};
    sink(p);
    p.modifier = radiance_void;
  }
  p.type = "brightfunc";
  p.name = "skyfunc";
  p.strings = {light.function, light.file};
  p.reals = std::move(light.arguments);
  sink(p);
}

}  // namespace lightwell
