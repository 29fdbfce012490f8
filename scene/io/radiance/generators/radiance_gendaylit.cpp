// gendaylit's skies by Perez' model (see perez_sky.h).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/degree.h"
#include "scene/io/radiance/generators/radiance_sky_call.h"
#include "scene/io/radiance/text/radiance_bands.h"
#include "scene/io/text_file.h"
#include "scene/perez_sky.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

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
  SkyState state{};
};

constexpr double water = 2.0;  // cm that all vapour above would fill, gendaylit's

DaylightEfficacy efficacy(const Weather& weather, double altitude) {
  return perez_efficacy(weather.state, altitude / degree, water);
}

void describe(Weather& weather, double altitude, int day) {
  weather.state =
      sky_state(weather.direct_normal, weather.diffuse_horizontal, altitude / degree, day);
  // Limits of gendaylit.
  weather.state.brightness = std::clamp(weather.state.brightness, 0.01, 0.6);
}

Weather weather_of(const GendaylitGiven& given, double altitude, const SkyCall& call) {
  const int day = day_number(given.sun);
  Weather weather{.direct_normal = given.first, .diffuse_horizontal = given.second};
  if (given.input == 'P') {
    weather.diffuse_horizontal =
        given.second * extraterrestrial_irradiance(day) / relative_air_mass(altitude / degree);
    weather.direct_normal =
        direct_normal_of(std::max(1.0, given.first), weather.diffuse_horizontal, altitude / degree);
  }
  if (given.input == 'G') weather.direct_normal = given.first / std::sin(altitude);
  if (!(weather.diffuse_horizontal > 0.0)) {
    call.fail("has no diffuse light; a sky without any is dark");
  }
  if (given.input == 'L') {
    // Watts whose efficacies give these lux, by iteration from 110 lm/W.
    DaylightEfficacy lm{110.0, 110.0};
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

// Light of dome and sun in the output's unit: W/m^2 on open ground, and across the sun's rays.
struct SkyLux {
  double dome = 0.0, sun = 0.0;
};

SkyLux output_of(const GendaylitGiven& given, const Weather& weather, double altitude) {
  if (given.output == 1) return {weather.diffuse_horizontal, weather.direct_normal};
  const double unit = given.output == 0 ? radiance_lumens_per_watt : 1.0;
  if (given.input == 'L') return {given.second / unit, given.first / unit};
  const DaylightEfficacy lm = efficacy(weather, altitude);
  return {weather.diffuse_horizontal * lm.diffuse / unit, weather.direct_normal * lm.direct / unit};
}

void mention_unit(int output, Remarks& remarks) {
  if (output == 1) {
    remarks.mention("Skies are in watts of all wavelengths (gendaylit -O 1), so lux mean nothing",
                    "gendaylit");
  } else if (output == 2) {
    remarks.mention("Skies are in candela (gendaylit -O 2): watts of the results are lumens",
                    "gendaylit");
  }
}

SkyOfGensky kind_of(const SkyState& state) {
  if (state.clearness <= 1.0) return SkyOfGensky::overcast;
  return state.clearness < 6.0 ? SkyOfGensky::intermediate : SkyOfGensky::clear;
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
  SkyLux light = output_of(given, weather, sun.altitude);
  if (!given.with_sun) light.sun = 0.0;
  mention_unit(given.output, remarks);
  const Eigen::Vector3d towards = sun.direction();
  Sky sky{.up = Eigen::Vector3d::UnitZ(), .north = Eigen::Vector3d::UnitY(), .bright = towards};
  sky.gradation = perez_sky(weather.direct_normal, weather.diffuse_horizontal,
                            sun.altitude / degree, day_number(given.sun));
  sky.scale = Spectrum::Ones(1);
  const double horizontal = static_cast<double>(diffuse_horizontal_irradiance(sky)[0]);
  const double at_zenith = static_cast<double>(sky_radiance(sky, sky.up)[0]);
  // Light of the ground: the dome's by the zenith's radiance, as gensky has it for the kind of sky.
  const double dome_over_pi = light.dome / horizontal * at_zenith *
                              zenith_shape(kind_of(weather.state), sun.altitude).horizontal;
  const double ground = given.ground_reflectance * (dome_over_pi + light.sun * towards.z() / pi);
  // SkyGradation's f has 1 - c exp(d pi/2) where the paper's has 1, and is the paper's over
  // `factor`.
  const SkyGradation& g = sky.gradation;
  const double factor = 1.0 / (1.0 - g.c * std::exp(0.5 * pi * g.d));
  const Sun disc;  // 0.533 degrees across
  pass_sky({.sun_radiance = light.sun / disc.solid_angle(),
            .sun_degrees = disc.angle_degrees,
            .sun = towards,
            .function = "skybright",
            .file = "perezlum.cal",
            .arguments = {light.dome / (factor * horizontal), ground, g.a, g.b, g.c * factor, g.d,
                          g.e * factor, towards.x(), towards.y(), towards.z()}},
           call.location(), sink);
}

}  // namespace lightwell
