#pragma once

#include <cstdint>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/solve.h"
#include "raytrace/image.h"
#include "scene/sky.h"

namespace lightwell {

/// Shares of a mesh that are drawn differently.
enum class ElementKind : std::uint8_t {
  lit,    ///< shows light
  unlit,  ///< no light at any corner: the outside of a closed room, for one
  glass,  ///< clear: drawn as a veil over what is behind
};

/// Share of what is behind that glass hides.
inline constexpr double glass_opacity = 0.2;

/// What each element is. Without materials nothing is glass.
std::vector<ElementKind> element_kinds(const SolvedScene& solved,
                                       const std::vector<Material>& materials);

/// The same by the light at vertices, E (vertices x bands), where it is not all of the solution's.
std::vector<ElementKind> element_kinds(const PatchMesh& mesh, const BandArray& E,
                                       const std::vector<Material>& materials);

/// Radiance that stands for each vertex, W/(m^2 sr), vertices x bands: B / pi; mirrors and glass
/// add what they would send out if they scattered the mirrored or the refracted light evenly.
BandArray shown_radiance(const SolvedScene& solved, const std::vector<Material>& materials);

/// Share of irradiance that shown_radiance sends out from a patch, per band.
Spectrum shown_reflectance(const PatchMesh& mesh, const std::vector<Material>& materials,
                           int patch);

/// The corner of a quad from which the diagonal goes along which to split it: the one whose ends
/// differ less, so that the crease follows the light. 0 or 1; 0 for a triangle.
int first_corner(const PatchMesh& mesh, int element, const BandArray& radiance);

/// 8-bit sRGB, 3 bytes a vertex: the second pass's automatic tone mapping with `scale` as the
/// exposure (see exposure_scale).
std::vector<std::uint8_t> display_colors(const BandArray& radiance, const Bands& bands,
                                         double scale);

/// Light before tone mapping as graphics hardware blends it between vertices: code c of 255 stands
/// for x = 2^(light_code_stops c - light_code_depth) - 2^-light_code_depth of white, which takes in
/// 64 times white; each step is a factor of 1.039, so that x is right to 2 %.
inline constexpr float light_code_stops = 14.0f, light_code_depth = 8.0f;

/// 3 bytes a vertex: linear RGB times `scale` as such codes.
std::vector<std::uint8_t> light_codes(const BandArray& radiance, const Bands& bands, double scale);

/// What false colours show.
enum class Measure {
  illuminance,  ///< lx
  luminance,    ///< cd/m^2, of what is drawn
  unshot,       ///< lm/m^2 that patches are still to shoot, while light is being solved for
};

/// Of a false-colour scale, lx (or what else is measured), low < high: logarithmic, or even where
/// `low` is 0.
struct LuxRange {
  double low = 1.0, high = 1000.0;

  bool is_even() const { return low == 0.0; }
};

/// A logarithmic one with 1, 2 or 5 times a power of ten at either end, that takes in all but the
/// brightest 0.5 % of the vertices and reaches at most a thousandth down.
LuxRange lux_range(const std::vector<float>& lux);

/// Where a scale is labelled: about five even steps, or 1, 2 and 5 times the powers of ten; the
/// powers alone and the ends over more than two decades. lx.
std::vector<double> scale_steps(const LuxRange& range);

/// luminous() of each row, cd/m^2 of radiance.
std::vector<float> luminous_rows(const BandArray& values, const Bands& bands);

/// Illuminance at each vertex, lx.
std::vector<float> vertex_illuminance(const RadiositySolution& solution);

/// False colour for a place on the scale, [0,1]: dark blue by green to yellow, rising in lightness
/// so that it reads the same in grey and for colour-blind eyes. sRGB, [0,1].
Eigen::Array3f false_color(float place);

/// 8-bit sRGB, 3 bytes a vertex.
std::vector<std::uint8_t> false_colors(const std::vector<float>& lux, const LuxRange& range);

/// The interpolation error around each vertex, the largest of its elements, on a logarithmic scale
/// from 0.1 % of the mean irradiance to 10 %. 8-bit sRGB, 3 bytes a vertex.
std::vector<std::uint8_t> error_colors(const SolvedScene& solved);

/// A coarse picture, `width` pixels wide, of what the viewer draws for a camera: backs and glass
/// are looked through, a miss shows the sky, or is black without. Its exposure_scale is what the
/// second pass's picture from there has, up to mirrors and glass.
Image coarse_picture(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const BandArray& radiance, const Camera& camera, int width,
                     const Sky* sky = nullptr);

/// The exposure_scale of the second pass's picture from a camera, by a coarse picture; where
/// nothing is to be seen from there, that of all vertices alike.
double metered_scale(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const BandArray& radiance, const Bands& bands, const Camera& camera,
                     const Sky* sky = nullptr);

}  // namespace lightwell
