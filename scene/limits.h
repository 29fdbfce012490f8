#pragma once

namespace lightwell {

/// Largest magnitude of a coordinate or a radius, m. Products of the ray caster's floats overflow
/// only far above this bound.
inline constexpr double farthest_coordinate = 1e9;

/// Bounds of exitance (W/m^2), intensity (W/sr) and radiance (W/(sr m^2)) in the brightest band.
/// The sun's surface has 6e7 W/m^2, the ground by moonlight 1e-3. Sums over areas of 1e18 m^2, and
/// shares of sums, stay within the floats that hold light.
inline constexpr float most_light = 1e15f, least_light = 1e-20f;

/// Most pixels along one edge of a picture.
inline constexpr int max_picture_edge = 32768;

/// Two directions count as parallel up to this sine of the angle between them: the direction across
/// both would be rounding.
inline constexpr double parallel_sine = 1e-6;

}  // namespace lightwell
