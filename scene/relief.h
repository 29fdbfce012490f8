#pragma once

#include <Eigen/Core>

#include "scene/texture.h"

namespace lightwell {

/// Small shapes of a surface that is flat otherwise: joints of tiles, threads, strokes of a brush.
/// A picture gives their slopes. Relief bends the normal by which pictures shade; places, outlines
/// and the first pass are those of the facets.
struct Relief {
  /// Slopes to the right (r) and downwards (g) of the picture as 0.5 + slope / (2 steepest), so
  /// that a coarser level of the mip map holds the slopes of the smoothed relief.
  SurfaceTexture slopes{};
  double steepest = 1.0;
  double scale = 1.0;  ///< factor of the slopes
  /// The slopes are those of heights in metres by texel, so they depend on the size of the picture
  /// on the surface. Other slopes are rise over run.
  bool is_in_metres = false;
};

/// Steepest slope of a relief, rise over run: 76 degrees. Pictures of normals in 8 bits know
/// steeper slopes to 3 % at best.
inline constexpr double steepest_relief = 4.0;

/// Limits of Relief::scale that validate() accepts, either sign.
inline constexpr double most_relief_scale = 100.0, most_relief_depth = 1e4;

/// Relief of a picture of normals: r, g and b are the normal's part to the right, upwards and out
/// of the picture, from -1 to 1; 127 and 128 of 255 are 0. `scale` multiplies the first two. Throws
/// InputError, "is ...; ...", for a picture that has no normals.
Relief relief_of_normals(const SurfaceTexture& image, double scale);

/// Unit of the depth of a picture of heights: metres, or widths of a texel.
enum class DepthUnit { metre, texel };
/// Relief of a picture of heights, the mean of r, g and b. White lies `depth` above black.
Relief relief_of_heights(const SurfaceTexture& image, double depth, DepthUnit unit);

/// True if a picture is one of normals rather than one of heights: not grey, and blue on the whole.
bool shows_normals(const Texture& picture);

/// Slope of a relief at a point of a surface.
///
/// Light from the direction w counts times
///
///     g(w) = 1 - (w . rise) / (w . normal), from 0 to 2,
///
/// the irradiance of the slope over that of the surface, per area of the surface. Without the limit
/// 2, slopes towards grazing light would gain more than slopes away from the light can lose, which
/// get none at least. With it, g of a slope and g of the opposite slope add up to 2 for every w. So
/// relief with as much of either kind is as bright in the mean as the flat surface, and even light
/// gives every slope the same.
struct ReliefSlope {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, without relief, on the lit side
  Eigen::Vector3d rise = Eigen::Vector3d::Zero();     ///< gradient of the height, across `normal`

  /// g of light from `direction`, of any length.
  double gain(const Eigen::Vector3d& direction) const;
  /// Unit normal of the relief.
  Eigen::Vector3d bent() const { return (normal - rise).normalized(); }
};

}  // namespace lightwell
