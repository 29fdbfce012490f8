#include "scene/sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/degree.h"
#include "scene/limits.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// ISO 15469:2004, table 1.
constexpr std::array<SkyGradation, 15> standard_skies = {{{4.0, -0.70, 0.0, -1.0, 0.00},
                                                          {4.0, -0.70, 2.0, -1.5, 0.15},
                                                          {1.1, -0.80, 0.0, -1.0, 0.00},
                                                          {1.1, -0.80, 2.0, -1.5, 0.15},
                                                          {0.0, -1.00, 0.0, -1.0, 0.00},
                                                          {0.0, -1.00, 2.0, -1.5, 0.15},
                                                          {0.0, -1.00, 5.0, -2.5, 0.30},
                                                          {0.0, -1.00, 10.0, -3.0, 0.45},
                                                          {-1.0, -0.55, 2.0, -1.5, 0.15},
                                                          {-1.0, -0.55, 5.0, -2.5, 0.30},
                                                          {-1.0, -0.55, 10.0, -3.0, 0.45},
                                                          {-1.0, -0.32, 10.0, -3.0, 0.45},
                                                          {-1.0, -0.32, 16.0, -3.0, 0.30},
                                                          {-1.0, -0.15, 16.0, -3.0, 0.30},
                                                          {-1.0, -0.15, 24.0, -2.8, 0.15}}};

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

double gradation(const SkyGradation& g, double cos_zenith, double cos_chi) {
  // exp(b / cos Z) tends to 0 at the horizon for b < 0; some classes of Perez have b > 0.
  constexpr double nearly_horizon = 1e-3;
  const double phi =
      g.a == 0.0 ? 1.0 : 1.0 + g.a * std::exp(g.b / std::max(cos_zenith, nearly_horizon));
  if (g.c == 0.0 && g.e == 0.0) return std::max(0.0, phi);
  const double chi = std::acos(std::clamp(cos_chi, -1.0, 1.0));
  const double f =
      1.0 + g.c * (std::exp(g.d * chi) - std::exp(g.d * 0.5 * pi)) + g.e * cos_chi * cos_chi;
  return std::max(0.0, phi) * std::max(0.0, f);
}

double relative_radiance(const Sky& sky, const Eigen::Vector3d& direction) {
  const double cos_zenith = direction.dot(sky.up);
  if (sky.kind == SkyKind::overcast) return (1.0 + 2.0 * cos_zenith) / 3.0;
  return gradation(sky.gradation, cos_zenith, direction.dot(sky.bright));
}

bool is_unit(const Eigen::Vector3d& v) {
  return std::abs(v.squaredNorm() - 1.0) < 1e-6;
}

[[noreturn]] void refuse_sky(const std::string& sentence) {
  throw std::invalid_argument(sentence);
}

void check_light(const Spectrum& values, const Bands& bands, const char* what) {
  if (values.size() != bands.count()) {
    refuse_sky(
        fmt::format("the sky's {} has {} bands, the scene {}", what, values.size(), bands.count()));
  }
  if (!values.isFinite().all() || (values < 0.0f).any()) {
    refuse_sky(fmt::format("the sky's {} must be finite and not below 0", what));
  }
  if (values.maxCoeff() > most_light) {
    refuse_sky(fmt::format("the sky's {} is {:g}; it must not exceed {:g}", what, values.maxCoeff(),
                           most_light));
  }
}

// Term of the zenith angle in the clearness, kappa Z^3.
double clearness_offset(double sun_altitude_degrees) {
  const double Z = (90.0 - sun_altitude_degrees) * degree;
  return 1.041 * Z * Z * Z;
}

}  // namespace

double Sun::cosine_of_edge() const {
  return std::cos(0.5 * angle_degrees * degree);
}

double Sun::solid_angle() const {
  const double sine = std::sin(0.25 * angle_degrees * degree);
  return 4.0 * pi * sine * sine;  // 2 pi (1 - cos) without cancellation
}

SkyGradation standard_sky(int number) {
  if (number < 1 || number > static_cast<int>(standard_skies.size())) {
    refuse_sky(fmt::format("there is no standard sky {}; give 1 to 15", number));
  }
  return standard_skies[static_cast<std::size_t>(number - 1)];
}

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
    refuse_sky(
        fmt::format("a sky by Perez needs a diffuse irradiance above 0 and a direct one of at "
                    "least 0, not {} and {} W/m2",
                    diffuse_horizontal, direct_normal));
  }
  if (!(sun_altitude_degrees > 0.0 && sun_altitude_degrees <= 90.0)) {
    refuse_sky(fmt::format("a sky by Perez needs the sun above the horizon, not at {:.2f} degrees",
                           sun_altitude_degrees));
  }
  const double Z = (90.0 - sun_altitude_degrees) * degree;
  const auto [clearness, measured_brightness] =
      sky_state(direct_normal, diffuse_horizontal, sun_altitude_degrees, day_of_year);
  double brightness = measured_brightness;
  const auto at =
      std::find_if(perez_classes.begin(), perez_classes.end() - 1,
                   [&, e = clearness](const PerezClass& c) { return e < c.clearness_below; });
  const bool is_overcast = at == perez_classes.begin();
  // Outside the range of the data the formulas give dark or bright rings.
  if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
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

Sky dark_sky(const Bands& bands) {
  return {.name = "dark",
          .scale = constant_spectrum(bands, 0.0f),
          .ground = constant_spectrum(bands, 0.0f)};
}

