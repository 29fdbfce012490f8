#include "scene/io/radiance/radiance_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

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

// Sets the picture's size: as wide or as high as allowed, with square pixels.
void set_size(const RadianceView& view, double half_width, double half_height, Camera& camera) {
  const double aspect = half_height / half_width;
  const double width = std::min(view.width, view.height / aspect);
  // Angles near 0 and 180 degrees have aspects that are no numbers.
  const auto pixels = [](double count) {
    return count >= 1.0 ? static_cast<int>(std::lround(std::min<double>(count, max_picture_edge)))
                        : 1;
  };
  camera.width = pixels(width);
  camera.height = pixels(width * aspect);
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
  if (view.type != 'v') {
    remarks.add("Views that are no perspectives (-vtv) were left out", name);
    return;
  }
  const auto fail = [&](const std::string& what) {
    location.fail(fmt::format("the view '{}' {}", name, what));
  };
  for (const double angle : {view.horizontal, view.vertical}) {
    if (!(angle > 0.0 && angle < 180.0)) {
      fail(fmt::format("spans {} degrees; -vh and -vv must lie between 0 and 180", angle));
    }
  }
  if (!(std::min(view.width, view.height) >= 1.0 &&
        std::max(view.width, view.height) <= max_picture_edge)) {
    fail(fmt::format("has a picture of {} x {} pixels; give from 1 to {}", view.width, view.height,
                     max_picture_edge));
  }
  if (view.shift != 0.0 || view.lift != 0.0) {
    remarks.add("Views off their axis (-vs, -vl) were read as if on it", name);
  }
  if (view.fore > 0.0 || view.aft > 0.0) {
    remarks.add("Clipping planes of views (-vo, -va) have no effect", name);
  }
  Camera camera{.name = camera_name(name, scene), .fov_degrees = view.horizontal};
  Eigen::Affine3d to_world(Eigen::Translation3d(view.point));
  to_world.linear().col(1) = view.up;
  to_world.linear().col(2) = view.direction;
  to_world.linear().col(0) = view.up.cross(view.direction);
  if (!place_camera(to_world, Eigen::Vector3d::UnitZ(), camera, remarks)) {
    fail("looks along its upright or nowhere; change -vd or -vu");
  }
  set_size(view, std::tan(0.5 * view.horizontal * degree), std::tan(0.5 * view.vertical * degree),
           camera);
  scene.cameras.push_back(camera);
}

}  // namespace lightwell
