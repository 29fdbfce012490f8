#pragma once

#include <optional>
#include <span>

#include "mesh/elements/element_caster.h"
#include "raytrace/image.h"

namespace lightwell {

/// Geometric mean of the luminances of a picture, W/(m^2 sr) as BT.709's Y, within a factor 10 of
/// the median: lamps and windows above and black corners below do not count. Empty: the picture is
/// black.
std::optional<double> typical_luminance(const Image& image, const Bands& bands);

/// The picture, `width` pixels wide, of a scene in which every surface that a camera sees is white
/// paper, of reflectance 1, under the light that falls there: radiance E / pi. `irradiance` is
/// vertices x bands, W/m^2. Rays pass through elements that are `clear` (1 for each clear element;
/// empty: none is), through black backs, and through what gets no light, as the outside of a closed
/// room; where nothing else is met, the picture is black.
Image white_paper_picture(const ElementCaster& caster, const BandArray& irradiance,
                          std::span<const char> clear, const Camera& camera, int width);

/// The typical light that falls on what a camera sees.
struct IncidentLight {
  double exposure = 1.0;                           ///< see incident_exposure()
  Eigen::Array3f colour = Eigen::Array3f::Ones();  ///< linear RGB of white paper, luminance 1
};

/// Meters the light at the points that a camera sees: means over the points within a factor 10 of
/// the median illuminance. Empty: no light falls on what the camera sees.
std::optional<IncidentLight> meter_incident_light(const ElementCaster& caster,
                                                  const BandArray& irradiance,
                                                  std::span<const char> clear, const Bands& bands,
                                                  const Camera& camera);

/// Exposure for incident light, as of a photographer's incident meter (ISO 2720): the multiplier of
/// radiance for which white paper, of reflectance 1, under the mean light of a view shows as 1.
/// A room has its tone then, whatever its colours: white rooms show white, dark ones dark. Empty:
/// no light falls on what the camera sees.
std::optional<double> incident_exposure(const ElementCaster& caster, const BandArray& irradiance,
                                        std::span<const char> clear, const Bands& bands,
                                        const Camera& camera);

/// The colour of a black body, linear RGB of luminance 1. `kelvin` is from coldest_white to
/// hottest_white; a colder body has a colour outside of Rec. 709's primaries.
Eigen::Array3f colour_of_black_body(double kelvin);
inline constexpr double coldest_white = 2000.0, hottest_white = 40000.0;

/// White balance: factors of linear RGB that show white paper under light of `colour` (luminance 1)
/// as grey of the same luminance (von Kries' rule on the primaries). A factor is at most 16,
/// so that light with next to no blue leaves a picture.
Eigen::Array3f white_balance(const Eigen::Array3f& colour);

}  // namespace lightwell
