#include "viewer/window/camera_path.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "scene/atomic_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

using Json = nlohmann::json;

Eigen::Quaterniond orientation(const Camera& camera) {
  Eigen::Matrix3d axes;
  axes << camera.direction.cross(camera.up), camera.up, -camera.direction;
  return Eigen::Quaterniond(axes);
}

// Makes direction and up of a camera orthonormal. False if a vector is zero or not finite, or if
// the two are parallel.
bool straighten_camera(Camera& camera) {
  if (!(camera.direction.norm() > 1e-9) || !camera.direction.allFinite()) return false;
  camera.direction.normalize();
  camera.up -= camera.up.dot(camera.direction) * camera.direction;
  if (!(camera.up.norm() > 1e-6) || !camera.up.allFinite()) return false;
  camera.up.normalize();
  return true;
}

Json json_of(const Camera& camera) {
  const auto three = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json json = {{"position", three(camera.position)},
               {"direction", three(camera.direction)},
               {"up", three(camera.up)},
               {"fov_degrees", camera.fov_degrees},
               {"size", {camera.width, camera.height}}};
  if (camera.projection == Projection::orthographic) {
    json["view_width"] = camera.view_width;
    json["near"] = camera.near_distance;
  }
  if (!camera.shift.isZero(0.0)) json["shift"] = {camera.shift.x(), camera.shift.y()};
  return json;
}

Eigen::Vector3d vector_of(const Json& json, const char* name) {
  const auto values = json.at(name).get<std::vector<double>>();
  if (values.size() != 3) throw InputError(fmt::format("'{}' needs three numbers", name));
  return {values[0], values[1], values[2]};
}

Camera camera_of(const Json& json) {
  Camera camera;
  camera.position = vector_of(json, "position");
  camera.direction = vector_of(json, "direction");
  camera.up = json.contains("up") ? vector_of(json, "up") : Eigen::Vector3d::UnitZ();
  camera.fov_degrees = json.value("fov_degrees", 60.0);
  const auto size = json.value("size", std::vector<int>{4, 3});
  if (size.size() != 2 || !(size[0] > 0 && size[1] > 0)) {
    throw InputError("'size' needs two numbers above 0, width and height");
  }
  camera.width = size[0];
  camera.height = size[1];
  if (!camera.position.allFinite() || !straighten_camera(camera)) {
    throw InputError("'direction' and 'up' must be two directions, not along one line");
  }
  if (!(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0)) {
    throw InputError(
        fmt::format("'fov_degrees' is {}, and must be between 0 and 180", camera.fov_degrees));
  }
  if (json.contains("view_width")) {
    camera.projection = Projection::orthographic;
    camera.view_width = json.at("view_width").get<double>();
    camera.near_distance = json.value("near", 0.0);
  }
  const auto shift = json.value("shift", std::vector<double>{0.0, 0.0});
  if (shift.size() != 2) throw InputError("'shift' needs two numbers, to the right and upwards");
  camera.shift = {shift[0], shift[1]};
  if (const std::string what = projection_fault(camera); !what.empty()) {
    throw InputError("it has " + what);
  }
  return camera;
}

// Cubic Hermite interpolation at a share s in [0,1] of an interval of length h, with values p and
// slopes m at the ends.
Eigen::Vector3d hermite(const Eigen::Vector3d& p0, const Eigen::Vector3d& m0,
                        const Eigen::Vector3d& p1, const Eigen::Vector3d& m1, double h, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return (2.0 * s3 - 3.0 * s2 + 1.0) * p0 + (s3 - 2.0 * s2 + s) * h * m0 +
         (3.0 * s2 - 2.0 * s3) * p1 + (s3 - s2) * h * m1;
}

}  // namespace

