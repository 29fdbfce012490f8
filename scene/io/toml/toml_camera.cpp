#include "scene/io/toml/toml_camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene/io/nearest_name.h"
#include "scene/io/toml/toml_motions.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

// Fails at the value that gives the camera a fault.
void require_sound(const Camera& camera, const TomlValue& value) {
  if (const std::string what = projection_fault(camera); !what.empty()) {
    value.fail("gives " + what);
  }
}

Eigen::Vector3d read_view_direction(const TomlTable& table, const Eigen::Vector3d& position) {
  const auto given = table.present({"direction", "look_at"});
  if (given.size() != 1) table.fail("needs exactly one of 'direction' and 'look_at'");
  const TomlValue value = table.require(given[0]);
  const Eigen::Vector3d direction =
      given[0] == "look_at" ? Eigen::Vector3d(value.vector() - position) : value.vector();
  if (!(direction.stableNorm() > 0.0)) {
    value.fail(given[0] == "look_at" ? "is the camera's own position; look at another point"
                                     : "has no length; give the direction to look in");
  }
  return direction.stableNormalized();
}

// An f-number refers to a film 36 mm wide, so the focal length follows from fov.
void read_toml_lens(const TomlTable& table, double metres_per_unit, Camera& camera) {
  const auto given = table.present({"aperture_radius", "f_number"});
  if (given.size() > 1) {
    table.require(given[1]).fail("is a second statement of the aperture, after 'aperture_radius'");
  }
  if (given.empty()) {
    for (const auto& key : table.present({"focus_distance", "blades"})) {
      table.require(key).fail(
          "needs a lens; give 'f_number' or 'aperture_radius', or remove it: a pinhole camera "
          "shows everything sharp");
    }
    return;
  }
  const TomlValue aperture = table.require(given[0]);
  if (given[0] == "aperture_radius") {
    camera.lens_radius = metres_per_unit * aperture.positive();
  } else {
    constexpr double half_film = 0.018;  // m
    const double focal_length =
        half_film / std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0);
    camera.lens_radius = 0.5 * focal_length / aperture.positive();
  }
  if (!std::isfinite(camera.lens_radius)) aperture.fail("is no aperture");
  require_sound(camera, aperture);
  camera.focus_distance = metres_per_unit * table.require("focus_distance").positive();
  if (const auto blades = table.find("blades")) {
    camera.blades = static_cast<int>(blades->integer_within(3, max_blades));
  }
}

Projection read_projection(const TomlValue& value) {
  const std::string name = value.string();
  if (const auto projection = projection_named(name)) return *projection;
  std::vector<std::string> known;
  for (const NamedProjection& each : named_projections) known.emplace_back(each.name);
  value.fail(
      fmt::format("is '{}'; choose {}.{}", name, quoted_list(known), did_you_mean(name, known)));
}

// A camera of this projection with the usual angle and size.
Camera usual_camera(Projection projection, const std::string& name) {
  Camera camera{.name = name};
  if (is_panorama(projection)) camera.width = 1024;
  if (projection == Projection::cube_map) camera.width = 1536;
  return with_projection(camera, projection);
}

// Fails at a key that has no meaning for the camera's projection.
void refuse_idle_keys(const TomlTable& table, Projection projection) {
  const auto refuse = [&](const char* key, bool is_used, const std::string& remedy) {
    if (is_used || !table.has(key)) return;
    table.require(key).fail(
        fmt::format("has no effect with the projection '{}'; {}", named(projection).name, remedy));
  };
  const bool is_parallel = projection == Projection::orthographic;
  refuse("fov", !is_parallel && projection != Projection::cube_map,
         is_parallel ? "give 'view_width', the width of what the picture shows"
                     : "remove it: six faces show everything");
  refuse("view_width", is_parallel, "give 'fov', an angle, or the projection 'orthographic'");
  refuse("circle", is_fisheye(projection), "remove it: only fisheyes have a circle");
  refuse("eye_separation", projection == Projection::stereo_panorama,
         "remove it, or give the projection 'stereo'");
}

void read_range(const TomlTable& table, double metres_per_unit, Camera& camera) {
  if (const auto near_limit = table.find("near")) {
    camera.near_distance = metres_per_unit * near_limit->number_at_least(0.0);
    require_sound(camera, *near_limit);
  }
  if (const auto far_limit = table.find("far")) {
    camera.far_distance = metres_per_unit * far_limit->positive();
    require_sound(camera, *far_limit);
  }
}

