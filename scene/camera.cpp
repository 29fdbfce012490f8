#include "scene/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/degree.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

// Share of an edge by which rounding may make a picture of 180 degrees higher.
constexpr double edge_rounding = 1e-9;

bool is_whole(const PictureWindow& w) {
  return w.left == 0.0 && w.top == 0.0 && w.right == 1.0 && w.bottom == 1.0;
}

std::string angle_fault(const Camera& camera) {
  const NamedProjection& kind = named(camera.projection);
  const double fov = camera.fov_degrees;
  if (camera.projection == Projection::orthographic) {
    if (camera.view_width > 0.0 && camera.view_width <= farthest_coordinate) return {};
    return fmt::format("a view {} m wide; the width must be above 0 and at most {:g} m",
                       camera.view_width, farthest_coordinate);
  }
  if (camera.projection == Projection::cube_map) return {};
  const bool is_open = camera.projection == Projection::perspective ||
                       camera.projection == Projection::stereographic;
  if (fov > 0.0 && (fov < kind.widest || (fov == kind.widest && !is_open))) return {};
  if (camera.projection == Projection::perspective) {
    return fmt::format(
        "a field of view of {} degrees; it must lie between 0 and 180, so choose the projection "
        "'fisheye', 'cylindrical' or 'equirectangular' to see more",
        fov);
  }
  return fmt::format(
      "a field of view of {} degrees; the projection '{}' shows angles above 0 and {} {}", fov,
      kind.name, is_open ? "below" : "up to", kind.widest);
}

std::string range_fault(const Camera& camera) {
  if (!(camera.near_distance >= 0.0 && camera.near_distance <= farthest_coordinate)) {
    return fmt::format("a view that begins at {} m; the distance must lie between 0 and {:g} m",
                       camera.near_distance, farthest_coordinate);
  }
  if (!(camera.far_distance > camera.near_distance)) {
    return fmt::format(
        "a view that begins at {} m and ends at {} m; the end must lie behind the beginning",
        camera.near_distance, camera.far_distance);
  }
  return {};
}

std::string window_fault(const Camera& camera) {
  const PictureWindow& w = camera.window;
  if (!(w.left >= 0.0 && w.left < w.right && w.right <= 1.0 && w.top >= 0.0 && w.top < w.bottom &&
        w.bottom <= 1.0)) {
    return fmt::format(
        "a window from ({}, {}) to ({}, {}); give left and right, top and bottom in rising order, "
        "as shares of the picture from 0 to 1",
        w.left, w.top, w.right, w.bottom);
  }
  const bool has_parts =
      camera.projection == Projection::stereo_panorama || camera.projection == Projection::cube_map;
  if (has_parts && !is_whole(w)) {
    return fmt::format(
        "a window of the projection '{}', whose picture has several parts; render "
        "the whole picture",
        named(camera.projection).name);
  }
  return {};
}

std::string shift_fault(const Camera& camera) {
  if (!(camera.shift.cwiseAbs().maxCoeff() <= most_shift)) {
    return fmt::format("a shift by ({}, {}) pictures; shifts lie between -{} and {}",
                       camera.shift.x(), camera.shift.y(), most_shift, most_shift);
  }
  const bool has_shift = is_flat(camera.projection) || is_fisheye(camera.projection) ||
                         camera.projection == Projection::cylindrical;
  if (has_shift || camera.shift.isZero(0.0)) return {};
  return fmt::format("a shift of the projection '{}', which has none; turn the camera instead",
                     named(camera.projection).name);
}

std::string lens_fault(const Camera& camera) {
  const LensDistortion& d = camera.distortion;
  for (const double k : {d.k1, d.k2, d.k3, d.p1, d.p2}) {
    if (std::abs(k) <= most_distortion) continue;
    return fmt::format("a coefficient of distortion of {}; coefficients lie between -{} and {}", k,
                       most_distortion, most_distortion);
  }
  const std::string_view name = named(camera.projection).name;
  if (camera.projection != Projection::perspective && !d.is_none()) {
    return fmt::format("a distortion of the projection '{}'; only perspective cameras have one",
                       name);
  }
  if (camera.projection != Projection::perspective && camera.lens_radius > 0.0) {
    return fmt::format(
        "a lens of radius {} m with the projection '{}'; only perspective cameras have a lens, all "
        "others show everything sharp",
        camera.lens_radius, name);
  }
  const double widest = named(camera.projection).widest;
  if (camera.circle_degrees == 0.0) return {};
  if (!is_fisheye(camera.projection)) {
    return fmt::format("a circle of the projection '{}'; only fisheyes have one", name);
  }
  if (camera.circle_degrees > 0.0 && camera.circle_degrees <= widest) return {};
  return fmt::format(
      "a circle of {} degrees; the projection '{}' shows angles above 0 and up to {}",
      camera.circle_degrees, name, widest);
}

std::string stereo_fault(const Camera& camera) {
  if (!(camera.eye_separation >= 0.0 && camera.eye_separation <= farthest_coordinate)) {
    return fmt::format("eyes {} m apart; the distance must lie between 0 and {:g} m",
                       camera.eye_separation, farthest_coordinate);
  }
  if (camera.height % 2 == 0) return {};
  return fmt::format("a picture {} pixels high for two eyes; give an even number", camera.height);
}

