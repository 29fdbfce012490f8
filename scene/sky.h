#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "scene/bands.h"
#include "scene/environment_map.h"

namespace lightwell {

/// The sun: a disc of uniform radiance at infinite distance.
struct Sun {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  ///< unit, towards the middle of the disc
  Spectrum irradiance{};         ///< on a surface that faces the sun, W/m^2, >= 0
  double angle_degrees = 0.533;  ///< across the disc, (0, 10]; 0.533 seen from the earth's mean
                                 ///< distance

  double cosine_of_edge() const;  ///< cosine of the angle between edge and middle
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

/// One of the 15 standard skies of ISO 15469: 1 is the standard overcast sky, 5 the uniform sky, 12
/// the standard clear sky. Throws std::invalid_argument for other numbers.
SkyGradation standard_sky(int number);

/// Distribution of radiance over the dome.
enum class SkyKind : std::uint8_t {
  gradation,  ///< SkyGradation, of which the uniform sky is one
  overcast,   ///< (1 + 2 cos Z) / 3 of the zenith's radiance (Moon & Spencer 1942)
  map         ///< a picture, which covers directions below the horizon too
};

/// Light from outside the scene: a sky dome, the ground below the horizon and the sun, all at
/// infinite distance.
struct Sky {
  std::string name{};                                 ///< shown to people: "CIE overcast"
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();      ///< unit, towards the zenith
  Eigen::Vector3d north = -Eigen::Vector3d::UnitZ();  ///< unit, perpendicular to up
  SkyKind kind = SkyKind::gradation;
  SkyGradation gradation{};
  /// Unit direction to the bright part of the dome, where `gradation` has one.
  Eigen::Vector3d bright = Eigen::Vector3d::UnitY();
  /// Radiance per band where phi f, or the overcast distribution, is 1, W/(m^2 sr); for a map, a
  /// factor of the picture.
  Spectrum scale{};
  Spectrum ground{};  ///< radiance from below the horizon, W/(m^2 sr); unused with a map
  std::shared_ptr<const EnvironmentMap> map{};  ///< shared by copies; set if kind is map
  /// Rotation or mirroring from directions of the scene to directions of the map.
  Eigen::Matrix3d to_map = Eigen::Matrix3d::Identity();
  std::optional<Sun> sun{};
};

/// A sky without light.
Sky dark_sky(const Bands& bands);

/// True if anything but the sun gives light.
bool has_dome(const Sky& sky);

/// Radiance from a unit direction, W/(m^2 sr) per band, without the sun.
Spectrum sky_radiance(const Sky& sky, const Eigen::Vector3d& direction);

/// Radiance from a unit direction, W/(m^2 sr) per band, with the sun's disc.
Spectrum radiance_outside(const Sky& sky, const Eigen::Vector3d& direction);

/// Irradiance of an unobstructed horizontal surface that faces up, from the dome alone, W/m^2 per
/// band: the integral of L cos over the upper hemisphere. Relative error about 1e-5; the integral
/// of a map has 512 x 2048 directions.
Spectrum diffuse_horizontal_irradiance(const Sky& sky);

/// Irradiance of an unobstructed horizontal surface that faces up, from the sun alone, W/m^2 per
/// band; 0 if the sun is below the horizon.
Spectrum sun_horizontal_irradiance(const Sky& sky);

/// Unit direction from azimuth, clockwise from north as seen from above, and altitude above the
/// horizon.
Eigen::Vector3d sky_direction(const Sky& sky, double azimuth_degrees, double altitude_degrees);

/// Checks unit directions, numbers of bands and ranges. Throws std::invalid_argument with a
/// sentence that names the value.
void validate(const Sky& sky, const Bands& bands);

/// 64-bit hash, equal for skies that send the same light.
std::uint64_t sky_hash(const Sky& sky);

}  // namespace lightwell
