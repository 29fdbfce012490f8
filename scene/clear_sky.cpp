#include "scene/clear_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "scene/degree.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Coefficients of turbidity t / 10 and x = (altitude / 90 degrees)^(1/3): 1, t, t^2, x, x^2, t x.
using Quadratic = std::array<double, 6>;

// a, ln b, ln c, ln d, e and f of the radiance in r, g and b.
constexpr std::array<std::array<Quadratic, 6>, 3> shapes = {{
    {{{{-1.178, -0.196, -0.228, 0.331, -0.288, 0.462}},
      {{-1.128, 1.143, 1.625, -4.095, 3.965, -2.094}},
      {{0.182, 9.416, -7.31, 2.325, -3.315, 1.249}},
      {{1.159, 0.568, -0.566, -0.044, 0.151, -0.029}},
      {{3.296, -0.221, -0.995, -5.7, 2.847, 0.18}},
      {{8.381, -2.247, -2.76, -13.115, 3.679, 5.241}}}},
    {{{{-1.233, -0.126, -0.264, 0.454, -0.347, 0.372}},
      {{-0.635, 0.504, 1.802, -4.63, 3.649, -1.105}},
      {{-0.103, 8.548, -7.259, 3.621, -3.994, 1.758}},
      {{1.023, 0.715, -0.559, 0.161, 0.189, -0.32}},
      {{5.189, -1.941, -0.239, -8.039, 4.039, 0.376}},
      {{19.792, -9.335, -6.53, -26.394, 5.854, 15.816}}}},
    {{{{-1.5, -0.101, -0.207, 1.019, -0.615, 0.264}},
      {{0.586, -0.062, 1.054, -5.816, 3.498, 0.205}},
      {{-2.256, 6.165, -4.501, 9.85, -8.105, 1.646}},
      {{0.464, 1.066, -0.626, 1.028, -0.174, -0.563}},
      {{6.163, 0.04, -2.133, -10.395, 5.649, 0.243}},
      {{34.65, -11.785, -5.878, -45.684, 12.235, 16.449}}}},
}};

// ln E in r, g and b for turbidities 1 to 10: coefficients of x^0 to x^5.
constexpr std::array<std::array<std::array<double, 6>, 3>, 10> levels = {{
    {{{{-3.691, 2.58, 1.2, -8.18, 10.33, -4.37}},
      {{-3.513, -0.91, 20.93, -39.52, 29.26, -7.68}},
      {{-3.605, -4.88, 47.41, -92.59, 76.96, -24.12}}}},
    {{{{-3.076, -3.32, 22.6, -40.71, 32.14, -9.54}},
      {{-3.65, 0.27, 16.98, -31.68, 21.73, -4.98}},
      {{-3.501, -6.35, 54.14, -106.06, 89.49, -28.51}}}},
    {{{{-4.223, 8.71, -23.93, 48.21, -48.68, 18.3}},
      {{-3.64, -0.75, 24.05, -47.38, 37.17, -10.68}},
      {{-3.439, -7.37, 59.14, -116.54, 99.96, -32.52}}}},
    {{{{-4.204, 7.23, -13.51, 27.44, -30.47, 12.12}},
      {{-3.49, -3.98, 41.33, -82.96, 70.45, -22.45}},
      {{-3.248, -10.24, 72.91, -145.42, 128.15, -42.86}}}},
    {{{{-4.168, 5.23, -0.86, 1.82, -7.91, 4.73}},
      {{-3.841, -0.68, 28.54, -56.73, 45.03, -13.21}},
      {{-3.304, -10.24, 74.21, -149.58, 133.67, -45.41}}}},
    {{{{-4.27, 5.37, 1.23, -3.58, -2.59, 2.8}},
      {{-3.861, -1.15, 32.73, -67.32, 56.71, -17.94}},
      {{-3.202, -11.94, 82.46, -167.35, 151.69, -52.29}}}},
    {{{{-4.198, 3.08, 14.28, -30.35, 21.85, -5.51}},
      {{-3.825, -2.78, 42.48, -89.42, 79.6, -26.79}},
      {{-3.308, -11.06, 79.18, -161.47, 147.27, -51.18}}}},
    {{{{-4.107, -0.01, 32.87, -72.65, 65.41, -22.23}},
      {{-3.771, -4.83, 55.15, -119.93, 113.04, -40.3}},
      {{-3.144, -13.56, 90.6, -185.17, 171.04, -60.28}}}},
    {{{{-4.396, 1.11, 34.63, -85.73, 86.35, -32.48}},
      {{-3.629, -8.01, 71.48, -156.04, 150.99, -55.28}},
      {{-3.105, -14.6, 94.99, -194.44, 181.91, -65.18}}}},
    {{{{-3.776, -7.92, 75.44, -168.99, 167.47, -62.55}},
      {{-3.398, -11.23, 82.64, -173.8, 166.65, -61.13}},
      {{-3.018, -16.35, 100.58, -201.7, 187.07, -66.85}}}},
}};

