#include "cli/projection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/arguments.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

// Numbers between commas; empty unless there are `count`.
std::vector<double> parsed_numbers(const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = parsed_number(text.substr(begin, end - begin));
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers.size() == count ? numbers : std::vector<double>();
}

// Sets projection and extent from KIND or KIND:EXTENT.
void parse_projection(const std::string& text, ProjectionArguments& arguments) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string name = text.substr(0, colon);
  std::vector<std::string> known;
  for (const NamedProjection& each : named_projections) known.emplace_back(each.name);
  arguments.projection = projection_named(name);
  if (!arguments.projection) {
    throw CLI::ValidationError("--projection",
                               fmt::format("there is no projection '{}'; choose from: {}.{}", name,
                                           fmt::join(known, ", "), did_you_mean(name, known)));
  }
  if (colon == text.size()) return;
  const auto extent = parsed_numbers(text.substr(colon + 1), 1);
  const bool is_cube = arguments.projection == Projection::cube_map;
  if (extent.empty() || !(extent[0] > 0.0) || is_cube) {
    throw CLI::ValidationError(
        "--projection",
        fmt::format("'{}': {}", text,
                    is_cube ? "a cube shows all directions; write 'cube' alone"
                            : "write an angle in degrees after the colon, such as fisheye:180, or "
                              "a width in the scene's unit, such as orthographic:6"));
  }
  arguments.extent = extent[0];
}

// Width of an orthographic picture that shows all of the scene.
double width_of_all(const Camera& camera, const Scene& scene) {
  const Bounds bounds = scene_bounds(scene);
  const Eigen::Vector3d right = camera.direction.cross(camera.up);
  double across = 0.0, upwards = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at((corner & 1 ? bounds.high : bounds.low).x(),
                             (corner & 2 ? bounds.high : bounds.low).y(),
                             (corner & 4 ? bounds.high : bounds.low).z());
    across = std::max(across, std::abs(right.dot(at - camera.position)));
    upwards = std::max(upwards, std::abs(camera.up.dot(at - camera.position)));
  }
  return 2.0 * std::max(across, upwards * camera.width / camera.height);
}

}  // namespace

void ProjectionArguments::add_to(CLI::App& command, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--projection", [this](const std::string& text) { parse_projection(text, *this); },
          "how the camera sees, and its angle in degrees: perspective:60, orthographic:6 (wide in "
          "the scene's unit), fisheye:180, equisolid, hemispherical, stereographic, cylindrical, "
          "equirectangular, stereo, cube (default: the camera's)")
      ->type_name("KIND[:ANGLE]")
      ->group(group);
  command
      .add_option_function<double>(
          "--near", [this](const double& length) { near_limit = length; },
          "what is nearer than this is not seen, in the scene's unit: opens rooms for plans and "
          "sections")
      ->type_name("L")
      ->check(positive())
      ->group(group);
  command
      .add_option_function<std::string>(
          "--shift",
          [this](const std::string& text) {
            const auto shares = parsed_numbers(text, 2);
            if (shares.empty()) {
              throw CLI::ValidationError(
                  "--shift", fmt::format("'{}' is no shift; write two shares of the picture, to "
                                         "the right and upwards, such as 0,0.2",
                                         text));
            }
            shift = Eigen::Vector2d(shares[0], shares[1]);
          },
          "shift of the lens to the right and upwards, in shares of the picture: keeps verticals "
          "upright")
      ->type_name("X,Y")
      ->group(group);
}

Camera ProjectionArguments::view(const Camera& camera, const Scene& scene) const {
  Camera result = projection ? with_projection(camera, *projection) : camera;
  const bool is_parallel = result.projection == Projection::orthographic;
  if (near_limit) result.near_distance = *near_limit * scene.metres_per_unit;
  if (shift) result.shift = *shift;
  if (size) set_picture_size(size->first, size->second, result);
  if (extent && is_parallel) {
    result.view_width = *extent * scene.metres_per_unit;
  } else if (extent) {
    result.fov_degrees = *extent;
  } else if (is_parallel && camera.projection != result.projection) {
    result.view_width = width_of_all(result, scene);
  }
  if (const std::string what = projection_fault(result); !what.empty()) {
    throw InputError(fmt::format(
        "camera '{}'{} would have {}", camera.name,
        text().empty() ? std::string() : fmt::format(" with '{}'", text().substr(1)), what));
  }
  return result;
}

std::string ProjectionArguments::text() const {
  std::string text;
  if (projection) {
    text += fmt::format(" --projection {}", named(*projection).name);
    if (extent) text += fmt::format(":{:g}", *extent);
  }
  if (near_limit) text += fmt::format(" --near {:g}", *near_limit);
  if (shift) text += fmt::format(" --shift {:g},{:g}", shift->x(), shift->y());
  return text;
}

}  // namespace lightwell
