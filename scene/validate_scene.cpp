#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "scene/check_material.h"
#include "scene/errors.h"
#include "scene/limits.h"
#include "scene/projected_picture.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {
namespace {

// Least diagonal of a scene, m. Areas of its facets have to be normal floats.
constexpr double smallest_scene = 1e-9;

void check_loop(const Scene& scene, const Surface& surface, const PolygonMesh& mesh, int facet,
                const std::vector<int>& loop) {
  if (loop.size() < 3) {
    refuse_scene(scene,
                 fmt::format("surface '{}', polygon {}: {} vertices; a polygon needs at least 3",
                             surface.name, facet, loop.size()));
  }
  for (int v : loop) {
    if (v < 0 || v >= static_cast<int>(mesh.vertices.size())) {
      refuse_scene(scene,
                   fmt::format("surface '{}', polygon {}: vertex index {} is out of range 0..{}",
                               surface.name, facet, v, mesh.vertices.size() - 1));
    }
  }
}

// Fault of a position, or of a radius as a vector; empty if there is none.
std::string place_fault(const Eigen::Vector3d& p) {
  if (!p.allFinite()) return "a coordinate is not a finite number";
  const double reach = p.cwiseAbs().maxCoeff();
  if (reach <= farthest_coordinate) return {};
  return fmt::format("a coordinate is {:g} m; nothing may lie beyond {:g} m, check the unit", reach,
                     farthest_coordinate);
}

void check_mesh(const Scene& scene, const Surface& surface, const PolygonMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (const std::string what = place_fault(mesh.vertices[v]); !what.empty()) {
      refuse_scene(scene, fmt::format("surface '{}', vertex {}: {}", surface.name, v, what));
    }
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Facet& facet = mesh.facets[f];
    check_loop(scene, surface, mesh, static_cast<int>(f), facet.boundary);
    for (const auto& hole : facet.holes)
      check_loop(scene, surface, mesh, static_cast<int>(f), hole);
    if (!(facet_area(mesh, facet) > 0.0)) {
      refuse_scene(
          scene,
          fmt::format(
              "surface '{}', polygon {}: its area is zero; remove it or correct its vertices",
              surface.name, f));
    }
    if (facet.uv_map < -1 || facet.uv_map >= static_cast<int>(mesh.uv_maps.size())) {
      refuse_scene(scene,
                   fmt::format("surface '{}', polygon {}: its texture coordinates do not exist",
                               surface.name, f));
    }
    if (facet.normal_map < -1 || facet.normal_map >= static_cast<int>(mesh.normal_maps.size())) {
      refuse_scene(scene, fmt::format("surface '{}', polygon {}: its normals do not exist",
                                      surface.name, f));
    }
  }
  for (const NormalMap& map : mesh.normal_maps) {
    if (map.gradient.allFinite() && map.offset.allFinite()) continue;
    refuse_scene(scene, fmt::format("surface '{}': its normals are not finite", surface.name));
  }
  for (const UvMap& uv : mesh.uv_maps) {
    if (uv.gradient.allFinite() && uv.offset.allFinite()) continue;
    refuse_scene(scene,
                 fmt::format("surface '{}': its texture coordinates are not finite", surface.name));
  }
}

void check_lamp(const Scene& scene, const Lamp& lamp) {
  const auto refuse = [&](const std::string& what) {
    refuse_scene(scene, fmt::format("lamp '{}': {}", lamp.name, what));
  };
  if (const std::string what = place_fault(lamp.position); !what.empty()) refuse(what);
  constexpr double rounding = 1e-6;
  const Eigen::Matrix3d& axes = lamp.axes;
  if (!((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < rounding) ||
      !(axes.determinant() > 0.0)) {
    refuse("its axes are no rotation; give three unit vectors at right angles, right-handed");
  }
  check_light(scene, fmt::format("lamp '{}'", lamp.name), "its intensity", "W/sr", lamp.intensity);
  const LampOpening& opening = lamp.opening;
  for (const double size : {opening.along_c0, opening.along_c90}) {
    if (!(size >= 0.0 && std::isfinite(size))) {
      refuse(fmt::format("its opening is {:g} m by {:g} m; neither may be below 0",
                         opening.along_c0, opening.along_c90));
    }
  }
  if (const auto* cone = std::get_if<SpotCone>(&lamp.shape)) {
    if (!(cone->inner >= 0.0 && cone->inner <= cone->outer && cone->outer > 0.0 &&
          cone->outer <= std::numbers::pi)) {
      refuse(
          fmt::format("its cone is {:g} inside and {:g} outside; 0 <= inside <= outside <= pi, "
                      "with outside above 0",
                      cone->inner, cone->outer));
    }
  }
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    if (!*picture) refuse("its picture is empty");
    if (!opening.is_point()) {
      refuse("it projects a picture and has an opening; such a lamp is a point, so remove one");
    }
    if ((*picture)->in_bands(Eigen::Array3d::Ones()).size() != scene.bands.count()) {
      refuse("its picture is in other bands than the scene");
    }
  }
  const auto* web = std::get_if<SharedWeb>(&lamp.shape);
  if (web && (!*web || (*web)->values().size() == 0)) refuse("its distribution is empty");
}

void check_motion(const Scene& scene, const std::string& what, int motion) {
  if (motion >= -1 && motion < static_cast<int>(scene.motions.size())) return;
  refuse_scene(scene, fmt::format("{}: its motion does not exist", what));
}

