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
