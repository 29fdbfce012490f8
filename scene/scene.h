#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/bands.h"
#include "scene/camera.h"
#include "scene/conductor.h"
#include "scene/lamp.h"
#include "scene/motion.h"
#include "scene/normal_map.h"
#include "scene/relief.h"
#include "scene/sky.h"
#include "scene/surface_pattern.h"
#include "scene/texture.h"

namespace lightwell {

/// Clear dielectric: glass, water. Reflection and refraction follow Fresnel's equations.
struct Dielectric {
  float index_of_refraction = 1.5f;  ///< index behind the front over index before
  Spectrum tint{};         ///< share of the refracted light that passes, [0,1] per crossing
  Spectrum absorption{};   ///< 1/m behind the front: exp(-absorption d) passes d metres (Beer and
                           ///< Lambert); empty: none
  float roughness = 0.0f;  ///< GGX alpha of the surface, [0,1]; 0 is smooth
  /// A pane without thickness stands for both of its faces, and light goes straight through. `tint`
  /// then applies once to the light that crosses the pane, and there is no absorption.
  bool thin = false;
  /// Share of light, [0,1], that crosses the body of a thin pane once along the normal. Inclined
  /// light crosses more of the body; empty: all.
  Spectrum transmissivity{};
};

/// Indices of refraction that validate() accepts: liquid over glass is 0.88, diamond 2.4, germanium
/// in the infrared 4.
inline constexpr float lowest_index = 0.1f, highest_index = 10.0f;

/// Highest absorption that validate() accepts, 1/m: light is gone within a micrometre.
inline constexpr float highest_absorption = 1e6f;

/// A clear coat over a diffuse base: lacquer, varnish, glaze, the skin of plastic (see coat.h).
struct Coat {
  float index_of_refraction = 1.5f;  ///< over that of the air before, in [lowest_coat_index,
                                     ///< highest_index]
  /// Share, [0,1], of the diffuse base that the coat covers.
  float cover = 1.0f;
  /// Share, per band, that bare metal beside the coat mirrors at all angles alike. Empty: none.
  Spectrum bare{};
};

/// Least index of a coat that validate() accepts. A coat of the air's own index mirrors nothing.
inline constexpr float lowest_coat_index = 1.0f;

/// A picture of diffuse reflectance: rho is `factor` times the picture's r, g and b.
struct ReflectanceTexture {
  SurfaceTexture image{};
  Spectrum factor{};  ///< [0,1]
};

/// A picture of emission: M is `factor` times the picture's r, g and b.
struct EmissionTexture {
  SurfaceTexture image{};
  Spectrum factor{};  ///< W/m^2, >= 0
};

/// A picture that cuts holes: light passes wherever the picture is below `cutoff`. All values from
/// `cutoff` up are equally opaque.
struct Mask {
  SurfaceTexture image{};  ///< only the first channel is used
  float cutoff = 0.5f;     ///< (0,1]
};

/// The unit in which a file states the power of all surfaces of a material together. `none`: the
/// file states the emission of each m^2.
enum class StatedPower { none, watts, lumens };

/// Reflection, transmission, refraction and emission of a surface. Energy: reflectance +
/// transmittance + the mean share that is mirrored or passes straight on is at most 1 in every
/// band.
struct Material {
  std::string name{};
  Spectrum reflectance{};  ///< diffuse rho, [0,1]; with a texture: of facets without UV
  /// Diffuse transmittance tau of a thin sheet, [0,1]: paper, cloth, opal glass. Light that arrives
  /// at one side leaves the other side evenly in all directions. Empty: none.
  Spectrum transmittance{};
  /// Regular transmittance of a thin sheet, [0,1]: light that passes straight on, such as through
  /// the holes of a fabric. Empty: none.
  Spectrum regular_transmittance{};
  Spectrum specular{};              ///< mirror reflectance, [0,1]
  float specular_roughness = 0.0f;  ///< GGX alpha of the mirror, [0,1]: spreads the reflected
                                    ///< light, whose share stays the same; 0: perfect mirror
  /// If set, the surface mirrors Fresnel's share of the coat times `specular`, by the angle of
  /// incidence. `reflectance` is that of base and coat together for even light, without the light
  /// that the coat mirrors.
  std::optional<Coat> coat{};
  /// The metal of the surface, which mirrors Fresnel's share times `specular` by the angle of
  /// incidence; empty: `specular` alone.
  std::optional<Conductor> metal{};
  std::optional<Dielectric> dielectric{};  ///< if set, the surface is clear; rho and specular are 0
  /// Exitance M = pi L of a Lambertian emitter, W/m^2, >= 0; with a picture of emission: of facets
  /// without UV.
  Spectrum emission{};
  bool one_sided = false;         ///< nothing is reflected from behind; the back is black
  bool emits_both_sides = false;  ///< emission leaves the back as well as the front
  /// Unless `none`, `emission` is a stated power over an area. What changes the area, as
  /// merge_planar_regions() may, scales the emission.
  StatedPower stated_power = StatedPower::none;
  /// Diffuse rho that varies over facets with UV; only in scenes of RGB bands.
  std::optional<ReflectanceTexture> texture{};
  /// Emission that varies over facets with UV; only in scenes of RGB bands.
  std::optional<EmissionTexture> emission_texture{};
  std::optional<Mask> mask{};  ///< holes in facets with UV; of materials that emit nothing
  /// Bends the normals of facets with UV in pictures. Solutions do not depend on relief.
  std::optional<Relief> relief{};
  /// Shares and roughness that vary over facets with UV; null: none (see material_at()).
  std::shared_ptr<const SurfacePattern> pattern{};