Camera CameraPath::at(double second) const {
  const auto after = std::upper_bound(seconds.begin(), seconds.end(), second) - seconds.begin();
  if (after == 0) return cameras.front();
  const auto i = static_cast<std::size_t>(after - 1), last = cameras.size() - 1;
  if (i >= last) return cameras.back();
  const double h = seconds[i + 1] - seconds[i], s = (second - seconds[i]) / h;
  const auto slope = [&](std::size_t k) -> Eigen::Vector3d {
    const std::size_t low = k > 0 ? k - 1 : k, high = std::min(k + 1, last);
    return (cameras[high].position - cameras[low].position) / (seconds[high] - seconds[low]);
  };
  Camera camera = cameras[i];
  camera.position =
      hermite(cameras[i].position, slope(i), cameras[i + 1].position, slope(i + 1), h, s);
  camera.fov_degrees += s * (cameras[i + 1].fov_degrees - camera.fov_degrees);
  camera.view_width += s * (cameras[i + 1].view_width - camera.view_width);
  const Eigen::Matrix3d axes =
      orientation(cameras[i]).slerp(s, orientation(cameras[i + 1])).normalized().toRotationMatrix();
  camera.up = axes.col(1);
  camera.direction = -axes.col(2);
  return camera;
}

std::vector<Camera> frames_along(const CameraPath& path, int count) {
  std::vector<Camera> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(path.at(count > 1 ? path.duration() * i / (count - 1) : 0.0));
  }
  return frames;
}

std::vector<Camera> turntable(const Camera& start, const Eigen::Vector3d& center,
                              const Eigen::Vector3d& up_axis, int count) {
  std::vector<Camera> frames;
  for (int i = 0; i < count; ++i) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / count, up_axis);
    Camera camera = start;
    camera.position = center + turn * (start.position - center);
    camera.direction = turn * start.direction;
    camera.up = turn * start.up;
    frames.push_back(camera);
  }
  return frames;
}

KeptViews read_views(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file.string()));
  KeptViews views;
  std::string place = "the file";
  try {
    const Json json = Json::parse(in);
    const Json bookmarks = json.value("bookmarks", Json::object());
    for (const auto& [key, camera] : bookmarks.items()) {
      place = fmt::format("bookmark '{}'", key);
      if (key.size() != 1 || key[0] < '1' || key[0] > '9') {
        throw InputError("bookmarks are numbered 1 to 9");
      }
      views.bookmarks[static_cast<std::size_t>(key[0] - '1')] = camera_of(camera);
    }
    const Json path = json.value("path", Json::array());
    for (const Json& camera : path) {
      place = fmt::format("camera {} of the path", views.path.cameras.size() + 1);
      const double second = camera.at("seconds").get<double>();
      const bool rises = views.path.empty() ? second >= 0.0 : second > views.path.seconds.back();
      if (!rises || !std::isfinite(second)) {
        throw InputError(
            fmt::format("'seconds' is {}, and must rise from camera to camera", second));
      }
      views.path.cameras.push_back(camera_of(camera));
      views.path.seconds.push_back(second);
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {} cannot be read: {}", file.string(), place, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}: {}", file.string(), place, error.what()));
  }
  return views;
}

void write_views(const std::filesystem::path& file, const KeptViews& views) {
  Json json = {{"bookmarks", Json::object()}, {"path", Json::array()}};
  for (std::size_t i = 0; i < views.bookmarks.size(); ++i) {
    if (!views.bookmarks[i]) continue;
    json["bookmarks"][std::to_string(i + 1)] = json_of(*views.bookmarks[i]);
  }
  for (std::size_t i = 0; i < views.path.cameras.size(); ++i) {
    Json camera = json_of(views.path.cameras[i]);
    camera["seconds"] = views.path.seconds[i];
    json["path"].push_back(std::move(camera));
  }
  AtomicStream target(file);
  target.stream() << json.dump(1) << '\n';
  target.commit();
}

std::filesystem::path frame_name(const std::string& pattern, int index) {
  const auto fail = [&] {
    throw InputError(fmt::format(
        "'{}' has no place for the number of a frame; write one %d, as in out-%04d.png", pattern));
  };
  const std::size_t at = pattern.find('%');
  if (at == std::string::npos || pattern.find('%', at + 1) != std::string::npos) fail();
  const std::size_t end = pattern.find_first_not_of("0123456789", at + 1);
  if (end == std::string::npos || pattern[end] != 'd' || end - at > 3) fail();
  const std::string digits = pattern.substr(at + 1, end - at - 1);
  std::string number = std::to_string(index);
  const std::size_t width = digits.empty() ? 0 : std::stoul(digits);
  if (number.size() < width) number.insert(0, width - number.size(), '0');
  return pattern.substr(0, at) + number + pattern.substr(end + 1);
}

}  // namespace lightwell
