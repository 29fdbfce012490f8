#include "scene/io/radiance/radiance_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "scene/degree.h"
#include "scene/io/camera_name.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

class OptionReader {
 public:
  OptionReader(std::span<const std::string> words, const RadianceLocation& location,
               RadianceView& view)
      : words_(words), location_(location), view_(view) {}

  void read() {
    while (next_ < words_.size()) option(words_[next_++]);
  }

 private:
  void option(const std::string& word) {
    if (word.size() == 4 && word.starts_with("-vt")) view_.type = word[3];
    if (word == "-vp") view_.point = vector(word);
    if (word == "-vd") view_.direction = vector(word);
    if (word == "-vu") view_.up = vector(word);
    if (word == "-vh") view_.horizontal = number(word);
    if (word == "-vv") view_.vertical = number(word);
    if (word == "-vo") view_.fore = number(word);
    if (word == "-va") view_.aft = number(word);
    if (word == "-vs") view_.shift = number(word);
    if (word == "-vl") view_.lift = number(word);
    if (word == "-x") view_.width = number(word);
    if (word == "-y") view_.height = number(word);
  }

  double number(const std::string& option) {
    const auto value = next_ < words_.size() ? parse_finite(words_[next_]) : std::nullopt;
    if (!value) location_.fail(fmt::format("the view's option '{}' lacks a number", option));
    ++next_;
    return *value;
  }

  Eigen::Vector3d vector(const std::string& option) {
    const double x = number(option), y = number(option), z = number(option);
    return {x, y, z};
  }

  std::span<const std::string> words_;
  const RadianceLocation& location_;
  RadianceView& view_;
  std::size_t next_ = 0;
};

bool begins_a_view(std::string_view word) {
  const std::size_t slash = word.rfind('/');
  if (slash != std::string_view::npos) word.remove_prefix(slash + 1);
  constexpr std::array<std::string_view, 6> beginnings = {"VIEW=", "rpict",  "rview",
                                                          "rvu",   "rpiece", "pinterp"};
  return std::ranges::any_of(beginnings, [&](auto b) { return word.starts_with(b); });
}

// RADIANCE's letters of view types. There is none of the other projections.
struct ViewType {
  char letter;
  Projection projection;
};
constexpr std::array<ViewType, 6> view_types = {{{'v', Projection::perspective},
                                                 {'l', Projection::orthographic},
                                                 {'a', Projection::equidistant},
                                                 {'h', Projection::hemispherical},
                                                 {'s', Projection::stereographic},
                                                 {'c', Projection::cylindrical}}};

// Length of a side of a view's picture in the plane of its projection. `span` is the angle of the
// side in degrees, or the width of a parallel view. angle_of() is the inverse.
double plane_length(Projection projection, double span, bool is_height) {
  const double angle = span * degree;
  if (projection == Projection::cylindrical && is_height) return 2.0 * std::tan(0.5 * angle);
  switch (projection) {
    case Projection::orthographic:
      return span;
    case Projection::equidistant:
    case Projection::cylindrical:
      return angle;
    case Projection::hemispherical:
      return 2.0 * std::sin(0.5 * angle);
    case Projection::stereographic:
      return 4.0 * std::tan(0.25 * angle);
    default:
      return 2.0 * std::tan(0.5 * angle);
  }
}

double span_of(Projection projection, double length, bool is_height) {
  if (projection == Projection::cylindrical && is_height)
    return 2.0 * std::atan(0.5 * length) / degree;
  switch (projection) {
    case Projection::orthographic:
      return length;
    case Projection::equidistant:
    case Projection::cylindrical:
      return length / degree;
    case Projection::hemispherical:
      return 2.0 * std::asin(std::min(1.0, 0.5 * length)) / degree;
    case Projection::stereographic:
      return 4.0 * std::atan(0.25 * length) / degree;
    default:
      return 2.0 * std::atan(0.5 * length) / degree;
  }
}

// Returns what is wrong with the spans of a view; empty: nothing.
std::string span_fault(const RadianceView& view, Projection projection) {
  if (projection == Projection::orthographic) {
    const bool is_sound = view.horizontal > 0.0 && view.vertical > 0.0;
    return is_sound ? "" : "is not wide or not high; -vh and -vv must be above 0";
  }
  const double widest = named(projection).widest;
  const bool is_open =
      projection == Projection::perspective || projection == Projection::stereographic;
  const auto is_sound = [&](double angle, double most, bool below) {
    return angle > 0.0 && (angle < most || (angle == most && !below));
  };
  const bool is_cylinder = projection == Projection::cylindrical;
  const double highest = is_cylinder ? 180.0 : widest;
  for (const auto& [angle, most, below] : {std::tuple{view.horizontal, widest, is_open},
                                           {view.vertical, highest, is_open || is_cylinder}}) {
    if (is_sound(angle, most, below)) continue;
    return fmt::format("spans {} degrees; -vh and -vv must lie between 0 and {}", angle, most);
  }
  return {};
}

