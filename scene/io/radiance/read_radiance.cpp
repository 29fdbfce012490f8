#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "scene/errors.h"
#include "scene/io/radiance/files/radiance_loader.h"
#include "scene/io/radiance/files/radiance_project.h"
#include "scene/io/radiance/radiance_shapes.h"
#include "scene/io/radiance/radiance_view.h"
#include "scene/io/radiance/text/radiance_bands.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"

namespace lightwell {
namespace {

const char* const unusable_views = "Views that cannot be used were left out";

class RadianceReader {
 public:
  explicit RadianceReader(const std::filesystem::path& path)
      : path_(path), loader_(path.parent_path(), remarks_), shapes_(scene_, remarks_) {
    scene_.file = path;
    scene_.title = path.stem().string();
    scene_.bands = radiance_bands();
    scene_.notes.emplace_back(
        "RADIANCE files name no unit of length: lengths were read as metres. One watt of white is "
        "179 lm.");
  }

  Scene read() {
    if (lower_extension(path_) == ".rif") {
      read_project();
    } else {
      loader_.read(path_, sink_);
      finish_shapes();
      read_views_beside();
    }
    remarks_.report_to(scene_);
    note_repairs(shapes_.repairs(), scene_);
    note_if_dark(scene_);
    validate(scene_);
    return std::move(scene_);
  }

 private:
  void finish_shapes(const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) {
    shapes_.finish(up);
    if (scene_.surfaces.empty()) {
      fail_without_surfaces(path_, "the scene has no surfaces that can be read", remarks_);
    }
  }

  void read_project() {
    const TextFile file(path_);
    const RadianceProject project(file);
    const auto scene_files = project.words("scene");
    if (scene_files.empty()) {
      throw InputError(
          fmt::format("{}: the variable 'scene' names no files{}", path_.string(),
                      project.values("OCTREE").empty()
                          ? ""
                          : "; an octree alone cannot be read, name what it was made from"));
    }
    for (const char* variable : {"materials", "scene", "illum"}) {
      for (const auto& [name, at] : project.words(variable)) {
        remarks_.attempt("Files and commands that cannot be read were left out", name,
                         [&] { loader_.read_named(name, at, sink_); });
      }
    }
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    for (const auto& [text, location] : project.values("UP")) up = up_axis(text, location);
    finish_shapes(up);
    read_views(project);
    constexpr std::array used = {"materials", "scene", "illum", "objects",
                                 "view",      "UP",    "ZONE",  "RESOLUTION"};
    for (const std::string& variable : project.given()) {
      if (std::ranges::find(used, variable) != used.end()) continue;
      remarks_.mention("Variables of the .rif that have no effect here", variable);
    }
  }

  // Reads the view file beside a .rad file: room.vf or room.vp beside room.rad.
  void read_views_beside() {
    for (const char* extension : {".vf", ".vp"}) {
      auto beside = path_;
      beside.replace_extension(extension);
      if (!is_file(beside)) continue;
      remarks_.attempt(unusable_views, beside.filename().string(), [&] { read_views_of(beside); });
    }
  }

  void read_views_of(const std::filesystem::path& file) {
    const auto views = read_radiance_views(TextFile(file), {});
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::string stem = file.stem().string();
      const std::string name = i == 0 ? stem : fmt::format("{} {}", stem, i + 1);
      add_radiance_camera(views[i], name, {&loader_.keep(file), views[i].line}, scene_, remarks_);
    }
    if (views.empty()) return;
    remarks_.mention("Views come from the file beside the scene", file.filename().string());
  }

  void read_views(const RadianceProject& project) {
    RadianceView defaults;
    for (const auto& [text, location] : project.values("UP")) defaults.up = up_axis(text, location);
    for (const auto& [text, location] : project.values("RESOLUTION")) {
      const std::vector<std::string> words = words_of(text);
      defaults.width = positive(words.front(), location);
      defaults.height = words.size() > 1 ? positive(words[1], location) : defaults.width;
    }
    auto views = project.values("view");
    // rad's default view.
    if (views.empty()) views.push_back({"X", {&loader_.keep(path_), 1}});
    for (const auto& [text, at] : views) {
      remarks_.attempt(unusable_views, text,
                       [&, words = words_of(text)] { add_view(project, defaults, words, at); });
    }
  }

  static Eigen::Vector3d up_axis(const std::string& text, const RadianceLocation& location) {
    const bool has_sign = text.starts_with('-') || text.starts_with('+');
    const std::string axis = text.substr(has_sign ? 1 : 0);
    const int letter = axis.size() == 1 ? std::toupper(static_cast<unsigned char>(axis[0])) : 0;
    if (letter < 'X' || letter > 'Z')
      location.fail(fmt::format("UP is '{}'; write X, Y or Z", text));
    return (text.starts_with('-') ? -1.0 : 1.0) * Eigen::Vector3d::Unit(letter - 'X');
  }

