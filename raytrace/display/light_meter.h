#pragma once

#include <optional>
#include <span>

#include "mesh/elements/element_caster.h"
#include "raytrace/pictures/image.h"
#include "scene/sky.h"

namespace lightwell {

/// Geometric mean of the luminances of a picture, W/(m^2 sr) as BT.709's Y, within a factor 10 of
/// the median: lamps and windows above and black corners below do not count. Empty: the picture is
/// black.
std::optional<double> typical_luminance(const Image& image, const Bands& bands);

/// Width of the pictures that exposures are metered on, pixels.
inline constexpr int metering_width = 160;

/// A coarse picture, `width` pixels wide: `radiance` (vertices x bands) interpolated where the ray
/// of each pixel ends. Rays pass elements that are `passed` (1 for each such element; empty: none)
/// and black backs; rays that leave the scene show the sky, or black without a sky.
Image coarse_picture(const ElementCaster& caster, std::span<const char> passed,
                     const BandArray& radiance, const Camera& camera, int width,
                     const Sky* sky = nullptr);

/// The light that falls on what a camera sees.
struct IncidentLight {
  /// Exposure for incident light, as of a photographer's incident meter (ISO 2720): the multiplier
  /// of radiance, pi / E, for which white paper, of reflectance 1, under the mean irradiance E
  /// shows as 1. A room has its tone then, whatever its colours are.
  double exposure = 1.0;
  Eigen::Array3f colour = Eigen::Array3f::Ones();  ///< linear RGB of luminance 1
};

/// Means of `irradiance` (vertices x bands, W/m^2) over the points that a camera sees, within a
/// factor 10 of the median illuminance. Rays pass elements that are `clear` (1 for each; empty:
/// none), and those without light, as the outside of a closed room. Empty: no light falls on what
/// the camera sees.
std::optional<IncidentLight> meter_incident_light(const ElementCaster& caster,
                                                  const BandArray& irradiance,
                                                  std::span<const char> clear, const Bands& bands,
                                                  const Camera& camera);

/// The colour of a black body, linear RGB of luminance 1. `kelvin` is from coldest_white to
/// hottest_white; a colder body has a colour outside of Rec. 709's primaries.
Eigen::Array3f colour_of_black_body(double kelvin);
inline constexpr double coldest_white = 2000.0, hottest_white = 40000.0;

/// White balance: factors of linear RGB that show white paper under light of `colour` (luminance 1)
/// as grey of the same luminance (von Kries' rule on the primaries). A factor is at most 64; blue
/// under a black body of coldest_white takes 49. Light with less blue leaves a picture.
Eigen::Array3f white_balance(const Eigen::Array3f& colour);

/// The light that pictures show as grey.
struct WhitePoint {
  enum class Kind {
    as_lit,      ///< the white of the screen
    automatic,   ///< the light on what the camera sees
    black_body,  ///< of `kelvin`
  };
  Kind kind = Kind::as_lit;
  double kelvin = 6500.0;

  bool operator==(const WhitePoint&) const = default;
};

/// Factors of linear RGB for a white point. `incident` is the light on what the camera sees; where
/// it is not known, `automatic` is as lit.
Eigen::Array3f white_balance(const WhitePoint& white, const std::optional<IncidentLight>& incident);

}  // namespace lightwell
