#include "scene/place_at_rest.h"
#include "scene/round_shape.h"

namespace lightwell {
namespace {

void place(PolygonMesh& mesh, const Eigen::Isometry3d& to) {
  for (Eigen::Vector3d& v : mesh.vertices) v = to * v;
  const Eigen::Matrix3d back = to.linear().transpose();
  for (UvMap& map : mesh.uv_maps) {
    map.gradient = map.gradient * back;
    map.offset -= map.gradient * to.translation();
  }
  for (NormalMap& map : mesh.normal_maps) {
    map.gradient = to.linear() * map.gradient * back;
    map.offset = to.linear() * map.offset - map.gradient * to.translation();
  }
}

void place(Camera& camera, const Eigen::Isometry3d& to) {
  camera.position = to * camera.position;
  camera.direction = to.linear() * camera.direction;
  camera.up = to.linear() * camera.up;
}

// Pose of a motion of the scene at its rest time.
Eigen::Isometry3d rest_pose(const Scene& scene, int number) {
  const RigidMotion& motion = scene.motions[static_cast<std::size_t>(number)];
  return motion.pose(motion.rest_time);
}

}  // namespace

void place_at_rest(Scene& scene, double time) {
  for (RigidMotion& motion : scene.motions) motion.rest_time = time;
  for (Surface& surface : scene.surfaces) {
    if (surface.motion < 0) continue;
    if (auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      place(*mesh, rest_pose(scene, surface.motion));
    } else {
      set_shape(surface, moved(*round_shape(surface), rest_pose(scene, surface.motion)));
    }
  }
  for (Camera& camera : scene.cameras) place_at_rest(scene, camera);
}

void place_at_rest(const Scene& scene, Camera& camera) {
  if (camera.motion >= 0) place(camera, rest_pose(scene, camera.motion));
}

Camera placed_as_in_file(const Scene& scene, const Camera& camera) {
  Camera moved = camera;
  if (camera.motion >= 0) place(moved, rest_pose(scene, camera.motion).inverse());
  return moved;
}

}  // namespace lightwell