  /// True if a picture is laid over facets with UV.
  bool shows_picture() const { return texture || emission_texture || mask || relief || pattern; }
  /// True if a share of light is mirrored by a mirror, a metal or a coat.
  bool mirrors() const { return (specular > 0.0f).any() || (coat && (coat->bare > 0.0f).any()); }
  /// True if a coat alone mirrors, which is a small share of most light.
  bool mirrors_by_coat() const { return coat && !(coat->bare > 0.0f).any(); }
  /// True if light is mirrored, refracted or passes straight on, sharply or spread by roughness.
  bool is_specular() const { return dielectric.has_value() || mirrors() || passes_straight(); }
  /// True if light from one side leaves the other side diffusely.
  bool is_translucent() const { return (transmittance > 0.0f).any(); }
  /// True for a thin sheet that lets a share of the light pass straight on.
  bool passes_straight() const { return (regular_transmittance > 0.0f).any(); }
  /// True if light is scattered diffusely, to either side.
  bool is_diffuse() const { return (reflectance > 0.0f).any() || is_translucent(); }
  /// GGX alpha of the dielectric or the mirror; 0: smooth, or neither.
  float gloss_roughness() const {
    if (dielectric) return dielectric->roughness;
    return mirrors() ? specular_roughness : 0.0f;
  }
  bool is_emitter() const { return (emission > 0.0f).any(); }
};

/// A planar polygon, counter-clockwise seen from its front, with holes of the opposite winding.
/// Numbers index PolygonMesh::vertices.
struct Facet {
  std::vector<int> boundary{};
  std::vector<std::vector<int>> holes{};
  int uv_map = -1;      ///< index into PolygonMesh::uv_maps; -1: no texture coordinates
  int normal_map = -1;  ///< index into PolygonMesh::normal_maps; -1: normal of the plane
};

/// Polygons over shared vertices (metres). Facets are planar: readers split what is not.
struct PolygonMesh {
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<Facet> facets{};
  /// Maps are shared by facets over which u and v continue linearly, so that the facets can be
  /// joined.
  std::vector<UvMap> uv_maps{};
  /// Maps are shared by facets over which normals continue linearly. Empty: the file gives no
  /// normals, or the mesh is flat.
  std::vector<NormalMap> normal_maps{};
};

/// An exact sphere (metres); its front is the outside.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1.0;
};

/// The lateral surface of a truncated cone (metres), exact: a cylinder where both radii are the
/// same, a cone where one is 0, and where the height is 0 a ring, or a disc if one radius is 0. Its
/// front faces away from the axis, that of a disc or ring along the axis if the radius of the base
/// is the larger one; `inward` turns the front around.
struct Frustum {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< centre of the base
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, from the base to the top
  double height = 1.0;                              ///< >= 0
  double base_radius = 1.0, top_radius = 1.0;       ///< >= 0, one of them > 0
  bool inward = false;
};

