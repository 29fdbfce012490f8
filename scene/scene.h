#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/bands.h"
#include "scene/lamp.h"
#include "scene/motion.h"
#include "scene/normal_map.h"
#include "scene/sky.h"
#include "scene/texture.h"

namespace lightwell {

/// Clear dielectric: glass, water. Reflection and refraction follow Fresnel's equations.
struct Dielectric {
  float index_of_refraction = 1.5f;  ///< behind its front over before it
  Spectrum tint{};         ///< share of the refracted light that passes, [0,1] per crossing
  Spectrum absorption{};   ///< 1/m behind the front: exp(-absorption d) passes d metres (Beer and
                           ///< Lambert); empty: none
  float roughness = 0.0f;  ///< GGX alpha of the surface, [0,1]; 0 is smooth
  /// A pane without thickness: both its faces at once, light goes straight through. `tint` is then
  /// the share of what passes the pane, and there is no absorption.
  bool thin = false;
};

/// Indices of refraction that validate() accepts: liquid over glass is 0.88, diamond 2.4, germanium
/// in the infrared 4.
inline constexpr float lowest_index = 0.1f, highest_index = 10.0f;

/// 1/m; light is then gone within a micrometre.
inline constexpr float highest_absorption = 1e6f;

/// A picture of what a surface reflects: rho is `factor` times the picture's r, g and b.
struct ReflectanceTexture {
  SurfaceTexture image{};
  Spectrum factor{};  ///< [0,1]
};

/// A picture of where a surface is: places where it is below `cutoff` are holes, through which
/// light goes on. How much of the rest is covered makes no difference.
struct Mask {
  SurfaceTexture image{};  ///< its first channel counts
  float cutoff = 0.5f;     ///< (0,1]
};

/// How a surface gives light back. Energy: reflectance + specular <= 1 in every band.
struct Material {
  std::string name{};
  Spectrum reflectance{};           ///< diffuse rho, [0,1]; with a texture, where a facet lacks UV
  Spectrum specular{};              ///< mirror reflectance, [0,1]
  float specular_roughness = 0.0f;  ///< GGX alpha of the mirror, [0,1]: spreads what it reflects,
                                    ///< and leaves the share as it is; 0 is a perfect mirror
  std::optional<Dielectric> dielectric{};  ///< if set, the surface is clear; rho and specular are 0
  Spectrum emission{};            ///< exitance M = pi L of a Lambertian emitter, W/m^2, >= 0
  bool one_sided = false;         ///< nothing is reflected from behind; the back is black
  bool emits_both_sides = false;  ///< emission leaves the back as well as the front
  /// Diffuse rho that varies over facets with UV. Scenes of RGB bands alone have such.
  std::optional<ReflectanceTexture> texture{};
  std::optional<Mask> mask{};  ///< holes in facets with UV; of materials that emit nothing

  /// Light continues through or off it, undiffused or spread by its roughness.
  bool is_specular() const { return dielectric.has_value() || (specular > 0.0f).any(); }
  /// The roughness of what light continues through or off, GGX alpha; 0: none, or smooth.
  float gloss_roughness() const {
    if (dielectric) return dielectric->roughness;
    return (specular > 0.0f).any() ? specular_roughness : 0.0f;
  }
  bool is_emitter() const { return (emission > 0.0f).any(); }
};

/// A planar polygon, counter-clockwise seen from its front, with holes of the opposite winding.
/// Numbers index PolygonMesh::vertices.
struct Facet {
  std::vector<int> boundary{};
  std::vector<std::vector<int>> holes{};
  int uv_map = -1;      ///< index into PolygonMesh::uv_maps; -1: it has no texture coordinates
  int normal_map = -1;  ///< index into PolygonMesh::normal_maps; -1: its normals are its plane's
};

/// Polygons over shared vertices (metres). Facets are planar: readers split what is not.
struct PolygonMesh {
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<Facet> facets{};
  /// Shared by facets over which u and v go on alike, so that those can become one.
  std::vector<UvMap> uv_maps{};
  /// Shared by facets over which normals go on alike. Empty: the file gives none, or is flat.
  std::vector<NormalMap> normal_maps{};
};

/// An exact sphere (metres); its front is the outside.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1.0;
};

