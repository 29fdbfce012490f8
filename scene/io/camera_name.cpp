#include "scene/io/camera_name.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/limits.h"

namespace lightwell {

std::string camera_name(std::string name, const Scene& scene) {
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || c == '\\' || c == '\0'; }, '_');
  const auto is_taken = [&] {
    return std::ranges::find(scene.cameras, name, &Camera::name) != scene.cameras.end();
  };
  if (name.empty() || name.starts_with('.') || name.size() > longest_camera_name || is_taken()) {
    name = fmt::format("camera{}", scene.cameras.size() + 1);
  }
  while (is_taken()) name += '_';
  return name;
}

bool place_camera(const Eigen::Affine3d& to_world, const Eigen::Vector3d& ahead, Camera& camera,
                  Remarks& remarks) {
  camera.position = to_world.translation();
  const Eigen::Vector3d direction = to_world.linear() * ahead, up = to_world.linear().col(1);
  camera.direction = direction.stableNormalized();
  const Eigen::Vector3d across = up.stableNormalized().cross(camera.direction);
  if (!(direction.stableNorm() > 0.0 && across.norm() > parallel_sine)) return false;
  camera.up = camera.direction.cross(across.normalized());
  if (to_world.linear().determinant() < 0.0) {
    remarks.add("Cameras that mirror what they see were turned the right way round", camera.name);
  }
  return true;
}

}  // namespace lightwell
