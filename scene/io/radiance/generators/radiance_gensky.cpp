// gensky's skies: CIE 1973 (clear sky), Moon & Spencer 1942 (overcast), Nakamura, Oki & Hayashi
// 1985 (intermediate).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/io/radiance/generators/radiance_sky_call.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// lm/W of gensky for the light of sky and sun.
constexpr double sky_efficacy = 203.0, sun_efficacy = 208.0;

struct GenskyGiven {
  SunGiven sun{};
  SkyOfGensky kind = SkyOfGensky::clear;
  bool with_sun = true;
  double turbidity = 2.45, ground_reflectance = 0.2;
  std::optional<double> zenith{}, diffuse_horizontal{};       // W/(m^2 sr), W/m^2
  std::optional<double> sun_radiance{}, direct_horizontal{};  // W/(m^2 sr), W/m^2

  bool is_cloudy() const { return kind == SkyOfGensky::overcast || kind == SkyOfGensky::uniform; }
};

GenskyGiven read_gensky(SkyCall& call) {
  GenskyGiven given{.sun = read_date(call)};
  while (!call.at_end()) {
    const std::string& option = call.word("an option");
    if (read_place(option, call, given.sun)) continue;
    if (option == "-s" || option == "+s" || option == "-i" || option == "+i") {
      given.kind = option[1] == 's' ? SkyOfGensky::clear : SkyOfGensky::intermediate;
      given.with_sun = option[0] == '+';
    } else if (option == "-c" || option == "-u") {
      given.kind = option == "-c" ? SkyOfGensky::overcast : SkyOfGensky::uniform;
    } else if (option == "-t") {
      given.turbidity = call.number("a turbidity", 0.0, 1e3);
    } else if (option == "-g") {
      given.ground_reflectance = call.number("a reflectance of the ground", 0.0, 1.0);
    } else if (option == "-b") {
      given.zenith = call.number("a radiance of the zenith", 0.0, 1e12);
    } else if (option == "-B") {
      given.diffuse_horizontal = call.number("a diffuse irradiance", 0.0, 1e12);
    } else if (option == "-r") {
      given.sun_radiance = call.number("a radiance of the sun", 0.0, 1e15);
    } else if (option == "-R") {
      given.direct_horizontal = call.number("a direct irradiance", 0.0, 1e12);
    } else {
      call.fail(fmt::format("has the option '{}', which is not known", excerpt(option)));
    }
  }
  return given;
}

// Zenith luminance by the sun's altitude: Krochmann & Seidl 1974 for overcast skies, and with the
// turbidity Karayel, Navvab, Ne'eman & Selkowitz 1984 for clear ones.
double gensky_zenith(const GenskyGiven& given, const SunAngles& sun) {
  const double overcast = 8.6 * std::sin(sun.altitude) + 0.123;
  if (given.is_cloudy()) return std::max(0.0, overcast) * 1000.0 / sky_efficacy;
  double zenith = (1.376 * given.turbidity - 1.81) * std::tan(sun.altitude) + 0.38;
  if (given.kind == SkyOfGensky::intermediate) zenith = 0.5 * (zenith + overcast);
  return std::max(0.0, zenith) * 1000.0 / sky_efficacy;
}

}  // namespace

ZenithShape zenith_shape(SkyOfGensky kind, double altitude) {
  if (kind == SkyOfGensky::uniform) return {1.0, 1.0};
  if (kind == SkyOfGensky::overcast) return {1.0, 7.0 / 9.0};
  const double from_zenith = 0.5 * pi - altitude, x = altitude / (0.25 * pi) - 1.0;
  if (kind == SkyOfGensky::clear) {
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

void pass_gensky(SkyCall& call, const RadianceSink& sink) {
  const GenskyGiven given = read_gensky(call);
  SunAngles sun = sun_angles(given.sun, call);
  if (!given.is_cloudy()) sun.altitude = std::min(sun.altitude, highest_sun);
  const Eigen::Vector3d towards = sun.direction();
  const ZenithShape shape = zenith_shape(given.kind, sun.altitude);
  double zenith = gensky_zenith(given, sun);
  if (given.zenith) zenith = *given.zenith;
  if (given.diffuse_horizontal) zenith = *given.diffuse_horizontal / (pi * shape.horizontal);
  constexpr double disc = 6e-5;  // sr, gensky's sun
  double solar = 0.0;
  if (!given.is_cloudy() && towards.z() > 0.0) {
    solar = 1.5e9 / sun_efficacy * (1.147 - 0.147 / std::max(towards.z(), 0.16));
    if (given.kind == SkyOfGensky::intermediate) solar *= 0.15;
    if (given.sun_radiance) solar = *given.sun_radiance;
    if (given.direct_horizontal) solar = *given.direct_horizontal / (disc * towards.z());
  }
  const double ground = given.ground_reflectance * (zenith * shape.horizontal +
                                                    disc / pi * solar * std::max(0.0, towards.z()));
  std::vector<double> arguments = {static_cast<double>(given.kind), zenith, ground};
  if (!given.is_cloudy()) {
    arguments.insert(arguments.end(), {shape.at_zenith, towards.x(), towards.y(), towards.z()});
  }
  pass_sky({.sun_radiance = given.with_sun ? solar : 0.0,
            .sun = towards,
            .function = "skybr",
            .file = "skybright.cal",
            .arguments = std::move(arguments)},
           call.location(), sink);
}

}  // namespace lightwell