std::string shape_fault(const Camera& camera) {
  if (camera.projection == Projection::cube_map) {
    if (camera.width % 3 == 0 && 2 * camera.width == 3 * camera.height) return {};
    return fmt::format(
        "{} x {} pixels for a cube; three faces lie beside each other and two above each other, so "
        "give {} x {}",
        camera.width, camera.height, 3 * std::max(1, camera.width / 3),
        2 * std::max(1, camera.width / 3));
  }
  const bool is_stereo = camera.projection == Projection::stereo_panorama;
  if (!is_stereo && camera.projection != Projection::equirectangular) return {};
  const double per_eye = is_stereo ? 0.5 : 1.0;
  const double whole_width = camera.width / camera.window.width();
  const double whole_height = per_eye * camera.height / camera.window.height();
  const double vertical = camera.fov_degrees * whole_height / whole_width;
  if (vertical <= 180.0 * (1.0 + edge_rounding)) return {};
  return fmt::format(
      "a picture of {:g} x {:g} pixels that is {:g} degrees wide and {:.6g} high{}, where there "
      "are "
      "180; give at most {:g} x {:g}",
      whole_width, whole_height / per_eye, camera.fov_degrees, vertical,
      is_stereo ? " for each eye" : "", whole_width,
      std::floor(whole_width * 180.0 / camera.fov_degrees / per_eye));
}

}  // namespace

const NamedProjection& named(Projection projection) {
  return *std::ranges::find(named_projections, projection, &NamedProjection::projection);
}

std::optional<Projection> projection_named(std::string_view name) {
  const auto found = std::ranges::find(named_projections, name, &NamedProjection::name);
  if (found == named_projections.end()) return std::nullopt;
  return found->projection;
}

bool is_fisheye(Projection projection) {
  return projection == Projection::equidistant || projection == Projection::equisolid ||
         projection == Projection::hemispherical || projection == Projection::stereographic;
}

bool is_flat(Projection projection) {
  return projection == Projection::perspective || projection == Projection::orthographic;
}

bool is_panorama(Projection projection) {
  return projection == Projection::cylindrical || projection == Projection::equirectangular ||
         projection == Projection::stereo_panorama;
}

std::string projection_fault(const Camera& camera) {
  for (const auto fault :
       {angle_fault, range_fault, window_fault, shift_fault, lens_fault, shape_fault}) {
    if (std::string what = fault(camera); !what.empty()) return what;
  }
  return camera.projection == Projection::stereo_panorama ? stereo_fault(camera) : std::string();
}

void set_picture_size(int width, int height, Camera& camera) {
  const auto edges = [](double& low, double& high, int pixels) {
    const double first = std::clamp(std::round(low * pixels), 0.0, pixels - 1.0);
    const double end = std::clamp(std::round(high * pixels), first + 1.0, double(pixels));
    low = first / pixels;
    high = end / pixels;
    return static_cast<int>(end - first);
  };
  PictureWindow& w = camera.window;
  camera.width = edges(w.left, w.right, width);
  camera.height = edges(w.top, w.bottom, height);
}

Camera resized(const Camera& camera, int width) {
  Camera result = camera;
  const auto rounded = [](double count) {
    return static_cast<int>(std::lround(std::clamp(count, 1.0, double{max_picture_edge})));
  };
  if (camera.projection == Projection::cube_map) {
    const int face = std::max(1, rounded(width / 3.0));
    result.width = 3 * face;
    result.height = 2 * face;
    return result;
  }
  result.width = rounded(width);
  const double height = static_cast<double>(result.width) * camera.height / camera.width;
  const bool is_stereo = camera.projection == Projection::stereo_panorama;
  result.height = is_stereo ? std::max(2, 2 * rounded(0.5 * height)) : rounded(height);
  while (result.height > 2 && !shape_fault(result).empty()) result.height -= is_stereo ? 2 : 1;
  return result;
}

Camera with_projection(const Camera& camera, Projection projection) {
  Camera result = camera;
  result.projection = projection;
  if (projection != camera.projection) result.fov_degrees = named(projection).usual;
  if (projection != Projection::perspective) {
    result.distortion = {};
    result.lens_radius = 0.0;
    result.blades = 0;
  }
  if (!shift_fault(result).empty()) result.shift.setZero();
  if (!window_fault(result).empty()) result.window = {};
  if (!is_fisheye(projection) || projection != camera.projection) result.circle_degrees = 0.0;
  if (is_flat(projection) || projection == camera.projection) return result;
  if (is_fisheye(projection)) {
    result.width = result.height = std::min(camera.width, camera.height);
  } else if (projection == Projection::equirectangular) {
    result.width = std::max(2, camera.width);
    result.height = result.width / 2;
  } else if (projection == Projection::stereo_panorama) {
    result.width = result.height = std::max(2, camera.width / 2 * 2);
  } else if (projection == Projection::cube_map) {
    result = resized(result, camera.width);
  }
  return result;
}

namespace {

// The whole picture that the camera's window is a part of.
Camera without_window(const Camera& camera) {
  Camera whole = camera;
  whole.width = std::max(1, static_cast<int>(std::lround(camera.width / camera.window.width())));
  whole.height = std::max(1, static_cast<int>(std::lround(camera.height / camera.window.height())));
  whole.window = {};
  return whole;
}

}  // namespace

Camera as_perspective(const Camera& camera) {
  constexpr double widest = 90.0;
  Camera result = without_window(with_projection(camera, Projection::perspective));
  result.distortion = {};
  if (camera.projection != Projection::perspective) {
    result.shift.setZero();
    result.fov_degrees = std::min(widest, camera.fov_degrees);
  }
  return result;
}

Camera for_window(const Camera& camera) {
  if (camera.projection != Projection::orthographic) return as_perspective(camera);
  return without_window(camera);
}

std::string loss_in_window(const Camera& camera) {
  if (!is_flat(camera.projection)) return "Cameras of other projections are shown as perspectives";
  if (!camera.distortion.is_none()) return "Cameras are shown without their distortion";
  return is_whole(camera.window) ? "" : "Cameras are shown without their window";
}

}  // namespace lightwell
