#include "scene/perez_sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/degree.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Perez, Seals & Michalsky 1993, table 1: coefficients x1 to x4 of a, b, c, d and e for each class
// of clearness.
struct PerezClass {
  double clearness_below = 0.0;
  std::array<std::array<double, 4>, 5> x{};
};
constexpr std::array<PerezClass, 8> perez_classes = {{{1.065,
                                                       {{{1.3525, -0.2576, -0.2690, -1.4366},
                                                         {-0.7670, 0.0007, 1.2734, -0.1233},
                                                         {2.8000, 0.6004, 1.2375, 1.0000},
                                                         {1.8734, 0.6297, 0.9738, 0.2809},
                                                         {0.0356, -0.1246, -0.5718, 0.9938}}}},
                                                      {1.230,
                                                       {{{-1.2219, -0.7730, 1.4148, 1.1016},
                                                         {-0.2054, 0.0367, -3.9128, 0.9156},
                                                         {6.9750, 0.1774, 6.4477, -0.1239},
                                                         {-1.5798, -0.5081, -1.7812, 0.1080},
                                                         {0.2624, 0.0672, -0.2190, -0.4285}}}},
                                                      {1.500,
                                                       {{{-1.1000, -0.2515, 0.8952, 0.0156},
                                                         {0.2782, -0.1812, -4.5000, 1.1766},
                                                         {24.7219, -13.0812, -37.7000, 34.8438},
                                                         {-5.0000, 1.5218, 3.9229, -2.6204},
                                                         {-0.0156, 0.1597, 0.4199, -0.5562}}}},
                                                      {1.950,
                                                       {{{-0.5484, -0.6654, -0.2672, 0.7117},
                                                         {0.7234, -0.6219, -5.6812, 2.6297},
                                                         {33.3389, -18.3000, -62.2500, 52.0781},
                                                         {-3.5000, 0.0016, 1.1477, 0.1062},
                                                         {0.4659, -0.3296, -0.0876, -0.0329}}}},
                                                      {2.800,
                                                       {{{-0.6000, -0.3566, -2.5000, 2.3250},
                                                         {0.2937, 0.0496, -5.6812, 1.8415},
                                                         {21.0000, -4.7656, -21.5906, 7.2492},
                                                         {-3.5000, -0.1554, 1.4062, 0.3988},
                                                         {0.0032, 0.0766, -0.0656, -0.1294}}}},
                                                      {4.500,
                                                       {{{-1.0156, -0.3670, 1.0078, 1.4051},
                                                         {0.2875, -0.5328, -3.8500, 3.3750},
                                                         {14.0000, -0.9999, -7.1406, 7.5469},
                                                         {-3.4000, -0.1078, -1.0750, 1.5702},
                                                         {-0.0672, 0.4016, 0.3017, -0.4844}}}},
                                                      {6.200,
                                                       {{{-1.0000, 0.0211, 0.5025, -0.5119},
                                                         {-0.3000, 0.1922, 0.7023, -1.6317},
                                                         {19.0000, -5.0000, 1.2438, -1.9094},
                                                         {-4.0000, 0.0250, 0.3844, 0.2656},
                                                         {1.0468, -0.3788, -2.4517, 1.4656}}}},
                                                      {1e30,
                                                       {{{-1.0500, 0.0289, 0.4260, 0.3590},
                                                         {-0.3250, 0.1156, 0.7781, 0.0025},
                                                         {31.0625, -14.5000, -46.1148, 55.3750},
                                                         {-7.2312, 0.4050, 13.3500, 0.6234},
                                                         {1.5000, -0.6426, 1.8564, 0.5636}}}}}};

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

// Term of the zenith angle in the clearness, kappa Z^3.
double clearness_offset(double sun_altitude_degrees) {
  const double Z = (90.0 - sun_altitude_degrees) * degree;
  return 1.041 * Z * Z * Z;
}

}  // namespace

SkyState sky_state(double direct_normal, double diffuse_horizontal, double sun_altitude_degrees,
                   int day_of_year) {
  const double offset = clearness_offset(sun_altitude_degrees);
  return {.clearness =
              ((diffuse_horizontal + direct_normal) / diffuse_horizontal + offset) / (1.0 + offset),
          .brightness = diffuse_horizontal * relative_air_mass(sun_altitude_degrees) /
                        extraterrestrial_irradiance(day_of_year)};
}

