// The skies of gensky and gendaylit. Sources: the reference manual; CIE 1973 (clear sky), Moon &
// Spencer 1942 (overcast), Nakamura, Oki & Hayashi 1985 (intermediate); Perez, Seals & Michalsky
// 1993 (distribution); Perez, Ineichen, Seals, Michalsky & Stewart 1990 (efficacy).
#include "scene/io/radiance/radiance_daylight.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scene/degree.h"
#include "scene/io/text_file.h"
#include "scene/sky.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// lm/W of the two programs.
constexpr double white_efficacy = 179.0, sky_efficacy = 203.0, sun_efficacy = 208.0;

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

// Words of a call, read one after another.
class Words {
 public:
  Words(const std::vector<std::string>& words, const RadianceLocation& location)
      : words_(words), location_(location) {}

  bool at_end() const { return next_ == words_.size(); }
  const std::string& word(std::string_view what) {
    if (at_end()) fail(fmt::format("lacks {}", what));
    return words_[next_++];
  }
  double number(std::string_view what) {
    const std::string& given = word(what);
    const auto value = parse_finite(given);
    if (!value) fail(fmt::format("has '{}' where {} should stand", excerpt(given), what));
    return *value;
  }
  double number(std::string_view what, double least, double most) {
    const double value = number(what);
    if (!(value >= least && value <= most)) {
      fail(fmt::format("has {} for {}; give a number from {} to {}", value, what, least, most));
    }
    return value;
  }
  [[noreturn]] void fail(std::string_view problem) const {
    location_.fail(fmt::format("{} {}", words_.front(), problem));
  }

 private:
  const std::vector<std::string>& words_;
  const RadianceLocation& location_;
  std::size_t next_ = 1;  // after the program
};

// When and where, or the sun's angles themselves. Longitudes are west, as in both programs.
struct SunGiven {
  int month = 0, day = 0;
  std::optional<int> year{};
  double hour = 12.0;
  bool is_solar_time = false, has_zone = false;
  double latitude = 37.8, west = 122.0, meridian_west = 120.0;  // degrees
  std::optional<std::pair<double, double>> angles{};  // degrees: altitude, azimuth west of south
};

void read_time(Words& words, SunGiven& sun) {
  const std::string& given = words.word("a time");
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
    words.fail(fmt::format("has the time '{}'; write 14.5, 14:30 or 14:30EST", excerpt(given)));
  }
  sun.hour = *hours + *minutes / 60.0;
  if (!(sun.hour >= 0.0 && sun.hour < 24.0)) {
    words.fail(fmt::format("has the time '{}'; a day has 24 hours", excerpt(given)));
  }
  if (zone.empty()) return;
  for (char& c : zone) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto known = zone_meridians().find(zone);
  if (known == zone_meridians().end()) {
    words.fail(fmt::format("has the time zone '{}', which is not known; give its meridian with -m",
                           excerpt(zone)));
  }
  sun.has_zone = true;
  sun.meridian_west = known->second;
}

SunGiven read_date(Words& words) {
  SunGiven sun;
  const std::string& first = words.word("a month, or -ang");
  if (first == "-ang") {
    const double altitude = words.number("the sun's altitude", -90.0, 90.0);
    sun.angles = {altitude, words.number("the sun's azimuth")};
    return sun;
  }
  const auto month = parse_finite(first);
  if (!month || !(*month >= 1.0 && *month < 13.0)) {
    words.fail(fmt::format("has the month '{}'; give 1 to 12", excerpt(first)));
  }
  sun.month = static_cast<int>(*month);
  sun.day = static_cast<int>(words.number("a day of the month", 1.0, 31.0));
  read_time(words, sun);
  return sun;
}

// Options of place and time; false for other options.
bool read_place(std::string_view option, Words& words, SunGiven& sun) {
  if (option == "-a") {
    sun.latitude = words.number("a latitude", -90.0, 90.0);
  } else if (option == "-o") {
    sun.west = words.number("a longitude", -360.0, 360.0);
  } else if (option == "-m") {
    const double meridian = words.number("a meridian", -360.0, 360.0);
    if (!sun.has_zone) sun.meridian_west = meridian;
  } else if (option == "-y") {
    sun.year = static_cast<int>(words.number("a year", 1900.0, 2100.0));
  } else {
    return false;
  }
  return true;
}

// Day of the year as both programs count: every year has 365. Without a date the day is 0.
int day_number(const SunGiven& sun) {
  if (sun.angles) return 0;
  constexpr std::array<int, 12> before = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  return before[static_cast<std::size_t>(sun.month - 1)] + sun.day;
}