  static double positive(const std::string& word, const RadianceLocation& location) {
    const auto value = parse_finite(word);
    if (!value || !(*value > 0.0)) {
      location.fail(fmt::format("RESOLUTION has '{}'; give one or two numbers of pixels", word));
    }
    return *value;
  }

  void add_view(const RadianceProject& project, RadianceView view,
                const std::vector<std::string>& words, const RadianceLocation& location) {
    const bool is_named = !words.front().starts_with('-');
    const std::string name = is_named ? words.front() : "";
    if (is_named) set_standard_view(project, name, view);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] != "-vf" || i + 1 == words.size()) continue;
      const std::filesystem::path& file = loader_.keep(loader_.find(words[i + 1], location));
      const auto views = read_radiance_views(TextFile(file), view);
      if (views.empty()) {
        location.fail(fmt::format("the view file '{}' holds no view", file.string()));
      }
      view = views.back();  // programs append views to a file, so the last one is the latest
    }
    apply_view_options(words, location, view);
    add_radiance_camera(view, name, location, scene_, remarks_);
  }

  // Sets a standard view such as "X", "xYz" or "Zl". Letters select a side or corner of the zone,
  // from which the view is towards its middle; small letters mean the lower end. A last letter
  // gives the view's type.
  void set_standard_view(const RadianceProject& project, const std::string& name,
                         RadianceView& view) const {
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    std::size_t i = 0;
    for (int axis = 0; axis < 3 && i < name.size(); ++axis) {
      if (name[i] == 'X' + axis) side[axis] = 1.0;
      if (name[i] == 'x' + axis) side[axis] = -1.0;
      if (side[axis] != 0.0) ++i;
    }
    constexpr std::string_view types = "vlahsc";
    if (i + 1 == name.size() && types.find(name[i]) != std::string_view::npos)
      view.type = name[i++];
    if (i < name.size() || side.isZero()) {
      view.type = 'v';
      return;  // a name like any other
    }
    const auto [zone, is_interior] = zone_of(project);
    // A flat scene gets a least extent, so that views keep a distance from it.
    const Eigen::Vector3d size =
        (zone.high - zone.low).cwiseMax(0.01 * (zone.high - zone.low).norm());
    const bool is_fisheye = view.type == 'a' || view.type == 'h' || view.type == 's';
    if (is_fisheye || view.type == 'c') view.horizontal = is_fisheye ? 180.0 : 360.0;
    if (is_fisheye) view.vertical = 180.0;
    if (view.type == 'l') view.horizontal = view.vertical = size.norm();
    const double distance = is_interior ? 0.45 : 2.0;
    view.point = 0.5 * (zone.low + zone.high) + distance * side.cwiseProduct(size);
    view.direction = -side.cwiseProduct(size);
    if (view.direction.cross(view.up).norm() == 0.0) {  // straight up or down
      view.up = Eigen::Vector3d(view.up.y(), view.up.z(), view.up.x()).cwiseAbs();
    }
  }

  std::pair<Bounds, bool> zone_of(const RadianceProject& project) const {
    const auto values = project.values("ZONE");
    if (values.empty()) return {scene_bounds(scene_), false};
    const auto& [text, location] = values.back();
    const std::vector<std::string> words = words_of(text);
    Bounds zone{};
    bool is_sound = words.size() == 7;
    for (std::size_t axis = 0; is_sound && axis < 3; ++axis) {
      const auto low = parse_finite(words[1 + 2 * axis]), high = parse_finite(words[2 + 2 * axis]);
      is_sound = low && high && *low < *high;
      if (!is_sound) break;
      zone.low[static_cast<Eigen::Index>(axis)] = *low;
      zone.high[static_cast<Eigen::Index>(axis)] = *high;
    }
    if (!is_sound) location.fail(fmt::format("ZONE is '{}'; write 'I x0 x1 y0 y1 z0 z1'", text));
    return {zone, words[0].starts_with('I') || words[0].starts_with('i')};
  }

  const std::filesystem::path& path_;
  Scene scene_;
  Remarks remarks_;
  RadianceLoader loader_;
  RadianceShapes shapes_;
  RadianceSink sink_ = [this](const RadiancePrimitive& primitive) {
    remarks_.attempt("Primitives that cannot be used were left out", primitive.name,
                     [&] { shapes_.add(primitive); });
  };
};

}  // namespace

Scene read_radiance(const std::filesystem::path& path) {
  return RadianceReader(path).read();
}

}  // namespace lightwell