// Sets the picture's size: as wide or as high as allowed, with square pixels.
void set_size(const RadianceView& view, Camera& camera) {
  const double aspect = plane_length(camera.projection, view.vertical, true) /
                        plane_length(camera.projection, view.horizontal, false);
  const double width = std::min(view.width, view.height / aspect);
  // Angles near 0 and 180 degrees have aspects that are no numbers.
  const auto pixels = [](double count) {
    return count >= 1.0 ? static_cast<int>(std::lround(std::min<double>(count, max_picture_edge)))
                        : 1;
  };
  camera.width = pixels(width);
  camera.height = pixels(width * aspect);
}

// Sets the projection, angles, shift and range.
void set_projection(const RadianceView& view, Projection projection, Camera& camera) {
  camera.projection = projection;
  if (projection == Projection::orthographic) {
    camera.view_width = view.horizontal;
  } else {
    camera.fov_degrees = view.horizontal;
  }
  camera.shift = {view.shift, view.lift};
  if (is_fisheye(projection)) {
    // A shifted view is often a piece of a larger picture, which goes on beyond its angles.
    camera.circle_degrees = camera.shift.isZero(0.0) ? std::max(view.horizontal, view.vertical)
                                                     : named(projection).widest;
  }
  if (view.fore > 0.0) camera.near_distance = view.fore;
  if (view.aft > 0.0) camera.far_distance = view.aft;
  set_size(view, camera);
}

}  // namespace

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (auto word = next_word(text); !word.empty(); word = next_word(text)) words.emplace_back(word);
  return words;
}

void apply_view_options(std::span<const std::string> words, const RadianceLocation& location,
                        RadianceView& view) {
  OptionReader(words, location, view).read();
}

std::vector<RadianceView> read_radiance_views(const TextFile& file, RadianceView view) {
  std::vector<RadianceView> views;
  file.for_each_line([&](int line, std::string_view text) {
    const std::vector<std::string> words = words_of(text);
    if (words.empty() || !begins_a_view(words.front())) return;
    apply_view_options(words, {&file.path(), line}, view);
    view.line = line;
    views.push_back(view);
  });
  return views;
}

void add_radiance_camera(const RadianceView& view, const std::string& name,
                         const RadianceLocation& location, Scene& scene, Remarks& remarks) {
  const auto fail = [&](const std::string& what) {
    location.fail(fmt::format("the view '{}' {}", name, what));
  };
  const auto* const type = std::ranges::find(view_types, view.type, &ViewType::letter);
  if (type == view_types.end()) {
    fail(fmt::format("is of the unknown type '-vt{}'; write -vtv, -vtl, -vta, -vth, -vts or -vtc",
                     view.type));
    return;
  }
  if (const std::string what = span_fault(view, type->projection); !what.empty()) fail(what);
  if (!(std::min(view.width, view.height) >= 1.0 &&
        std::max(view.width, view.height) <= max_picture_edge)) {
    fail(fmt::format("has a picture of {} x {} pixels; give from 1 to {}", view.width, view.height,
                     max_picture_edge));
  }
  Camera camera{.name = camera_name(name, scene)};
  Eigen::Affine3d to_world(Eigen::Translation3d(view.point));
  to_world.linear().col(1) = view.up;
  to_world.linear().col(2) = view.direction;
  to_world.linear().col(0) = view.up.cross(view.direction);
  if (!place_camera(to_world, Eigen::Vector3d::UnitZ(), camera, remarks)) {
    fail("looks along its upright or nowhere; change -vd or -vu");
  }
  set_projection(view, type->projection, camera);
  if (const std::string what = projection_fault(camera); !what.empty()) fail("has " + what);
  scene.cameras.push_back(camera);
}

std::string radiance_view_options(const Camera& camera, double metres_per_unit) {
  const Projection projection = camera.projection;
  const auto* const type = std::ranges::find(view_types, projection, &ViewType::projection);
  if (type == view_types.end() || !camera.distortion.is_none()) return {};
  const bool is_parallel = projection == Projection::orthographic;
  const PictureWindow& part = camera.window;
  // The width on the plane of the part that is rendered, and the offset of its middle.
  const double whole = is_parallel ? camera.view_width / metres_per_unit
                                   : plane_length(projection, camera.fov_degrees, false);
  const double width = whole * part.width();
  const double height = width * camera.height / camera.width;
  const double shift = (0.5 * (part.left + part.right) - 0.5 + camera.shift.x()) / part.width();
  const double lift = (0.5 - 0.5 * (part.top + part.bottom) + camera.shift.y()) / part.height();
  const Eigen::Vector3d at = camera.position / metres_per_unit;
  const Eigen::Vector3d &d = camera.direction, &up = camera.up;
  const double far_limit =
      std::isfinite(camera.far_distance) ? camera.far_distance / metres_per_unit : 0.0;
  return fmt::format(
      "-vt{} -vp {:.9g} {:.9g} {:.9g} -vd {:.9g} {:.9g} {:.9g} -vu {:.9g} {:.9g} {:.9g} -vh {:.9g} "
      "-vv {:.9g} -vo {:.9g} -va {:.9g} -vs {:.9g} -vl {:.9g}",
      type->letter, at.x(), at.y(), at.z(), d.x(), d.y(), d.z(), up.x(), up.y(), up.z(),
      span_of(projection, width, false), span_of(projection, height, true),
      camera.near_distance / metres_per_unit, far_limit, shift, lift);
}

}  // namespace lightwell