// Relative growth of E by the albedo's excess over 0.3: a polynomial as above, and the coefficients
// of 1, x and t for the square of the excess.
struct Growth {
  Quadratic linear{};
  std::array<double, 3> square{};
};
constexpr std::array<Growth, 3> growths = {{
    {.linear = {{-0.357, -0.243, 0.653, 1.456, 0.059, -1.18}}, .square = {{0.241, -0.389, -0.112}}},
    {.linear = {{-0.424, -0.013, 0.366, 1.608, -0.091, -1.088}},
     .square = {{0.135, -0.231, -0.059}}},
    {.linear = {{-0.457, 0.246, -0.026, 1.505, -0.138, -0.746}},
     .square = {{0.079, -0.177, 0.012}}},
}};

// ln I_0, and ln tau by powers of t / 10 and the logarithm m of the air mass: 1, m, m^2, t, t m,
// t m^2, t^2, t^2 m, t^2 m^2.
using SunFit = std::array<double, 10>;
constexpr std::array<SunFit, 3> suns_of_hosek = {{
    {{0.444, -4.557, 2.724, -0.433, 4.306, -4.101, 1.247, -0.789, 2.75, -0.936}},
    {{0.364, -2.527, 1.6, -0.184, 0.997, -1.273, 0.507, 0.805, 0.887, -0.398}},
    {{0.329, -1.219, 1.083, -0.02, -0.08, -0.132, 0.064, 0.896, 0.085, -0.05}},
}};
constexpr std::array<SunFit, 3> suns_of_preetham = {{
    {{2.117, 0.409, -0.013, 0.054, 0.564, 0.282, 0.31, -0.151, 0.175, -0.294}},
    {{2.156, 0.502, -0.015, 0.073, 0.593, 0.484, 0.228, -0.129, -0.019, -0.223}},
    {{1.997, 0.436, 0.056, 0.096, 0.789, 0.665, 0.159, -0.178, -0.205, -0.151}},
}};

// The two variables of the polynomials.
struct Variables {
  double t = 0.0, x = 0.0;
};

Variables variables_of(const ClearDay& day) {
  return {.t = day.turbidity / 10.0, .x = std::cbrt(day.sun_altitude_degrees / 90.0)};
}

double value_of(const Quadratic& q, const Variables& v) {
  return q[0] + v.t * (q[1] + v.t * q[2]) + v.x * (q[3] + v.x * q[4] + v.t * q[5]);
}

// E with the albedo of 0.3 that the fits start from.
double plain_irradiance(const ClearDay& day, std::size_t channel) {
  const double x = variables_of(day).x;
  const auto at_level = [&](int level) {
    const auto& c = levels[static_cast<std::size_t>(level)][channel];
    double sum = 0.0;
    for (auto i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return std::exp(sum);
  };
  const int lower = std::clamp(static_cast<int>(day.turbidity) - 1, 0, 8);
  return std::lerp(at_level(lower), at_level(lower + 1), day.turbidity - 1.0 - lower);
}

double growth_by_albedo(const ClearDay& day, std::size_t channel) {
  const Variables v = variables_of(day);
  const auto& [linear, square] = growths[channel];
  constexpr double albedo_of_fits = 0.3;
  const double excess =
      static_cast<double>(day.albedo[static_cast<Eigen::Index>(channel)]) - albedo_of_fits;
  return excess * (value_of(linear, v) + excess * (square[0] + square[1] * v.x + square[2] * v.t));
}

// Radiance of one channel.
struct Channel {
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0, e = 0.0, f = 0.0;
  double scale = 1.0;        // of the two factors
  double from_ground = 0.0;  // of the light by albedo

  double factors(double cos_zenith, double cos_gamma) const {
    const double gamma = std::acos(std::clamp(cos_gamma, -1.0, 1.0));
    return (1.0 + a * std::exp(-b / (cos_zenith + 0.01))) *
           (1.0 + c * std::exp(-d * gamma) + e * cos_gamma * cos_gamma + f * std::sqrt(cos_zenith));
  }
  double radiance(double cos_zenith, double cos_gamma) const {
    return std::max(
        0.0, scale * factors(cos_zenith, cos_gamma) + from_ground / (cos_zenith + brightening));
  }
  static constexpr double brightening = 0.2;
};

double cos_between(double zenith, double sun_zenith, double azimuth_from_sun) {
  return std::cos(zenith) * std::cos(sun_zenith) +
         std::sin(zenith) * std::sin(sun_zenith) * std::cos(azimuth_from_sun);
}

// The integral of the factors and the cosine over the hemisphere, by the midpoint rule in sin^2 Z.
double integral_of_factors(const Channel& channel, double sun_zenith) {
  constexpr int rings = 96, around = 96;  // 1e-4 of the result for all suns
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double zenith = std::asin(std::sqrt((i + 0.5) / rings));
    for (int j = 0; j < around; ++j) {
      const double azimuth = pi * (j + 0.5) / around;
      sum += channel.factors(std::cos(zenith), cos_between(zenith, sun_zenith, azimuth));
    }
  }
  return sum * pi / (rings * around);
}