struct SunAngles {
  double altitude = 0.0, azimuth = 0.0;  // radians; azimuth west of south
};

// Position without a year: the formulas of both programs, up to a degree off. With a year: the
// Astronomical Almanac's.
SunAngles sun_angles(const SunGiven& sun, const Words& words) {
  if (sun.angles) return {sun.angles->first * degree, sun.angles->second * degree};
  if (sun.year && !sun.is_solar_time) {
    try {
      const SunPosition at =
          sun_position({*sun.year, sun.month, sun.day, sun.hour, -sun.meridian_west / 15.0},
                       sun.latitude, -sun.west);
      return {at.altitude_degrees * degree, (at.azimuth_degrees - 180.0) * degree};
    } catch (const std::invalid_argument& error) {
      words.fail(fmt::format("has a date or place that cannot be: {}", error.what()));
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

constexpr double highest_sun = 87.0 * degree;  // both programs lower a sun nearer to the zenith

Eigen::Vector3d direction(const SunAngles& sun) {
  return {-std::sin(sun.azimuth) * std::cos(sun.altitude),
          -std::cos(sun.azimuth) * std::cos(sun.altitude), std::sin(sun.altitude)};
}

// Passes a sun of this radiance and the pattern of the sky.
void pass(const RadianceLocation& location, double sun_radiance, double sun_degrees,
          const Eigen::Vector3d& sun, const char* function, const char* file,
          std::vector<double> arguments, const RadianceSink& sink) {
  RadiancePrimitive p{.modifier = std::string(radiance_void), .location = location};
  if (sun_radiance > 0.0) {
    p.type = "light";
    p.name = "solar";
    p.reals = {sun_radiance, sun_radiance, sun_radiance};
    sink(p);
    p.modifier = "solar";
    p.type = "source";
    p.name = "sun";
    p.reals = {sun.x(), sun.y(), sun.z(), sun_degrees};
    sink(p);
    p.modifier = radiance_void;
  }
  p.type = "brightfunc";
  p.name = "skyfunc";
  p.strings = {function, file};
  p.reals = std::move(arguments);
  sink(p);
}

// gensky.

enum class Gensky { clear = 1, overcast = 2, uniform = 3, intermediate = 4 };

struct GenskyGiven {
  SunGiven sun{};
  Gensky kind = Gensky::clear;
  bool with_sun = true;
  double turbidity = 2.45, ground_reflectance = 0.2;
  std::optional<double> zenith{}, diffuse_horizontal{};       // W/(m^2 sr), W/m^2
  std::optional<double> sun_radiance{}, direct_horizontal{};  // W/(m^2 sr), W/m^2

  bool is_cloudy() const { return kind == Gensky::overcast || kind == Gensky::uniform; }
};

GenskyGiven read_gensky(Words& words) {
  GenskyGiven given{.sun = read_date(words)};
  while (!words.at_end()) {
    const std::string& option = words.word("an option");
    const std::string_view letter =
        std::string_view(option).substr(std::min<std::size_t>(1, option.size()));
    if (read_place(option, words, given.sun)) continue;
    if (letter == "s" || letter == "i") {
      given.kind = letter == "s" ? Gensky::clear : Gensky::intermediate;
      given.with_sun = option.front() == '+';
    } else if (letter == "c" || letter == "u") {
      given.kind = letter == "c" ? Gensky::overcast : Gensky::uniform;
    } else if (option == "-t") {
      given.turbidity = words.number("a turbidity", 0.0, 1e3);
    } else if (option == "-g") {
      given.ground_reflectance = words.number("a reflectance of the ground", 0.0, 1.0);
    } else if (option == "-b") {
      given.zenith = words.number("a radiance of the zenith", 0.0, 1e12);
    } else if (option == "-B") {
      given.diffuse_horizontal = words.number("a diffuse irradiance", 0.0, 1e12);
    } else if (option == "-r") {
      given.sun_radiance = words.number("a radiance of the sun", 0.0, 1e15);
    } else if (option == "-R") {
      given.direct_horizontal = words.number("a direct irradiance", 0.0, 1e12);
    } else {
      words.fail(fmt::format("has the option '{}', which is not known", excerpt(option)));
    }
  }
  return given;
}

// A sky's distribution towards the zenith (f_zenith), and its horizontal irradiance over pi times
// the radiance of the zenith. Polynomials of the sun's altitude as in gensky.
struct GenskyShape {
  double at_zenith = 1.0, horizontal = 1.0;
};

GenskyShape gensky_shape(Gensky kind, double altitude) {
  if (kind == Gensky::uniform) return {1.0, 1.0};
  if (kind == Gensky::overcast) return {1.0, 7.0 / 9.0};
  const double from_zenith = 0.5 * pi - altitude, x = altitude / (0.25 * pi) - 1.0;
  if (kind == Gensky::clear) {
    const double at_zenith = 0.274 * (0.91 + 10.0 * std::exp(-3.0 * from_zenith) +
                                      0.45 * std::pow(std::sin(altitude), 2));
    const double sum = 2.766521 + x * (0.547665 + x * (-0.369832 + x * (0.009237 + x * 0.059229)));
    return {at_zenith, sum / (at_zenith * pi)};
  }
  const double at_zenith = (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * altitude)) *
                           std::exp(-from_zenith * (0.4441 + 1.48 * altitude));
  const double sum = 3.5556 + x * (-2.7152 + x * (-1.3081 + x * (1.0660 + x * 0.60227)));
  return {at_zenith, sum / (at_zenith * pi)};
}

// Zenith luminance by the sun's altitude: Krochmann & Seidl 1974 for overcast skies, and with the
// turbidity Karayel, Navvab, Ne'eman & Selkowitz 1984 for clear ones.
double gensky_zenith(const GenskyGiven& given, const SunAngles& sun) {
  const double overcast = 8.6 * std::sin(sun.altitude) + 0.123;
  if (given.is_cloudy()) return std::max(0.0, overcast) * 1000.0 / sky_efficacy;
  double zenith = (1.376 * given.turbidity - 1.81) * std::tan(sun.altitude) + 0.38;
  if (given.kind == Gensky::intermediate) zenith = 0.5 * (zenith + overcast);
  return std::max(0.0, zenith) * 1000.0 / sky_efficacy;
}

void pass_gensky(Words& words, const RadianceLocation& location, const RadianceSink& sink) {
  const GenskyGiven given = read_gensky(words);
  SunAngles sun = sun_angles(given.sun, words);
  if (!given.is_cloudy()) sun.altitude = std::min(sun.altitude, highest_sun);
  const Eigen::Vector3d towards = direction(sun);
  const GenskyShape shape = gensky_shape(given.kind, sun.altitude);
  double zenith = gensky_zenith(given, sun);
  if (given.zenith) zenith = *given.zenith;
  if (given.diffuse_horizontal) zenith = *given.diffuse_horizontal / (pi * shape.horizontal);
  constexpr double disc = 6e-5;  // sr, gensky's sun
  double solar = 0.0;
  if (!given.is_cloudy() && towards.z() > 0.0) {
    solar = 1.5e9 / sun_efficacy * (1.147 - 0.147 / std::max(towards.z(), 0.16));
    if (given.kind == Gensky::intermediate) solar *= 0.15;
    if (given.sun_radiance) solar = *given.sun_radiance;
    if (given.direct_horizontal) solar = *given.direct_horizontal / (disc * towards.z());
  }
  const double ground = given.ground_reflectance * (zenith * shape.horizontal +
                                                    disc / pi * solar * std::max(0.0, towards.z()));
  std::vector<double> arguments = {static_cast<double>(given.kind), zenith, ground};
  if (!given.is_cloudy()) {
    arguments.insert(arguments.end(), {shape.at_zenith, towards.x(), towards.y(), towards.z()});
  }
  constexpr double across = 0.5;
  pass(location, given.with_sun ? solar : 0.0, across, towards, "skybr", "skybright.cal",
       std::move(arguments), sink);
}

// gendaylit.

struct GendaylitGiven {
  SunGiven sun{};
  char input = 0;  // the letter of the option
  double first = 0.0, second = 0.0;
  double ground_reflectance = 0.2;
  bool with_sun = true;
  int output = 0;  // 0: W of visible light, 1: W of all sunlight, 2: lm
};

GendaylitGiven read_gendaylit(Words& words) {
  GendaylitGiven given{.sun = read_date(words)};
  while (!words.at_end()) {
    const std::string& option = words.word("an option");
    if (read_place(option, words, given.sun)) continue;
    if (option == "-P" || option == "-W" || option == "-L" || option == "-G") {
      given.input = option[1];
      given.first = words.number("a direct value, or a clearness", 0.0, 1e9);
      given.second = words.number("a diffuse value, or a brightness", 0.0, 1e9);
    } else if (option == "-g") {
      given.ground_reflectance = words.number("a reflectance of the ground", 0.0, 1.0);
    } else if (option == "-s") {
      given.with_sun = false;
    } else if (option == "-O") {
      given.output = static_cast<int>(words.number("0, 1 or 2", 0.0, 2.0));
    } else if (option == "-i" || option == "-l") {
      words.number("a value");  // an interval of time, or a latitude's hint: no effect on angles
    } else if (option != "-w" && option != "+s") {
      words.fail(
          fmt::format("has the option '{}', which is not read; known are -P, -W, -L, -G, -a, "
                      "-o, -m, -y, -g, -s, -O and -w",
                      excerpt(option)));
    }
  }
  if (given.input == 0) {
    words.fail("lacks the light of the sky: -W direct diffuse in W/m2, or -L in lux, -G or -P");
  }
  return given;
}

// Irradiances over all wavelengths and what describes the sky's state.
struct Weather {
  double direct_normal = 0.0, diffuse_horizontal = 0.0;  // W/m^2
  double clearness = 1.0, brightness = 0.0;
};

struct EfficacyClass {
  double clearness_below = 0.0;
  std::array<double, 4> diffuse{}, direct{};
};

// Table 4 of Perez et al. 1990: lm/W from water in the air, zenith angle and brightness.
constexpr std::array<EfficacyClass, 8> efficacy_classes = {
    {{1.065, {97.24, -0.46, 12.00, -8.91}, {57.20, -4.55, -2.98, 117.12}},
     {1.230, {107.22, 1.15, 0.59, -3.95}, {98.99, -3.46, -1.21, 12.38}},
     {1.500, {104.97, 2.96, -5.53, -8.77}, {109.83, -4.90, -1.71, -8.81}},
     {1.950, {102.39, 5.59, -13.95, -13.90}, {110.34, -5.84, -1.99, -4.56}},
     {2.800, {100.71, 5.94, -22.75, -23.74}, {106.36, -3.97, -1.75, -6.16}},
     {4.500, {106.42, 3.83, -36.15, -28.83}, {107.19, -1.25, -1.51, -26.73}},
     {6.200, {141.88, 1.90, -53.24, -14.03}, {105.75, 0.77, -1.26, -34.44}},
     {1e9, {152.23, 0.35, -45.27, -7.98}, {101.18, 1.58, -1.10, -8.29}}}};

struct Efficacy {
  double diffuse = 0.0, direct = 0.0;  // lm/W
};

Efficacy efficacy(const Weather& weather, double altitude) {
  constexpr double water = 2.0;  // cm that all vapour above would fill, gendaylit's
  const double Z = 0.5 * pi - altitude;
  const auto at = std::ranges::find_if(efficacy_classes, [&](const EfficacyClass& c) {
    return weather.clearness < c.clearness_below;
  });
  const auto &f = at->diffuse, &n = at->direct;
  return {f[0] + f[1] * water + f[2] * std::cos(Z) + f[3] * std::log(weather.brightness),
          std::max(0.0, n[0] + n[1] * water + n[2] * std::exp(5.73 * Z - 5.0) +
                            n[3] * weather.brightness)};
}

// Air mass after Kasten 1966, and the extraterrestrial irradiance, W/m^2.
double air_mass(double altitude) {
  return 1.0 / (std::sin(altitude) + 0.15 * std::pow(altitude / degree + 3.885, -1.253));
}

double sunlight_above(int day) {
  const double turn = 2.0 * pi * day / 365.0;  // Spencer 1971
  return 1367.0 * (1.00011 + 0.034221 * std::cos(turn) + 0.00128 * std::sin(turn) +
                   0.000719 * std::cos(2.0 * turn) + 0.000077 * std::sin(2.0 * turn));
}

void describe(Weather& weather, double altitude, int day) {
  const double Z = 0.5 * pi - altitude, Z3 = 1.041 * Z * Z * Z;
  weather.clearness =
      ((weather.diffuse_horizontal + weather.direct_normal) / weather.diffuse_horizontal + Z3) /
      (1.0 + Z3);
  weather.brightness =
      std::clamp(weather.diffuse_horizontal * air_mass(altitude) / sunlight_above(day), 0.01, 0.6);
}

Weather weather_of(const GendaylitGiven& given, double altitude, const Words& words) {
  const int day = day_number(given.sun);
  Weather weather{.direct_normal = given.first, .diffuse_horizontal = given.second};
  if (given.input == 'P') {
    const double Z = 0.5 * pi - altitude;
    weather.diffuse_horizontal = given.second * sunlight_above(day) / air_mass(altitude);
    weather.direct_normal =
        weather.diffuse_horizontal * std::max(0.0, given.first - 1.0) * (1.0 + 1.041 * Z * Z * Z);
  }
  if (given.input == 'G') weather.direct_normal = given.first / std::sin(altitude);
  if (!(weather.diffuse_horizontal > 0.0)) {
    words.fail("has no diffuse light; a sky without any is dark");
  }
  if (given.input == 'L') {
    // Watts whose efficacies give these lux, by iteration from 110 lm/W.
    Efficacy lm{110.0, 110.0};
    constexpr int rounds = 50;
    for (int i = 0; i < rounds; ++i) {
      weather.direct_normal = given.first / std::max(1.0, lm.direct);
      weather.diffuse_horizontal = given.second / lm.diffuse;
      describe(weather, altitude, day);
      lm = efficacy(weather, altitude);
    }
  }
  describe(weather, altitude, day);
  return weather;
}

void pass_gendaylit(Words& words, const RadianceLocation& location, Remarks& remarks,
                    const RadianceSink& sink) {
  const GendaylitGiven given = read_gendaylit(words);
  SunAngles sun = sun_angles(given.sun, words);
  sun.altitude = std::min(sun.altitude, highest_sun);
  if (!(sun.altitude > 0.0)) {
    words.fail(fmt::format("has the sun {:.1f} degrees below the horizon; its model is for days",
                           -sun.altitude / degree));
  }
  const Weather weather = weather_of(given, sun.altitude, words);
  const Efficacy lm = efficacy(weather, sun.altitude);
  Spectrum diffuse = Spectrum::Constant(1, static_cast<float>(weather.diffuse_horizontal));
  double direct = weather.direct_normal;
  if (given.output != 1) {
    const double unit = given.output == 0 ? white_efficacy : 1.0;
    diffuse *= static_cast<float>(lm.diffuse / unit);
    direct *= lm.direct / unit;
    if (given.input == 'L') {
      diffuse.setConstant(static_cast<float>(given.second / unit));
      direct = given.first / unit;
    }
  }
  if (given.output == 1) {
    remarks.mention("Skies are in watts of all wavelengths (gendaylit -O 1), so lux mean nothing",
                    "gendaylit");
  } else if (given.output == 2) {
    remarks.mention("Skies are in candela (gendaylit -O 2): watts of the results are lumens",
                    "gendaylit");
  }
  const Eigen::Vector3d towards = direction(sun);
  Sky sky{.up = Eigen::Vector3d::UnitZ(), .north = Eigen::Vector3d::UnitY(), .bright = towards};
  sky.gradation = perez_sky(weather.direct_normal, weather.diffuse_horizontal,
                            sun.altitude / degree, day_number(given.sun));
  sky.scale = Spectrum::Ones(1);
  // Our f has 1 - c exp(d pi/2) where the paper's has 1, and is the paper's over `factor`.
  const SkyGradation& g = sky.gradation;
  const double factor = 1.0 / (1.0 - g.c * std::exp(0.5 * pi * g.d));
  const double horizontal = static_cast<double>(diffuse_horizontal_irradiance(sky)[0]);
  const double diffuse_light = static_cast<double>(diffuse[0]);
  const bool shines = given.with_sun && direct > 0.0;
  // Light of the ground: the dome's by the zenith's radiance, as gensky has it for the kind of sky.
  const double zenith =
      diffuse_light / horizontal * static_cast<double>(sky_radiance(sky, sky.up)[0]);
  const Gensky kind = weather.clearness <= 1.0  ? Gensky::overcast
                      : weather.clearness < 6.0 ? Gensky::intermediate
                                                : Gensky::clear;
  const double ground =
      given.ground_reflectance * (zenith * gensky_shape(kind, sun.altitude).horizontal +
                                  (shines ? direct * towards.z() / pi : 0.0));
  const Sun disc;  // 0.533 degrees across
  pass(location, shines ? direct / disc.solid_angle() : 0.0, disc.angle_degrees, towards,
       "skybright", "perezlum.cal",
       {diffuse_light / (factor * horizontal), ground, g.a, g.b, g.c * factor, g.d, g.e * factor,
        towards.x(), towards.y(), towards.z()},
       sink);
}

}  // namespace

bool is_radiance_sky(std::string_view program) {
  return program == "gensky" || program == "gendaylit";
}

void pass_radiance_sky(const std::vector<std::string>& words, const RadianceLocation& location,
                       Remarks& remarks, const RadianceSink& sink) {
  Words rest(words, location);
  if (words.front() == "gensky") return pass_gensky(rest, location, sink);
  pass_gendaylit(rest, location, remarks, sink);
}

}  // namespace lightwell
