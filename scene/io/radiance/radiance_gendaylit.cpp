// gendaylit's skies: Perez, Seals & Michalsky 1993 (distribution); Perez, Ineichen, Seals,
// Michalsky & Stewart 1990 (efficacy).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/degree.h"
#include "scene/io/radiance/radiance_sky_call.h"
#include "scene/io/text_file.h"
#include "scene/sky.h"

namespace lightwell {
namespace {

using std::numbers::pi;

constexpr double white_efficacy = 179.0;  // lm/W of RADIANCE's white

struct GendaylitGiven {
  SunGiven sun{};
  char input = 0;  // the letter of the option
  double first = 0.0, second = 0.0;
  double ground_reflectance = 0.2;
  bool with_sun = true;
  int output = 0;  // 0: W of visible light, 1: W of all sunlight, 2: lm
};

GendaylitGiven read_gendaylit(SkyCall& call) {
  GendaylitGiven given{.sun = read_date(call)};
  while (!call.at_end()) {
    const std::string& option = call.word("an option");
    if (read_place(option, call, given.sun)) continue;
    if (option == "-P" || option == "-W" || option == "-L" || option == "-G") {
      given.input = option[1];
      given.first = call.number("a direct value, or a clearness", 0.0, 1e9);
      given.second = call.number("a diffuse value, or a brightness", 0.0, 1e9);
    } else if (option == "-g") {
      given.ground_reflectance = call.number("a reflectance of the ground", 0.0, 1.0);
    } else if (option == "-s") {
      given.with_sun = false;
    } else if (option == "-O") {
      given.output = static_cast<int>(call.number("0, 1 or 2", 0.0, 2.0));
    } else if (option == "-i" || option == "-l") {
      call.number("a value");  // an interval of time, or a latitude's hint: no effect on angles
    } else if (option != "-w" && option != "+s") {
      call.fail(
          fmt::format("has the option '{}', which is not read; known are -P, -W, -L, -G, -a, "
                      "-o, -m, -y, -g, -s, -O and -w",
                      excerpt(option)));
    }
  }
  if (given.input == 0) {
    call.fail("lacks the light of the sky: -W direct diffuse in W/m2, or -L in lux, -G or -P");
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

Weather weather_of(const GendaylitGiven& given, double altitude, const SkyCall& call) {
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
    call.fail("has no diffuse light; a sky without any is dark");
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

}  // namespace

void pass_gendaylit(SkyCall& call, Remarks& remarks, const RadianceSink& sink) {
  const GendaylitGiven given = read_gendaylit(call);
  SunAngles sun = sun_angles(given.sun, call);
  sun.altitude = std::min(sun.altitude, highest_sun);
  if (!(sun.altitude > 0.0)) {
    call.fail(fmt::format("has the sun {:.1f} degrees below the horizon; its model is for days",
                          -sun.altitude / degree));
  }
  const Weather weather = weather_of(given, sun.altitude, call);
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
  const Eigen::Vector3d towards = sun.direction();
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
  const SkyOfGensky kind = weather.clearness <= 1.0  ? SkyOfGensky::overcast
                           : weather.clearness < 6.0 ? SkyOfGensky::intermediate
                                                     : SkyOfGensky::clear;
  const double ground =
      given.ground_reflectance * (zenith * zenith_shape(kind, sun.altitude).horizontal +
                                  (shines ? direct * towards.z() / pi : 0.0));
  const Sun disc;  // 0.533 degrees across
  pass_sky({.sun_radiance = shines ? direct / disc.solid_angle() : 0.0,
            .sun_degrees = disc.angle_degrees,
            .sun = towards,
            .function = "skybright",
            .file = "perezlum.cal",
            .arguments = {diffuse_light / (factor * horizontal), ground, g.a, g.b, g.c * factor,
                          g.d, g.e * factor, towards.x(), towards.y(), towards.z()}},
           call.location(), sink);
}

}  // namespace lightwell