Channel channel_of(const ClearDay& day, std::size_t number) {
  const auto& shape = shapes[number];
  const Variables v = variables_of(day);
  Channel channel{.a = value_of(shape[0], v),
                  .b = std::exp(value_of(shape[1], v)),
                  .c = std::exp(value_of(shape[2], v)),
                  .d = std::exp(value_of(shape[3], v)),
                  .e = value_of(shape[4], v),
                  .f = value_of(shape[5], v)};
  const double E = plain_irradiance(day, number);
  channel.scale = E / integral_of_factors(channel, (90.0 - day.sun_altitude_degrees) * degree);
  // The integral of z / (z + k) over the hemisphere's z = cos Z and its turns.
  constexpr double k = Channel::brightening;
  const double turns = 2.0 * pi * (1.0 - k * std::log((1.0 + k) / k));
  channel.from_ground = E * growth_by_albedo(day, number) / turns;
  return channel;
}

}  // namespace

Spectrum clear_sky_irradiance(const ClearDay& day) {
  Spectrum E(3);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto channel = static_cast<std::size_t>(k);
    E[k] =
        static_cast<float>(plain_irradiance(day, channel) * (1.0 + growth_by_albedo(day, channel)));
  }
  return E;
}

Spectrum clear_sun_irradiance(ClearSunModel model, double turbidity, double sun_altitude_degrees) {
  const double t = turbidity / 10.0, m = std::log(relative_air_mass(sun_altitude_degrees));
  const auto& fits = model == ClearSunModel::preetham ? suns_of_preetham : suns_of_hosek;
  Spectrum I(3);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const SunFit& c = fits[static_cast<std::size_t>(k)];
    const double ln_tau = c[1] + m * (c[2] + m * c[3]) + t * (c[4] + m * (c[5] + m * c[6])) +
                          t * t * (c[7] + m * (c[8] + m * c[9]));
    I[k] = static_cast<float>(std::exp(c[0] - std::exp(ln_tau)));
  }
  return I;
}

EnvironmentMap clear_sky_map(const ClearDay& day, const ClearDome& dome) {
  constexpr int width = 720, height = width / 2;  // pixels half a degree wide, as wide as the sun
  const std::array channels = {channel_of(day, 0), channel_of(day, 1), channel_of(day, 2)};
  const double sun_zenith = (90.0 - day.sun_altitude_degrees) * degree;
  BandArray radiance(width * height, 3);
  for (int row = 0; row < height; ++row) {
    const double zenith = pi * (row + 0.5) / height / dome.stretch;
    const double cosine = std::cos(zenith);
    for (int column = 0; column < width; ++column) {
      auto pixel = radiance.row(row * width + column);
      if (cosine <= 0.0) {
        pixel = dome.below.transpose();
        continue;
      }
      const double azimuth = 2.0 * pi * ((column + 0.5) / width - 0.5);
      const double cos_gamma = cos_between(zenith, sun_zenith, azimuth);
      for (Eigen::Index k = 0; k < 3; ++k) {
        pixel[k] = static_cast<float>(
            dome.scale * channels[static_cast<std::size_t>(k)].radiance(cosine, cos_gamma));
      }
    }
  }
  return {width, height, std::move(radiance)};
}

void set_clear_dome(const ClearDay& day, const ClearDome& dome, const Eigen::Vector3d& to_sun,
                    Sky& sky) {
  const Eigen::Vector3d level = to_sun - to_sun.dot(sky.up) * sky.up;
  constexpr double at_zenith = 1e-9;
  sky.kind = SkyKind::map;
  sky.name = fmt::format("clear, turbidity {:g}", day.turbidity);
  sky.map = std::make_shared<const EnvironmentMap>(clear_sky_map(day, dome));
  sky.to_map = to_map_around(sky.up, level.norm() > at_zenith ? level.normalized() : sky.north);
  sky.scale.setConstant(1.0f);
}

}  // namespace lightwell