/// One named object of the input.
struct Surface {
  std::string name{};
  int material = 0;  ///< index into Scene::materials
  std::variant<PolygonMesh, Sphere> shape{};
  int motion = -1;  ///< index into Scene::motions; -1: it stands still
};

/// Pinhole camera, or one with a thin lens. The picture's x axis is direction x up, so with
/// direction +z and up +y world +x is on the left; row 0 is the top.
struct Camera {
  std::string name{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit length
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< unit length, perpendicular to direction
  double fov_degrees = 40.0;                      ///< full horizontal angle, (0, 180)
  int width = 512, height = 512;                  ///< pixels
  double lens_radius = 0.0;     ///< m; 0 is a pinhole, in whose picture all is sharp
  double focus_distance = 1.0;  ///< m along `direction` to the plane that is sharp, > 0
  int blades = 0;               ///< of the aperture, 3 to max_blades; 0: it is round
  /// s; a picture is the mean of what is seen while the shutter is open. Equal: at an instant.
  double shutter_open = 0.0, shutter_close = 0.0;
  int motion = -1;  ///< index into Scene::motions; -1: it stands still

  bool is_open_for_a_while() const { return shutter_close > shutter_open; }
  double shutter_middle() const { return 0.5 * (shutter_open + shutter_close); }
};

inline constexpr int max_blades = 64;

/// A room and what is in it, as plain data: metres and watts.
struct Scene {
  std::filesystem::path file{};  ///< where it was read from, for messages
  std::string title{};
  double metres_per_unit = 1.0;  ///< the file's length unit; coordinates here are already metres
  std::string unit_name = "m";   ///< the file's word for it
  Bands bands = rgb_bands();
  std::vector<Material> materials{};
  std::vector<Surface> surfaces{};
  std::vector<Camera> cameras{};
  std::vector<Lamp> lamps{};
  std::optional<Sky> sky{};  ///< what is seen where rays leave the scene; empty: black
  /// Of surfaces and cameras. Coordinates are those at RigidMotion::rest_time, the instant that
  /// light is solved for, which all share.
  std::vector<RigidMotion> motions{};
  std::vector<std::string>
      notes{};               ///< what the reader assumed, repaired or dropped: one sentence each
  int dropped_polygons = 0;  ///< of its files, without area or crossing themselves: left out
  /// Emission is in no known unit: a figure of light means something only beside another of it.
  bool relative_units = false;
};

/// A facet's place in the Scene: facets are numbered through all surfaces in order; a sphere is one
/// facet.
struct FacetRef {
  int surface = 0;
  int facet = 0;  ///< within the surface's PolygonMesh; 0 for a sphere
};

/// Every facet of the scene; the index into the result is the facet's scene-wide number.
std::vector<FacetRef> scene_facets(const Scene& scene);

/// Unit normal by Newell's method, towards the front. Zero if the polygon has no area.
Eigen::Vector3d facet_normal(const PolygonMesh& mesh, const Facet& facet);

/// Area in m^2, holes taken out.
double facet_area(const PolygonMesh& mesh, const Facet& facet);

/// m^2 of a surface's polygons or exact sphere, one side.
double surface_area(const Surface& surface);

/// Free sources are those that are no surface: the lamps in order, then the dome of the sky and the
/// sun, each if there is one.
int free_source_count(const Scene& scene);
/// What messages and channels call it; the last ones are "sky" and "sun".
std::string free_source_name(const Scene& scene, int number);

/// Whether anything gives light: a surface, a lamp or the sky.
bool gives_light(const Scene& scene);

/// Axis-aligned bounds of all surfaces; throws std::invalid_argument for a scene without surfaces.
struct Bounds {
  Eigen::Vector3d low, high;
  double diagonal() const { return (high - low).norm(); }
};
Bounds scene_bounds(const Scene& scene);

/// Checks what every later stage relies on: finite coordinates, indices in range, facets with area,
/// spheres with radius, bands of equal count, reflectances in [0,1] that do not create energy,
/// lamps whose axes are a rotation and whose intensity is a finite number >= 0, a sound sky.
/// Throws InputError naming surface, material, value and remedy.
void validate(const Scene& scene);

/// 64-bit hash of everything that decides the light: geometry, materials, lamps, sky and bands, not
/// cameras, names or notes. Written into solutions so that a mismatch is refused.
std::uint64_t scene_hash(const Scene& scene);

}  // namespace lightwell
