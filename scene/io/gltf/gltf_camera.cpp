#include "scene/io/gltf/gltf_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/io/camera_name.h"

namespace lightwell {

void add_gltf_camera(const GltfObject& from, const GltfObject& node,
                     const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks) {
  const std::string name = from.has("name") ? from.name() : node.string_or("name", "");
  if (from.string_or("type", "") != "perspective") {
    remarks.add("Cameras without perspective were left out", from.name());
    return;
  }
  const auto lens = from.object("perspective");
  if (!lens) from.fail("lacks 'perspective'");
  const double yfov = lens->number_or("yfov", 0.0), aspect = lens->number_or("aspectRatio", 1.0);
  constexpr double extreme = 32.0;  // the picture would be a line beyond
  if (!(yfov > 0.0 && yfov < std::numbers::pi)) {
    lens->fail(fmt::format("has a yfov of {}; it must lie between 0 and pi", yfov));
  }
  if (!(aspect < extreme && aspect > 1.0 / extreme)) {
    lens->fail(fmt::format("has an aspectRatio of {}; no picture is of that shape", aspect));
  }
  Camera camera{.name = camera_name(name, scene)};
  camera.fov_degrees = 2.0 * std::atan(aspect * std::tan(0.5 * yfov)) * 180.0 / std::numbers::pi;
  camera.height = 512;
  camera.width = static_cast<int>(std::lround(camera.height * aspect));
  // A glTF camera looks along its -z, y upwards (glTF 2.0, 3.10).
  if (!place_camera(to_world, -Eigen::Vector3d::UnitZ(), camera, remarks)) {
    node.fail("leaves its camera no direction or no upright");
  }
  scene.cameras.push_back(camera);
}

}  // namespace lightwell
