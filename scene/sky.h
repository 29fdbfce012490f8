#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "scene/bands.h"
#include "scene/environment_map.h"

namespace lightwell {

/// The sun: a disc of even radiance, so far away that its light comes from the same directions
/// everywhere.
struct Sun {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  ///< unit, towards its middle
  Spectrum irradiance{};         ///< on a surface that faces it, W/m^2, >= 0
  double angle_degrees = 0.533;  ///< across the disc, (0, 10]; 0.533 seen from the earth's mean
                                 ///< distance

  double cosine_of_edge() const;  ///< of the angle from the middle
  double solid_angle() const;     ///< sr
};

/// Relative luminance of a standard sky, L ~ phi(Z) f(chi), by the angle Z from the zenith and the
/// angle chi from the sun (Kittler, Perez & Darula 1998; CIE S 011 = ISO 15469:2004):
///
///     phi(Z) = 1 + a exp(b / cos Z),   f(chi) = 1 + c (exp(d chi) - exp(d pi/2)) + e cos^2 chi
struct SkyGradation {
  double a = 0.0, b = -1.0;           ///< a = 0: even from zenith to horizon
  double c = 0.0, d = -1.0, e = 0.0;  ///< c = e = 0: the same all around
};

/// One of the 15 standard skies of ISO 15469; 1 is the standard overcast sky, 5 the uniform, 12 the
/// standard clear one. Throws std::invalid_argument for other numbers.
SkyGradation standard_sky(int number);

/// The all-weather sky (Perez, Seals & Michalsky 1993) for `direct_normal` and
/// `diffuse_horizontal` irradiance, W/m^2, with the sun at an altitude above the horizon, on a day
/// of the year from 1. Throws std::invalid_argument for a diffuse irradiance that is not above 0, a
/// direct one below 0 or a sun that is not up.
SkyGradation perez_sky(double direct_normal, double diffuse_horizontal, double sun_altitude_degrees,
                       int day_of_year);

/// How radiance goes over the dome.
enum class SkyKind : std::uint8_t {
  gradation,  ///< SkyGradation; uniform as well
  overcast,   ///< (1 + 2 cos Z) / 3 of the zenith's (Moon & Spencer 1942)
  map         ///< a picture, of what is below the horizon too
};

/// What lies around the scene and sends light into it: a sky dome, the ground below the horizon,
/// and the sun. Everything is infinitely far away.
struct Sky {
  std::string name{};                                 ///< for people: "CIE overcast"
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();      ///< unit, towards the zenith
  Eigen::Vector3d north = -Eigen::Vector3d::UnitZ();  ///< unit, perpendicular to up
  SkyKind kind = SkyKind::gradation;
  SkyGradation gradation{};
  /// Of the bright part of the dome, where `gradation` has any; unit.
  Eigen::Vector3d bright = Eigen::Vector3d::UnitY();
  /// Radiance where phi f (or the overcast sky) is 1, W/(m^2 sr) per band; of a map a factor.
  Spectrum scale{};
  Spectrum ground{};  ///< radiance of what is below the horizon, W/(m^2 sr); not of a map
  std::shared_ptr<const EnvironmentMap> map{};  ///< shared by copies; only where kind says so
  /// From directions of the scene to those of the map.
  Eigen::Matrix3d to_map = Eigen::Matrix3d::Identity();
  std::optional<Sun> sun{};
};

/// Whether anything but the sun gives light.
bool has_dome(const Sky& sky);

/// Radiance from a unit direction without the sun, W/(m^2 sr) per band.
Spectrum sky_radiance(const Sky& sky, const Eigen::Vector3d& direction);

/// The same with the sun's disc.
Spectrum radiance_outside(const Sky& sky, const Eigen::Vector3d& direction);

/// Irradiance of an unobstructed horizontal surface that faces up, from the dome alone, W/m^2 per
/// band: the integral of L cos over the upper hemisphere, to about 1e-5 of it (of a map: of its
/// pixels).
Spectrum diffuse_horizontal_irradiance(const Sky& sky);

/// The same from the sun alone; 0 below the horizon.
Spectrum sun_horizontal_irradiance(const Sky& sky);

/// Direction by azimuth, clockwise from north as seen from above, and altitude above the horizon.
Eigen::Vector3d sky_direction(const Sky& sky, double azimuth_degrees, double altitude_degrees);

/// Checks what all that use it rely on: unit directions, bands, ranges. Throws
/// std::invalid_argument with a sentence that names the value.
void validate(const Sky& sky, const Bands& bands);

/// Equal for skies that send the same light.
std::uint64_t sky_hash(const Sky& sky);

}  // namespace lightwell