void read_distortion(const TomlValue& value, Camera& camera) {
  const TomlTable table = value.table({"k1", "k2", "k3", "p1", "p2"});
  LensDistortion& lens = camera.distortion;
  for (const auto& [key, coefficient] : {std::pair{"k1", &lens.k1},
                                         {"k2", &lens.k2},
                                         {"k3", &lens.k3},
                                         {"p1", &lens.p1},
                                         {"p2", &lens.p2}}) {
    if (const auto given = table.find(key)) *coefficient = given->number();
  }
  require_sound(camera, value);
}

std::vector<double> read_numbers(const TomlValue& value, std::size_t count, const char* form) {
  std::vector<double> numbers;
  for (const TomlValue& each : value.elements("number")) numbers.push_back(each.number());
  if (numbers.size() != count) value.fail(fmt::format("must be {}", form));
  return numbers;
}

// Size of the whole picture, and the part of it that is rendered.
void read_size(const TomlTable& table, Camera& camera) {
  int width = camera.width, height = camera.height;
  if (const auto size = table.find("size")) {
    const auto pixels = size->elements("number");
    if (pixels.size() != 2) size->fail("must be two whole numbers [width, height]");
    width = static_cast<int>(pixels[0].integer_within(1, max_picture_edge));
    height = static_cast<int>(pixels[1].integer_within(1, max_picture_edge));
    set_picture_size(width, height, camera);
    require_sound(camera, *size);
  }
  if (const auto crop = table.find("crop")) {
    const auto edges = read_numbers(*crop, 4, "four shares [left, top, right, bottom] from 0 to 1");
    camera.window = {.left = edges[0], .top = edges[1], .right = edges[2], .bottom = edges[3]};
    require_sound(camera, *crop);
    set_picture_size(width, height, camera);
  }
}

void read_projection_keys(const TomlTable& table, double metres_per_unit, Camera& camera) {
  refuse_idle_keys(table, camera.projection);
  if (const auto fov = table.find("fov")) {
    camera.fov_degrees = fov->number();
    require_sound(camera, *fov);
  }
  if (camera.projection == Projection::orthographic) {
    const TomlValue width = table.require("view_width");
    camera.view_width = metres_per_unit * width.positive();
    require_sound(camera, width);
  }
  read_size(table, camera);
  if (const auto shift = table.find("shift")) {
    const auto shares = read_numbers(*shift, 2, "two shares of the picture [right, up]");
    camera.shift = {shares[0], shares[1]};
    require_sound(camera, *shift);
  }
  if (const auto circle = table.find("circle")) {
    camera.circle_degrees = circle->positive();
    require_sound(camera, *circle);
  }
  if (const auto eyes = table.find("eye_separation")) {
    camera.eye_separation = metres_per_unit * eyes->number_at_least(0.0);
    require_sound(camera, *eyes);
  }
  if (const auto distortion = table.find("distortion")) read_distortion(*distortion, camera);
  read_range(table, metres_per_unit, camera);
}

}  // namespace

Camera read_toml_camera(const TomlValue& value, std::size_t number, const Scene& scene,
                        std::set<std::string>& names) {
  const auto given = value.member("name");
  const auto kind = value.member("projection");
  Camera camera = usual_camera(kind ? read_projection(*kind) : Projection::perspective,
                               given ? given->file_name() : fmt::format("camera{}", number));
  const TomlTable table =
      value.renamed(fmt::format("camera '{}'", camera.name))
          .table({"name",   "position",        "direction",  "look_at",        "up",     "fov",
                  "size",   "aperture_radius", "f_number",   "focus_distance", "blades", "shutter",
                  "motion", "projection",      "view_width", "near",           "far",    "shift",
                  "crop",   "distortion",      "circle",     "eye_separation"});
  if (!names.insert(camera.name).second) {
    table.fail("has a name that an earlier camera has; give it another");
  }
  const Eigen::Vector3d position = table.require("position").vector();
  camera.position = scene.metres_per_unit * position;
  camera.direction = read_view_direction(table, position);
  const auto up = table.find("up");
  const Eigen::Vector3d upwards = up ? Eigen::Vector3d(up->vector().stableNormalized()) : camera.up;
  const Eigen::Vector3d across = upwards - upwards.dot(camera.direction) * camera.direction;
  if (!(across.norm() > parallel_sine)) {
    (up ? *up : table.value())
        .fail(up ? "has no length or is parallel to the viewing direction; choose another"
                 : "looks along [0, 1, 0]; say with 'up' which way is up in the picture");
  }
  camera.up = across.normalized();
  read_projection_keys(table, scene.metres_per_unit, camera);
  read_toml_lens(table, scene.metres_per_unit, camera);
  if (const auto shutter = table.find("shutter")) read_toml_shutter(*shutter, camera);
  if (const auto motion = table.find("motion")) camera.motion = find_toml_motion(*motion, scene);
  return camera;
}

}  // namespace lightwell
