#include "scene/io/pov/pov_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/degree.h"
#include "scene/io/camera_name.h"
#include "scene/io/pov/pov_materials.h"
#include "scene/io/pov/pov_transform.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

/// Vectors of a camera of the language. The picture spans `right` and `up` around `direction`.
struct PovCamera {
  Eigen::Vector3d location = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ(),
                  right = {4.0 / 3.0, 0.0, 0.0}, up = Eigen::Vector3d::UnitY(),
                  sky = Eigen::Vector3d::UnitY();
  std::optional<double> angle{};
  std::string_view kind = "perspective";
  double aperture = 0.0, focal_distance = 0.0;
  double target_distance = 1.0;

  // Turns the vectors so that `direction` points there and `right` is level; lengths stay.
  void look_at(const Eigen::Vector3d& point, const PovNode& node) {
    const Eigen::Vector3d way = point - location;
    const Eigen::Vector3d across = sky.cross(way);
    if (!(way.stableNorm() > 0.0)) node.fail("looks at its own place");
    if (!(across.stableNorm() > parallel_sine * sky.stableNorm() * way.stableNorm())) {
      node.fail("looks along its 'sky', so that no upright is left; give another 'sky'");
    }
    // Axes are left-handed: right is up x direction, or its opposite in mirrored pictures.
    const double handed = up.cross(direction).dot(right) < 0.0 ? -1.0 : 1.0;
    target_distance = way.norm();
    const double length = direction.norm(), height = up.norm(), width = right.norm();
    direction = length * way.stableNormalized();
    right = handed * width * across.stableNormalized();
    up = height * way.cross(across).stableNormalized();
  }
};

void read_camera(const PovNode& node, PovCamera& camera, Remarks& remarks) {
  constexpr std::array<std::string_view, 7> kinds = {
      "perspective", "orthographic", "fisheye",  "ultra_wide_angle",
      "omnimax",     "panoramic",    "spherical"};
  PovCursor cursor(node);
  Eigen::Affine3d moved = Eigen::Affine3d::Identity();
  std::optional<Eigen::Vector3d> target;
  while (!cursor.at_end()) {
    if (take_pov_transform(cursor, moved)) continue;
    const PovItem& item = cursor.next();
    const std::string_view word = item.word;
    if (item.node() && item.node()->keyword == "camera") {
      read_camera(*item.node(), camera, remarks);
    } else if (word == "location") {
      camera.location = cursor.need_point("location");
    } else if (word == "direction") {
      camera.direction = cursor.need_point("direction");
    } else if (word == "right") {
      camera.right = cursor.need_point("right");
    } else if (word == "up") {
      camera.up = cursor.need_point("up");
    } else if (word == "sky") {
      camera.sky = cursor.need_point("sky");
    } else if (word == "look_at") {
      target = cursor.need_point("look_at");
    } else if (word == "angle") {
      camera.angle = cursor.need_number("angle");
      cursor.number();
    } else if (word == "aperture") {
      camera.aperture = cursor.need_number("aperture");
    } else if (word == "focal_point") {
      camera.focal_distance = (cursor.need_point("focal_point") - camera.location).norm();
    } else if (std::ranges::find(kinds, word) != kinds.end()) {
      camera.kind = word;
    } else if (word == "cylinder") {
      camera.kind = "panoramic";
      cursor.number();
    } else {
      cursor.vector();
    }
  }
  if (target) camera.look_at(*target, node);
  camera.location = moved * camera.location;
  for (Eigen::Vector3d* v : {&camera.direction, &camera.right, &camera.up}) {
    *v = moved.linear() * *v;
  }
}

/// Full horizontal angle of a perspective camera, degrees.
double horizontal_angle(const PovCamera& camera) {
  if (camera.angle) return *camera.angle;
  return 2.0 * std::atan(0.5 * camera.right.norm() / camera.direction.norm()) / degree;
}

