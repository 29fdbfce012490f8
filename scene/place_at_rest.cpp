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

}  // namespace

void place_at_rest(Scene& scene, double time) {
  for (RigidMotion& motion : scene.motions) motion.rest_time = time;
  const auto pose = [&](int motion) {
    return scene.motions[static_cast<std::size_t>(motion)].pose(time);
  };
  for (Surface& surface : scene.surfaces) {
    if (surface.motion < 0) continue;
    if (auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      place(*mesh, pose(surface.motion));
    } else {
      set_shape(surface, moved(*round_shape(surface), pose(surface.motion)));
    }
  }
  for (Camera& camera : scene.cameras) {
    if (camera.motion < 0) continue;
    const Eigen::Isometry3d to = pose(camera.motion);
    camera.position = to * camera.position;
    camera.direction = to.linear() * camera.direction;
    camera.up = to.linear() * camera.up;
  }
}

}  // namespace lightwell