void check_motions(const Scene& scene) {
  for (const RigidMotion& motion : scene.motions) {
    if (const std::string what = fault(motion); !what.empty()) {
      refuse_scene(scene, fmt::format("motion '{}' {}", motion.name, what));
    }
    if (motion.rest_time != scene.motions.front().rest_time) {
      refuse_scene(
          scene, fmt::format("motion '{}' rests at another time than '{}'; light is solved for one "
                             "instant",
                             motion.name, scene.motions.front().name));
    }
  }
  for (const Surface& surface : scene.surfaces) {
    check_motion(scene, fmt::format("surface '{}'", surface.name), surface.motion);
    if (surface.motion < 0) continue;
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (material.is_emitter()) {
      refuse_scene(
          scene, fmt::format("surface '{}' moves and its material '{}' emits light; light of lamps "
                             "that move is not modelled: let the lamp stand still",
                             surface.name, material.name));
    }
  }
  for (const Camera& camera : scene.cameras) {
    check_motion(scene, fmt::format("camera '{}'", camera.name), camera.motion);
  }
}

void check_round(const Scene& scene, const Surface& surface, const RoundShape& shape) {
  const auto* frustum = std::get_if<Frustum>(&shape);
  const auto fault = [&](const std::string& what) {
    refuse_scene(scene,
                 fmt::format("{} '{}': {}", frustum ? "frustum" : "sphere", surface.name, what));
  };
  const Sphere ball = ball_around(shape);
  for (const Eigen::Vector3d& p : {ball.center, Eigen::Vector3d::Constant(ball.radius).eval()}) {
    if (const std::string what = place_fault(p); !what.empty()) fault(what);
  }
  if (!frustum) {
    if (ball.radius > 0.0) return;
    fault(fmt::format("its radius is {}; it must be positive", ball.radius));
  }
  for (const double size : {frustum->height, frustum->base_radius, frustum->top_radius}) {
    if (!(size >= 0.0))
      fault(fmt::format("a size is {}; height and radii must be at least 0", size));
  }
  constexpr double rounding = 1e-9;
  if (!(std::abs(frustum->axis.norm() - 1.0) <= rounding)) fault("its axis must have length 1");
  if (!(area(shape) > 0.0)) fault("it has no area; give it a height, or two different radii");
}

}  // namespace

void validate(const Camera& camera) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("camera '{}': {}", camera.name, what));
  };
  if (const std::string what = place_fault(camera.position); !what.empty()) refuse(what);
  constexpr double rounding = 1e-6;
  if (!(std::abs(camera.direction.norm() - 1.0) < rounding) ||
      !(std::abs(camera.up.norm() - 1.0) < rounding) ||
      !(std::abs(camera.direction.dot(camera.up)) < rounding)) {
    refuse("direction and up must be unit vectors at right angles to each other");
  }
  if (const std::string what = projection_fault(camera); !what.empty()) refuse(what);
  if (!(camera.lens_radius >= 0.0 && camera.lens_radius <= farthest_coordinate)) {
    refuse(fmt::format("a lens of radius {} m; it must lie between 0, for a pinhole, and {:g} m",
                       camera.lens_radius, farthest_coordinate));
  }
  if (!(camera.focus_distance >= smallest_scene && camera.focus_distance <= farthest_coordinate)) {
    refuse(fmt::format("it is focused at {} m; the distance must lie between {:g} and {:g} m",
                       camera.focus_distance, smallest_scene, farthest_coordinate));
  }
  if (camera.blades != 0 && (camera.blades < 3 || camera.blades > max_blades)) {
    refuse(fmt::format("an aperture of {} blades; give 3 to {}, or 0 for a round one",
                       camera.blades, max_blades));
  }
  if (!std::isfinite(camera.shutter_open) || !std::isfinite(camera.shutter_close) ||
      !(camera.shutter_open <= camera.shutter_close)) {
    refuse(
        fmt::format("its shutter opens at {:g} s and closes at {:g} s; both must be finite, and it "
                    "must not close before it opens",
                    camera.shutter_open, camera.shutter_close));
  }
}

void validate(const Scene& scene) {
  const int bands = scene.bands.count();
  if (bands < 1 || bands > max_bands) {
    refuse_scene(scene,
                 fmt::format("the scene has {} bands; give between 1 and {}", bands, max_bands));
  }
  for (const Material& material : scene.materials) check_material(scene, material);
  for (const Lamp& lamp : scene.lamps) check_lamp(scene, lamp);
  for (const Camera& camera : scene.cameras) {
    try {
      validate(camera);
    } catch (const InputError& error) {
      refuse_scene(scene, error.what());
    }
  }
  if (scene.sky) {
    try {
      validate(*scene.sky, scene.bands);
    } catch (const std::invalid_argument& error) {
      refuse_scene(scene, error.what());
    }
  }
  for (const Surface& surface : scene.surfaces) {
    if (surface.material < 0 || surface.material >= static_cast<int>(scene.materials.size())) {
      refuse_scene(scene,
                   fmt::format("surface '{}' names a material that does not exist", surface.name));
    }
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      check_mesh(scene, surface, *mesh);
    } else {
      check_round(scene, surface, *round_shape(surface));
    }
  }
  if (!scene.surfaces.empty()) {
    const double diagonal = scene_bounds(scene).diagonal();
    if (diagonal < smallest_scene) {
      refuse_scene(
          scene, fmt::format("all of the scene lies within {:g} m; check the unit: a scene must be "
                             "larger than {:g} m",
                             diagonal, smallest_scene));
    }
  }
  check_motions(scene);
}

}  // namespace lightwell