void set_projection(const PovCamera& given, const PovNode& node, Camera& camera, Remarks& remarks) {
  const auto turn_to = [&](Projection projection, double usual) {
    const int width = camera.width, height = camera.height;
    camera = with_projection(camera, projection);
    if (projection != Projection::equirectangular) {
      camera.width = width;
      camera.height = height;
    }
    camera.fov_degrees = std::min(given.angle.value_or(usual), named(projection).widest);
  };
  if (given.kind == "orthographic") {
    camera = with_projection(camera, Projection::orthographic);
    camera.view_width = given.right.norm();
    if (given.angle) {
      // The width that a perspective of this angle has where the camera looks at.
      camera.view_width = 2.0 * given.target_distance * std::tan(0.5 * *given.angle * degree);
    }
  } else if (given.kind == "fisheye") {
    turn_to(Projection::equidistant, 180.0);
  } else if (given.kind == "spherical") {
    turn_to(Projection::equirectangular, 360.0);
  } else if (given.kind == "panoramic") {
    turn_to(Projection::cylindrical, 180.0);
  } else {
    if (given.kind != "perspective") {
      remarks.add(fmt::format("Cameras of the kind '{}' were read as perspective ones", given.kind),
                  camera.name);
    }
    camera.fov_degrees = horizontal_angle(given);
  }
  if (const std::string what = projection_fault(camera); !what.empty()) node.fail("has " + what);
}

/// Even colour of a block's pigment, the mean of its pattern.
PovVector sky_color(const PovNode& sky, Remarks& remarks) {
  PovVector color{.count = 5};
  std::int64_t visits = 0;
  for (const PovItem& item : sky.items) {
    if (item.vector()) color = pov_color(*item.vector());
    const PovNode* child = item.node();
    if (!child) continue;
    if (child->keyword == "pigment") {
      const PovTexture texture = pov_texture({child}, "sky_sphere", remarks, visits);
      if (texture.pigment.picture) {
        remarks.add("Pictures of skies were left out, and count as black", "sky_sphere");
      }
      color = texture.pigment.color;
    } else if (child->keyword == sky.keyword) {
      color = sky_color(*child, remarks);
    }
  }
  return color;
}

}  // namespace

void add_pov_camera(const PovNode& node, Scene& scene, Remarks& remarks) {
  PovCamera given;
  read_camera(node, given, remarks);
  Camera camera{.name = camera_name(node.name, scene)};
  const Eigen::Affine3d to_scene = from_pov_axes();
  const Eigen::Vector3d direction = to_scene.linear() * given.direction,
                        right = to_scene.linear() * given.right, up = to_scene.linear() * given.up;
  camera.position = to_scene * given.location;
  if (!camera.position.allFinite() ||
      !(camera.position.cwiseAbs().maxCoeff() <= farthest_coordinate)) {
    node.fail(fmt::format("is farther than {:g} from the origin", farthest_coordinate));
  }
  camera.direction = direction.stableNormalized();
  const Eigen::Vector3d across = camera.direction.cross(up.stableNormalized());
  const double aspect = right.norm() / up.norm();
  if (!(across.norm() > parallel_sine && right.norm() > 0.0 && std::isfinite(aspect))) {
    node.fail("has a direction, right and up that span no picture");
  }
  camera.up = across.normalized().cross(camera.direction);
  if (across.dot(right) < 0.0) {
    remarks.add("Cameras that mirror what they see were turned the right way round", camera.name);
  }
  constexpr int height = 480;
  camera.height = height;
  camera.width =
      static_cast<int>(std::clamp(std::round(height * aspect), 1.0, double{max_picture_edge}));
  set_projection(given, node, camera, remarks);
  if (given.aperture > 0.0 && given.focal_distance > 0.0 && is_flat(camera.projection)) {
    remarks.add("Depth of field ('aperture') was left out", camera.name);
  }
  scene.cameras.push_back(camera);
}

void add_pov_sky(const PovNode& node, double gamma, Scene& scene, Remarks& remarks) {
  const Spectrum radiance = pov_linear(sky_color(node, remarks), gamma).min(most_light);
  if (!scene.sky) scene.sky = dark_sky(scene.bands);
  scene.sky->name = "uniform all around";
  scene.sky->scale = scene.sky->ground = radiance;
}

}  // namespace lightwell
