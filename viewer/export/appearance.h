#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/solve.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/pictures/image.h"
#include "raytrace/shading/shown_radiance.h"
#include "scene/sky.h"
#include "viewer/export/false_color.h"

namespace lightwell {

/// Classes of elements that are drawn differently.
enum class ElementKind : std::uint8_t {
  lit,    ///< irradiance at a corner, or emission
  unlit,  ///< neither, for example on the outside of a closed room
  glass,  ///< clear material, drawn as a translucent veil
};

/// Opacity of glass as drawn, [0,1].
inline constexpr double glass_opacity = 0.2;

/// Kind of each element. An element is glass only by `materials`: an empty list has no glass.
std::vector<ElementKind> element_kinds(const SolvedScene& solved,
                                       const std::vector<Material>& materials);

/// Kind of each element for irradiance E at the vertices (vertices x bands), for example a part of
/// a solution's.
std::vector<ElementKind> element_kinds(const PatchMesh& mesh, const BandArray& E,
                                       const std::vector<Material>& materials);

/// First corner of the diagonal that splits a quad, 0 or 1; 0 for a triangle. The chosen diagonal's
/// ends differ less in radiance, so that the crease follows the light.
int first_corner(const PatchMesh& mesh, int element, const BandArray& radiance);

/// Tone-mapped colours, 8-bit sRGB, 3 bytes a vertex: the second pass's automatic tone mapping with
/// `scale` as the exposure (see exposure_scale), or as exposure times white balance, for each of
/// linear red, green and blue.
std::vector<std::uint8_t> display_colors(const BandArray& radiance, const Bands& bands,
                                         const Eigen::Array3f& scale);
std::vector<std::uint8_t> display_colors(const BandArray& radiance, const Bands& bands,
                                         double scale);

/// Logarithmic 8-bit code of light before tone mapping, which graphics hardware interpolates
/// between vertices. Code c in [0,1] is x = 2^(light_code_stops c - light_code_depth) -
/// 2^-light_code_depth of white, at most 64 times white. A step of 1/255 is a factor of 1.039, so
/// that x is accurate to 2 %.
inline constexpr float light_code_stops = 14.0f, light_code_depth = 8.0f;

/// Light codes (see light_code_stops) of linear RGB times `scale`, 3 bytes a vertex.
std::vector<std::uint8_t> light_codes(const BandArray& radiance, const Bands& bands,
                                      const Eigen::Array3f& scale);

/// luminous() of each row of `values` (rows x bands): radiance in W/(m^2 sr) gives cd/m^2,
/// irradiance in W/m^2 gives lx.
std::vector<float> luminous_rows(const BandArray& values, const Bands& bands);

/// Illuminance at each vertex, lx.
std::vector<float> vertex_illuminance(const RadiositySolution& solution);

/// False colours of the interpolation error at each vertex, 8-bit sRGB, 3 bytes a vertex. A
/// vertex's error is the largest of its elements'. The scale is logarithmic, from 0.1 % to 10 % of
/// the mean irradiance.
std::vector<std::uint8_t> error_colors(const SolvedScene& solved);

/// Coarse picture, `width` pixels wide, of what the viewer draws for a camera. Rays pass through
/// backs and glass; rays that leave the scene show the sky, or black without a sky. The picture's
/// exposure_scale approximates that of the second pass's picture; mirrors and glass differ.
Image coarse_picture(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const BandArray& radiance, const Camera& camera, int width,
                     const Sky* sky = nullptr);

/// Light at vertices, vertices x bands: irradiance, W/m^2, and what shown_radiance() returns.
struct ShownLight {
  const BandArray& irradiance;
  const BandArray& radiance;
};

/// The exposure of a camera's picture, and the light on what the camera sees; empty: there is none.
struct Metered {
  double scale = 1.0;
  std::optional<IncidentLight> incident{};
};

/// The exposure of the second pass's picture from a camera: IncidentLight::exposure. Where no light
/// falls on what the camera sees, the exposure_scale of a coarse picture; where the coarse picture
/// is black, that of all vertices alike.
Metered meter_view(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                   const ShownLight& light, const Bands& bands, const Camera& camera,
                   const Sky* sky = nullptr);
/// The exposure of meter_view().
double metered_scale(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const ShownLight& light, const Bands& bands, const Camera& camera,
                     const Sky* sky = nullptr);

}  // namespace lightwell