double direct_normal_of(double clearness, double diffuse_horizontal, double sun_altitude_degrees) {
  return diffuse_horizontal * (clearness - 1.0) * (1.0 + clearness_offset(sun_altitude_degrees));
}

double extraterrestrial_irradiance(int day_of_year) {
  constexpr double solar_constant = 1367.0;  // W/m^2, the value of Perez' fits
  return solar_constant * (1.0 + 0.033 * std::cos(2.0 * pi * day_of_year / 365.0));
}

SkyGradation perez_sky(double direct_normal, double diffuse_horizontal, double sun_altitude_degrees,
                       int day_of_year) {
  if (!(diffuse_horizontal > 0.0) || !(direct_normal >= 0.0) || !std::isfinite(direct_normal) ||
      !std::isfinite(diffuse_horizontal)) {
    throw std::invalid_argument(
        fmt::format("a sky by Perez needs a diffuse irradiance above 0 and a direct one of at "
                    "least 0, not {} and {} W/m2",
                    diffuse_horizontal, direct_normal));
  }
  if (!(sun_altitude_degrees > 0.0 && sun_altitude_degrees <= 90.0)) {
    throw std::invalid_argument(
        fmt::format("a sky by Perez needs the sun above the horizon, not at {:.2f} degrees",
                    sun_altitude_degrees));
  }
  return perez_sky(sky_state(direct_normal, diffuse_horizontal, sun_altitude_degrees, day_of_year),
                   sun_altitude_degrees);
}

SkyGradation perez_sky(const SkyState& state, double sun_altitude_degrees) {
  const double Z = (90.0 - sun_altitude_degrees) * degree;
  double brightness = state.brightness;
  const auto at =
      std::find_if(perez_classes.begin(), perez_classes.end() - 1,
                   [e = state.clearness](const PerezClass& c) { return e < c.clearness_below; });
  const bool is_overcast = at == perez_classes.begin();
  // Outside the range of the data the formulas give dark or bright rings.
  if (state.clearness > 1.065 && state.clearness < 2.8) brightness = std::max(brightness, 0.2);
  const auto value = [&](std::size_t i) {
    const auto& x = at->x[i];
    return x[0] + x[1] * Z + brightness * (x[2] + x[3] * Z);
  };
  SkyGradation sky{.a = value(0), .b = value(1), .c = value(2), .d = value(3), .e = value(4)};
  if (is_overcast) {
    const auto &c = at->x[2], &d = at->x[3];
    sky.c = std::exp(std::pow(std::max(0.0, brightness * (c[0] + c[1] * Z)), c[2])) - c[3];
    sky.d = -std::exp(brightness * (d[0] + d[1] * Z)) + d[2] + brightness * d[3];
  }
  // The paper has f = 1 + c exp(d chi) + e cos^2 chi, which differs by a constant factor.
  const double factor = 1.0 + sky.c * std::exp(0.5 * pi * sky.d);
  sky.c /= factor;
  sky.e /= factor;
  return sky;
}

SkyState within_data(SkyState state) {
  constexpr double least_brightness = 0.01, most_brightness = 0.6, most_clearness = 11.9;
  return {.clearness = std::clamp(state.clearness, 1.0, most_clearness),
          .brightness = std::clamp(state.brightness, least_brightness, most_brightness)};
}

DaylightEfficacy perez_efficacy(const SkyState& state, double sun_altitude_degrees,
                                double water_cm) {
  const double Z = (90.0 - sun_altitude_degrees) * degree;
  const auto at =
      std::find_if(efficacy_classes.begin(), efficacy_classes.end() - 1,
                   [&](const EfficacyClass& c) { return state.clearness < c.clearness_below; });
  const auto &f = at->diffuse, &n = at->direct;
  return {std::max(0.0,
                   f[0] + f[1] * water_cm + f[2] * std::cos(Z) + f[3] * std::log(state.brightness)),
          std::max(0.0, n[0] + n[1] * water_cm + n[2] * std::exp(5.73 * Z - 5.0) +
                            n[3] * state.brightness)};
}

double precipitable_water_cm(double dew_point_celsius) {
  return std::exp(0.07 * dew_point_celsius - 0.075);
}

}  // namespace lightwell
