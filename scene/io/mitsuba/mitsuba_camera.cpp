#include "scene/io/mitsuba/mitsuba_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/degree.h"
#include "scene/io/camera_name.h"
#include "scene/io/mitsuba/mitsuba_transform.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

// Tangent of half the horizontal angle of view.
double half_width(const MitsubaNode& sensor, double width, double height) {
  double fov = 0.0;
  std::string axis = sensor.string_or("fov_axis", "x");
  if (const auto given = sensor.number("fov")) {
    fov = *given;
  } else {
    // Focal lengths such as "50mm" refer to 35 mm film, 36 mm x 24 mm.
    const std::string text = sensor.string_or("focal_length", "50mm");
    const MitsubaNode* node = sensor.property("focal_length");
    const auto millimetres = parse_numbers(node ? *node : sensor, text.substr(0, text.find("mm")));
    if (millimetres.size() != 1 || !(millimetres[0] > 0.0)) {
      sensor.fail(fmt::format("has the focal length '{}'; write '50mm'", text));
    }
    fov = 2.0 * std::atan(0.5 * std::hypot(36.0, 24.0) / millimetres[0]) / degree;
    axis = "diagonal";
  }
  if (!(fov > 0.0 && fov < 180.0)) {
    sensor.fail(
        fmt::format("has a field of view of {} degrees; it must lie between 0 and 180", fov));
  }
  const double tangent = std::tan(0.5 * fov * degree);
  if (axis == "smaller") axis = width < height ? "x" : "y";
  if (axis == "larger") axis = width < height ? "y" : "x";
  if (axis == "x") return tangent;
  if (axis == "y") return tangent * width / height;
  if (axis == "diagonal") return tangent * width / std::hypot(width, height);
  sensor.fail(
      fmt::format("has the fov axis '{}'; known are x, y, diagonal, smaller and larger", axis));
}

int pixels(const MitsubaNode* film, const char* property, int otherwise) {
  if (!film) return otherwise;
  const double count = film->number_or(property, otherwise);
  if (!(count >= 1.0 && count <= max_picture_edge && count == std::floor(count))) {
    film->fail(fmt::format("has the {} {}; give a whole number from 1 to {}", property, count,
                           max_picture_edge));
  }
  return static_cast<int>(count);
}

// Lens radius and focus distance in scene units, taken as metres. Mitsuba rejects a thin lens
// without an aperture; here an aperture of 0 is a pinhole.
void read_mitsuba_lens(const MitsubaNode& sensor, Camera& camera) {
  camera.lens_radius = sensor.number_or("aperture_radius", 0.0);
  camera.focus_distance = sensor.number_or("focus_distance", 1.0);
  if (!(camera.lens_radius >= 0.0 && std::isfinite(camera.lens_radius))) {
    sensor.fail(
        fmt::format("has an aperture radius of {}; it must not be negative", camera.lens_radius));
  }
  if (!(camera.focus_distance > 0.0 && std::isfinite(camera.focus_distance))) {
    sensor.fail(
        fmt::format("is focused at a distance of {}; it must be above 0", camera.focus_distance));
  }
}

// Crop windows of the film, in pixels of the whole picture.
void read_crop(const MitsubaNode& film, Camera& camera) {
  const int width = camera.width, height = camera.height;
  const auto window = [&](const char* offset, const char* size, int whole, double& low,
                          double& high) {
    const double first = film.number_or(offset, 0.0), count = film.number_or(size, whole - first);
    if (!(first >= 0.0 && count >= 1.0 && first + count <= whole)) {
      film.fail(fmt::format("has {} {} and {} {}; the window must lie within {} pixels", offset,
                            first, size, count, whole));
    }
    low = first / whole;
    high = (first + count) / whole;
  };
  window("crop_offset_x", "crop_width", width, camera.window.left, camera.window.right);
  window("crop_offset_y", "crop_height", height, camera.window.top, camera.window.bottom);
  set_picture_size(width, height, camera);
}

// An orthographic sensor of Mitsuba sees the square from -1 to 1 of its own frame in a square
// picture; in others the picture's width is 2. The transformation scales it.
void set_parallel(const Eigen::Affine3d& to_world, const MitsubaNode& sensor, Camera& camera) {
  camera = with_projection(camera, Projection::orthographic);
  camera.view_width = 2.0 * to_world.linear().col(0).norm();
  if (std::abs(to_world.linear().col(1).norm() / to_world.linear().col(0).norm() - 1.0) > 1e-3) {
    sensor.fail("is scaled differently in width and height; pixels are square here");
  }
}

}  // namespace

void add_mitsuba_camera(const MitsubaNode& sensor, const MitsubaTree& tree, Scene& scene,
                        Remarks& remarks) {
  const bool is_parallel = sensor.type == "orthographic";
  if (!is_parallel && sensor.type != "perspective" && sensor.type != "thinlens") {
    remarks.add(fmt::format("Cameras of the plugin '{}' were left out", sensor.type),
                sensor.label());
    return;
  }
  Camera camera{.name = camera_name(sensor.id, scene)};
  const auto films = tree.children(sensor, "film");
  const MitsubaNode* film = films.empty() ? nullptr : films.front();
  camera.width = pixels(film, "width", 768);  // Mitsuba's own default
  camera.height = pixels(film, "height", 576);
  const Eigen::Affine3d to_world = read_to_world(sensor);
  if (is_parallel) {
    set_parallel(to_world, sensor, camera);
  } else {
    camera.fov_degrees = 2.0 * std::atan(half_width(sensor, camera.width, camera.height)) / degree;
    // The offset moves the picture to the right and downwards.
    camera.shift = {sensor.number_or("principal_point_offset_x", 0.0),
                    -sensor.number_or("principal_point_offset_y", 0.0)};
  }
  if (film) read_crop(*film, camera);
  camera.near_distance = sensor.number_or("near_clip", camera.near_distance);
  camera.far_distance = sensor.number_or("far_clip", camera.far_distance);
  if (!place_camera(to_world, Eigen::Vector3d::UnitZ(), camera, remarks)) {
    sensor.fail("has a transformation that leaves it no direction or no upright");
  }
  if (sensor.type == "thinlens") read_mitsuba_lens(sensor, camera);
  if (const std::string what = projection_fault(camera); !what.empty()) sensor.fail("has " + what);
  scene.cameras.push_back(camera);
}

}  // namespace lightwell