using SurfaceShape = std::variant<PolygonMesh, Sphere, Frustum>;

/// One named object of the input.
struct Surface {
  std::string name{};
  int material = 0;  ///< index into Scene::materials
  SurfaceShape shape{};
  int motion = -1;  ///< index into Scene::motions; -1: the surface stands still
};

/// A room and its contents as plain data, in metres and watts.
struct Scene {
  std::filesystem::path file{};  ///< source of the scene, for messages
  /// All files that read_scene() read: also materials, pictures, luminaires and included scenes.
  std::vector<std::filesystem::path> files{};
  std::string title{};
  double metres_per_unit = 1.0;  ///< the file's length unit; coordinates here are already metres
  std::string unit_name = "m";   ///< the file's name of the unit
  Bands bands = rgb_bands();
  std::vector<Material> materials{};
  std::vector<Surface> surfaces{};
  std::vector<Camera> cameras{};
  std::vector<Lamp> lamps{};
  std::optional<Sky> sky{};  ///< light from outside the scene; empty: black
  /// Motions of surfaces and cameras. Coordinates are those at RigidMotion::rest_time, which all
  /// motions share: the instant for which light is solved.
  std::vector<RigidMotion> motions{};
  /// Assumptions, repairs and omissions of the reader, one sentence each.
  std::vector<std::string> notes{};
  /// Things that the reader left out, approximated or did not find, one sentence for each kind with
  /// all names; `notes` has each of them with a few names. Empty: nothing of the file is lost.
  std::vector<std::string> losses{};
  int dropped_polygons = 0;  ///< polygons left out for having no area
  /// True if the unit of emission is unknown: values of light are then meaningful only relative to
  /// each other.
  bool relative_units = false;
};

/// Position of a facet in the scene. Facets are numbered through all surfaces in order; a sphere or
/// frustum is one facet.
struct FacetRef {
  int surface = 0;
  int facet = 0;  ///< within the surface's PolygonMesh; 0 for a round shape
};

/// Every facet of the scene; the index into the result is the facet's scene-wide number.
std::vector<FacetRef> scene_facets(const Scene& scene);

/// Unit normal by Newell's method, towards the front. Zero if the polygon has no area.
Eigen::Vector3d facet_normal(const PolygonMesh& mesh, const Facet& facet);

/// Area in m^2, holes taken out.
double facet_area(const PolygonMesh& mesh, const Facet& facet);

/// Area of a surface's polygons or round shape, m^2, one side.
double surface_area(const Surface& surface);

/// Number of free sources, the sources of light that are no surface. Their order: the lamps, the
/// dome of the sky and the sun, the last two only if present.
int free_source_count(const Scene& scene);
/// Name of a free source in messages and channels: the name of the lamp, "sky" or "sun".
std::string free_source_name(const Scene& scene, int number);

/// True if a surface, a lamp or the sky gives light.
bool gives_light(const Scene& scene);

/// Axis-aligned box, metres.
struct Bounds {
  Eigen::Vector3d low, high;
  double diagonal() const { return (high - low).norm(); }
};

/// Bounds of all surfaces. Throws std::invalid_argument for a scene without surfaces.
Bounds scene_bounds(const Scene& scene);

/// Checks what every later stage relies on: finite coordinates, indices in range, facets with area,
/// round shapes with area, bands of equal count, reflectances in [0,1] that do not create energy,
/// lamps whose axes are a rotation and whose intensity is a finite number >= 0, sound motions, a
/// sound sky. Throws InputError naming surface, material, value and remedy.
void validate(const Scene& scene);

/// 64-bit hash of everything of a material that decides the light, not its name or relief.
std::uint64_t material_hash(const Material& material);

/// 64-bit hash of everything that decides the light: geometry, materials, lamps, sky and bands, not
/// cameras, relief, names or notes. Solutions store the hash, so that a solution of another scene
/// is refused.
std::uint64_t scene_hash(const Scene& scene);

}  // namespace lightwell
