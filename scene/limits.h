#pragma once

namespace lightwell {

/// Largest magnitude of a coordinate or a radius, m. Products of the ray caster's floats overflow
/// only far above this bound.
inline constexpr double farthest_coordinate = 1e9;

/// Most pixels along one edge of a picture.
inline constexpr int max_picture_edge = 32768;

/// Two directions count as parallel up to this sine of the angle between them: the direction across
/// both would be rounding.
inline constexpr double parallel_sine = 1e-6;

}  // namespace lightwell
