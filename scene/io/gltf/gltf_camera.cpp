#include "scene/io/gltf/gltf_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/io/camera_name.h"

namespace lightwell {

namespace {

constexpr double extreme = 32.0;  // the picture would be a line beyond
constexpr int usual_height = 512;

void set_aspect(double aspect, Camera& camera) {
  camera.height = usual_height;
  camera.width = static_cast<int>(std::lround(camera.height * aspect));
}

void read_perspective(const JsonObject& from, Camera& camera) {
  const auto lens = from.object("perspective");
  if (!lens) from.fail("lacks 'perspective'");
  const double yfov = lens->number_or("yfov", 0.0), aspect = lens->number_or("aspectRatio", 1.0);
  if (!(yfov > 0.0 && yfov < std::numbers::pi)) {
    lens->fail(fmt::format("has a yfov of {}; it must lie between 0 and pi", yfov));
  }
  if (!(aspect < extreme && aspect > 1.0 / extreme)) {
    lens->fail(fmt::format("has an aspectRatio of {}; no picture is of that shape", aspect));
  }
  camera.fov_degrees = 2.0 * std::atan(aspect * std::tan(0.5 * yfov)) * 180.0 / std::numbers::pi;
  set_aspect(aspect, camera);
}

// `scale` is that of the node along the camera's x axis.
void read_orthographic(const JsonObject& from, double scale, Camera& camera) {
  const auto lens = from.object("orthographic");
  if (!lens) from.fail("lacks 'orthographic'");
  const double xmag = lens->number_or("xmag", 0.0), ymag = lens->number_or("ymag", 0.0);
  const double znear = lens->number_or("znear", 0.0), zfar = lens->number_or("zfar", 0.0);
  if (!(xmag > 0.0 && ymag > 0.0 && xmag < extreme * ymag && ymag < extreme * xmag)) {
    lens->fail(
        fmt::format("has an xmag of {} and a ymag of {}; no picture is of that shape", xmag, ymag));
  }
  if (!(znear >= 0.0 && znear < zfar)) {
    lens->fail(fmt::format("has a znear of {} and a zfar of {}; 0 <= znear < zfar is needed", znear,
                           zfar));
  }
  camera.projection = Projection::orthographic;
  camera.view_width = 2.0 * xmag * scale;
  camera.near_distance = znear * scale;
  set_aspect(xmag / ymag, camera);
}

}  // namespace

void add_gltf_camera(const JsonObject& from, const JsonObject& node,
                     const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks) {
  const std::string name = from.has("name") ? from.name() : node.string_or("name", "");
  const std::string type = from.string_or("type", "");
  if (type != "perspective" && type != "orthographic") {
    remarks.add("Cameras of an unknown type were left out", from.name());
    return;
  }
  Camera camera{.name = camera_name(name, scene)};
  if (type == "perspective") {
    read_perspective(from, camera);
  } else {
    read_orthographic(from, to_world.linear().col(0).norm(), camera);
  }
  // A glTF camera looks along its -z, y upwards (glTF 2.0, 3.10).
  if (!place_camera(to_world, -Eigen::Vector3d::UnitZ(), camera, remarks)) {
    node.fail("leaves its camera no direction or no upright");
  }
  scene.cameras.push_back(camera);
}

}  // namespace lightwell