bool has_dome(const Sky& sky) {
  return (sky.scale > 0.0f).any() || (sky.kind != SkyKind::map && (sky.ground > 0.0f).any());
}

Spectrum sky_radiance(const Sky& sky, const Eigen::Vector3d& direction) {
  if (sky.kind == SkyKind::map) return sky.scale * sky.map->at(sky.to_map * direction);
  if (direction.dot(sky.up) < 0.0) return sky.ground;
  return sky.scale * static_cast<float>(relative_radiance(sky, direction));
}

Spectrum radiance_outside(const Sky& sky, const Eigen::Vector3d& direction) {
  Spectrum L = sky_radiance(sky, direction);
  if (sky.sun && direction.dot(sky.sun->direction) >= sky.sun->cosine_of_edge()) {
    L += sky.sun->irradiance / static_cast<float>(sky.sun->solid_angle());
  }
  return L;
}

Spectrum diffuse_horizontal_irradiance(const Sky& sky) {
  // E = int L cos dw = 1/2 int int L d(sin^2 Z) dphi, by the midpoint rule. The rule is exact in
  // phi for all kinds but maps and skies with a bright region about the sun.
  const int rings = sky.kind == SkyKind::map ? 512 : 1024;
  const int around = sky.kind == SkyKind::map ? 2048 : 256;
  const Eigen::Vector3d east = sky.north.cross(sky.up);
  const Eigen::Index bands = sky.scale.size();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(sky.kind == SkyKind::map ? bands : 1);
  for (int i = 0; i < rings; ++i) {
    const double sine2 = (i + 0.5) / rings, sine = std::sqrt(sine2),
                 cosine = std::sqrt(1.0 - sine2);
    for (int j = 0; j < around; ++j) {
      const double phi = 2.0 * pi * (j + 0.5) / around;
      const Eigen::Vector3d w =
          sine * (std::cos(phi) * sky.north + std::sin(phi) * east) + cosine * sky.up;
      if (sky.kind == SkyKind::map) {
        sum += sky_radiance(sky, w).cast<double>();
      } else {
        sum[0] += relative_radiance(sky, w);
      }
    }
  }
  sum *= pi / (static_cast<double>(rings) * around);
  if (sky.kind == SkyKind::map) return sum.cast<float>();
  return sky.scale * static_cast<float>(sum[0]);
}

Spectrum sun_horizontal_irradiance(const Sky& sky) {
  if (!sky.sun) return Spectrum::Zero(sky.scale.size());
  return sky.sun->irradiance * static_cast<float>(std::max(0.0, sky.sun->direction.dot(sky.up)));
}

Eigen::Vector3d sky_direction(const Sky& sky, double azimuth_degrees, double altitude_degrees) {
  const double azimuth = azimuth_degrees * degree, altitude = altitude_degrees * degree;
  const Eigen::Vector3d east = sky.north.cross(sky.up);
  return (std::cos(altitude) * (std::cos(azimuth) * sky.north + std::sin(azimuth) * east) +
          std::sin(altitude) * sky.up)
      .normalized();
}

void validate(const Sky& sky, const Bands& bands) {
  if (!is_unit(sky.up) || !is_unit(sky.north) || std::abs(sky.up.dot(sky.north)) > 1e-6) {
    refuse_sky("the sky's up and north must be unit vectors at right angles");
  }
  check_light(sky.scale, bands, "radiance");
  if (sky.kind == SkyKind::map) {
    if (!sky.map) refuse_sky("the sky is a map without a picture");
    if (!(sky.to_map * sky.to_map.transpose()).isIdentity(1e-6)) {
      refuse_sky("the sky's map must be placed by a rotation or mirroring");
    }
  } else {
    check_light(sky.ground, bands, "ground");
    if (!is_unit(sky.bright))
      refuse_sky("the direction of the sky's bright part must be a unit vector");
  }
  if (!sky.sun) return;
  check_light(sky.sun->irradiance, bands, "sun");
  if (!is_unit(sky.sun->direction)) refuse_sky("the direction to the sun must be a unit vector");
  if (!(sky.sun->angle_degrees > 0.0 && sky.sun->angle_degrees <= 10.0)) {
    refuse_sky(fmt::format("the sun is {} degrees across; give more than 0 and at most 10",
                           sky.sun->angle_degrees));
  }
}

std::uint64_t sky_hash(const Sky& sky) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a of words
  const auto add_word = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ull;
    hash ^= hash >> 32;
  };
  const auto add = [&](double x) { add_word(std::bit_cast<std::uint64_t>(x)); };
  const auto add_vector = [&](const Eigen::Vector3d& v) {
    for (const double x : v) add(x);
  };
  const auto add_light = [&](const Spectrum& s) {
    add_word(static_cast<std::uint64_t>(s.size()));
    for (const float x : s) add(static_cast<double>(x));
  };
  add_word(static_cast<std::uint64_t>(sky.kind));
  add_vector(sky.up);
  add_light(sky.scale);
  if (sky.kind == SkyKind::map) {
    add_word(sky.map ? sky.map->hash() : 0);
    for (const double x : sky.to_map.reshaped()) add(x);
  } else {
    add_light(sky.ground);
    add_vector(sky.bright);
    const SkyGradation& g = sky.gradation;
    for (const double x : {g.a, g.b, g.c, g.d, g.e}) add(x);
  }
  add_word(sky.sun.has_value());
  if (sky.sun) {
    add_vector(sky.sun->direction);
    add_light(sky.sun->irradiance);
    add(sky.sun->angle_degrees);
  }
  return hash;
}

}  // namespace lightwell
