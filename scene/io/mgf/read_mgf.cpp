#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <vector>

#include "scene/errors.h"
#include "scene/io/corner_maps.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/mgf/mgf_shapes.h"
#include "scene/io/mgf/mgf_state.h"
#include "scene/io/numbered_names.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/radiance/text/radiance_xform.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/round_facets.h"
#include "scene/io/scene_size.h"
#include "scene/io/text_file.h"
#include "scene/limits.h"
#include "scene/rotation_between.h"

namespace lightwell {
namespace {

constexpr int deepest_inclusion = 32;
constexpr std::size_t most_copies = 1'000'000;

using Words = std::vector<std::string>;
using Transforms = std::vector<Eigen::Affine3d>;

class MgfReader {
 public:
  explicit MgfReader(Scene& scene) : scene_(scene) {}

  void read(const std::filesystem::path& path) {
    if (++depth_ > deepest_inclusion) {
      throw LimitError(fmt::format("{}: files include each other more than {} deep", path.string(),
                                   deepest_inclusion));
    }
    const TextFile& file = files_.emplace_back(path);
    const RadianceLocation outer = location_;
    std::string joined;
    int first = 0;
    file.for_each_line([&](int line, std::string_view text) {
      if (joined.empty()) first = line;
      joined += text;
      if (joined.ends_with('\\')) {
        joined.back() = ' ';
        return;
      }
      location_ = {.file = &file.path(), .line = first};
      read_line(joined);
      joined.clear();
    });
    location_ = outer;
    --depth_;
  }

  void finish() {
    complete_surface();
    if (scene_.surfaces.empty()) {
      fail_without_surfaces(scene_.file, "the scene has no surfaces with an area", remarks_);
    }
    remarks_.report_to(scene_);
    note_repairs(repairs_, scene_);
  }

 private:
  void read_line(std::string_view text) {
    Words words;
    for (auto word = next_word(text); !word.empty(); word = next_word(text)) {
      words.emplace_back(word);
    }
    if (words.empty() || words[0].starts_with('#')) return;
    key_ = words[0];
    words.erase(words.begin());
    words_ = std::move(words);
    if (key_ == "o") return set_object();
    if (key_ == "xf") return set_transform();
    if (key_ == "i") return include();
    if (key_ == "c" || key_ == "m" || key_ == "v") return set_context();
    if (!set_color() && !set_material() && !set_vertex() && !add_shape()) {
      remarks_.add("Entities that are not understood were left out", excerpt(key_));
    }
  }

  void require(std::size_t least, std::size_t most) const {
    if (words_.size() >= least && words_.size() <= most) return;
    location_.fail(fmt::format("'{}' has {} arguments; it needs {}{}", key_, words_.size(), least,
                               most > least ? " or more" : ""));
  }

  double number(std::size_t i) const {
    const auto value = parse_finite(words_[i]);
    if (!value || std::abs(*value) > farthest_coordinate) {
      location_.fail(fmt::format("argument {} of '{}' is no number up to {:g}", i + 1, key_,
                                 farthest_coordinate));
    }
    return *value;
  }

  double positive(std::size_t i) const {
    const double value = number(i);
    if (!(value >= 0.0)) location_.fail(fmt::format("'{}' is below 0", key_));
    return value;
  }

  void set_object() {
    if (!words_.empty()) return objects_.push_back(shortened(words_[0]));
    if (objects_.empty()) location_.fail("'o' ends an object, but none is open");
    objects_.pop_back();
  }

  void set_transform() {
    if (!words_.empty()) return push_transform(words_);
    if (transforms_.size() == 1) location_.fail("'xf' ends a transformation, but none is open");
    transforms_.pop_back();
  }

  void push_transform(const Words& arguments) {
    const RadianceXform xform = parse_radiance_xform(arguments, location_);
    if (!xform.files.empty()) location_.fail("'xf' has an argument that is no transformation");
    if (transforms_.back().size() * xform.copies.size() > most_copies) {
      location_.fail_limit(fmt::format("arrays make more than {} copies", most_copies));
    }
    Transforms all;
    for (const Eigen::Affine3d& outer : transforms_.back()) {
      for (const auto& copy : xform.copies) all.push_back(outer * copy.to_world);
    }
    transforms_.push_back(std::move(all));
  }

  void include() {
    if (words_.empty()) location_.fail("'i' names no file");
    const auto path = location_.file->parent_path() / words_[0];
    const std::size_t depth = transforms_.size();
    if (words_.size() > 1) push_transform(Words(words_.begin() + 1, words_.end()));
    if (is_file(path)) {
      read(path);
    } else {
      remarks_.add("Included files are missing", path.string());
    }
    transforms_.resize(depth);
  }

  template <class Value>
  void set_context(MgfContext<Value>& context) {
    if (words_.empty()) return context.reset();
    const std::string name = words_[0];
    if (words_.size() == 1) {
      if (!context.use(name)) undefined(name);
    } else if (words_[1] != "=") {
      location_.fail(fmt::format("'{} {}' is followed by no '='", key_, excerpt(name)));
    } else if (words_.size() == 2) {
      context.define(name, Value());
    } else {
      const Value* from = context.find(words_[2]);
      if (!from) undefined(words_[2]);
      context.define(name, Value(*from));
    }
  }

  [[noreturn]] void undefined(const std::string& name) const {
    location_.fail(fmt::format("'{}' is not defined before this line", excerpt(name)));
  }

  void set_context() {
    if (key_ == "c") return set_context(colors_);
    if (key_ == "v") return set_context(vertices_);
    set_context(materials_);
    if (words_.size() > 1) materials_.current().number = -1;
  }

  // The functions below return false for an entity of another kind.

  bool set_color() {
    try {
      if (key_ == "cxy") {
        require(2, 2);
        if (!(number(1) > 0.0)) location_.fail("the chromaticity y must be above 0");
        colors_.current().color = mgf_chromaticity(number(0), number(1));
      } else if (key_ == "cct") {
        require(1, 1);
        if (!(number(0) > 0.0)) location_.fail("the temperature must be above 0");
        colors_.current().color = mgf_black_body(number(0));
      } else if (key_ == "cspec") {
        set_spectrum();
      } else if (key_ == "cmix") {
        mix_colors();
      } else {
        return false;
      }
    } catch (const LimitError&) {
      throw;
    } catch (const InputError& error) {
      const std::string fault = error.what();
      if (fault.starts_with(location_.file->string())) throw;
      location_.fail(fault);
    }
    return true;
  }

  void set_spectrum() {
    require(4, words_.size());
    if (!(number(0) > 0.0 && number(0) < number(1))) {
      location_.fail("the wavelengths of 'cspec' do not rise");
    }
    std::vector<double> values;
    for (std::size_t i = 2; i < words_.size(); ++i) values.push_back(positive(i));
    colors_.current().color = mgf_spectrum(number(0), number(1), values);
  }

  void mix_colors() {
    require(2, words_.size());
    if (words_.size() % 2 != 0) location_.fail("'cmix' needs a weight before every colour");
    MgfColor sum = MgfColor::Zero();
    for (std::size_t i = 0; i < words_.size(); i += 2) {
      const Color* color = colors_.find(words_[i + 1]);
      if (!color) undefined(words_[i + 1]);
      sum += positive(i) * color->color;
    }
    colors_.current().color = with_unit_luminance(sum);
  }

  Spectrum colored(double amount) { return (amount * colors_.current().color).cast<float>(); }

  bool set_material() {
    MgfMaterial& m = materials_.current();
    if (key_ == "sides" || key_ == "rd" || key_ == "td" || key_ == "ed") {
      require(1, 1);
      const double value = positive(0);
      if (key_ == "sides") m.is_two_sided = value != 1.0;
      if (key_ == "rd") m.diffuse = colored(value);
      if (key_ == "td") m.passed = colored(value);
      if (key_ == "ed") m.exitance = colored(value / scene_.bands.lumens_per_watt);
    } else if (key_ == "rs" || key_ == "ts") {
      require(2, 2);
      MgfMaterial::Lobe& lobe = key_ == "rs" ? m.mirror : m.straight;
      lobe.share = colored(positive(0));
      lobe.alpha = positive(1);
    } else if (key_ == "ir") {
      require(2, 2);
      m.index = positive(0);
      if (positive(1) > 0.0)
        remarks_.add("Imaginary parts of 'ir' were left out in", material_name());
    } else {
      return false;
    }
    m.number = -1;
    return true;
  }

  bool set_vertex() {
    if (key_ != "p" && key_ != "n") return false;
    require(3, 3);
    MgfVertex& v = vertices_.current();
    Eigen::Vector3d& set = key_ == "p" ? v.position : v.normal;
    set = {number(0), number(1), number(2)};
    return true;
  }

  const MgfVertex& vertex(std::size_t i) {
    const MgfVertex* found = vertices_.find(words_[i]);
    if (!found) undefined(words_[i]);
    return *found;
  }

  Eigen::Affine3d stand(const MgfVertex& at, const Eigen::Vector3d& axis) const {
    if (!(axis.stableNorm() > 0.0)) location_.fail(fmt::format("'{}' has no axis", key_));
    return Eigen::Translation3d(at.position) * rotation_between(Eigen::Vector3d::UnitZ(), axis);
  }

  bool add_shape() {
    if (key_ == "f" || key_ == "fh") {
      add_face();
    } else if (key_ == "sph") {
      require(2, 2);
      add_sphere(vertex(0), number(1));
    } else if (key_ == "cyl") {
      require(3, 3);
      add_cone(vertex(0), number(1), vertex(2), number(1));
    } else if (key_ == "cone") {
      require(4, 4);
      add_cone(vertex(0), number(1), vertex(2), number(3));
    } else if (key_ == "prism") {
      add_prism();
    } else if (key_ == "ring") {
      add_ring();
    } else if (key_ == "torus") {
      add_torus();
    } else {
      return false;
    }
    return true;
  }

  Loop corners(std::size_t first, std::size_t end, NormalLoop* normals = nullptr) {
    Loop loop;
    for (std::size_t i = first; i < end; ++i) {
      loop.push_back(vertex(i).position);
      if (normals) normals->push_back(vertex(i).normal);
    }
    return loop;
  }

  void count(std::int64_t triangles) {
    const auto copies = static_cast<std::int64_t>(transforms_.back().size());
    size_.add(triangles * copies, [&](const std::string& sentence) {
      location_.fail_limit("'" + key_ + "' " + sentence);
    });
  }

  // Faces of one object and material become one surface.
  void add_face() {
    require(3, words_.size());
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i <= words_.size(); ++i) {
      if (i == words_.size() || (key_ == "fh" && words_[i] == "-")) ends.push_back(i);
    }
    NormalLoop normals;
    Polygon polygon{.boundary = corners(0, ends[0], &normals)};
    for (std::size_t h = 0; h + 1 < ends.size(); ++h) {
      polygon.holes.push_back(corners(ends[h] + 1, ends[h + 1]));
    }
    count(triangles_of(words_.size() + 4 * ends.size()));
    const bool is_smooth =
        std::ranges::all_of(normals, [](const Eigen::Vector3d& n) { return n.stableNorm() > 0.0; });
    if (!is_smooth) normals.clear();
    const int material = material_number();
    if (object_name() != stem_ || material != of_faces_) complete_surface();
    stem_ = object_name();
    of_faces_ = material;
    for (const Eigen::Affine3d& to_world : transforms_.back())
      add_placed(polygon, normals, to_world);
  }

  void add_placed(Polygon polygon, NormalLoop normals, const Eigen::Affine3d& to_world) {
    const bool is_mirrored = to_world.linear().determinant() < 0.0;
    const auto place = [&](Loop& loop) {
      for (Eigen::Vector3d& p : loop) p = to_world * p;
      if (is_mirrored) std::ranges::reverse(loop);
    };
    place(polygon.boundary);
    for (Loop& hole : polygon.holes) place(hole);
    const Eigen::Matrix3d turn = normal_transform(to_world);
    for (Eigen::Vector3d& n : normals) n = turn * n;
    if (is_mirrored) std::ranges::reverse(normals);
    if (!polygon.holes.empty() && fault(polygon).empty() &&
        deviation_from_plane(polygon) <= flatness) {
      return mesh_.add(polygon);
    }
    if (!polygon.holes.empty()) {
      remarks_.add("Holes of faces that are not plane were closed in", object_name());
    }
    add_repaired(mesh_, std::move(polygon.boundary), repairs_, {}, std::move(normals));
  }

  void add_sphere(const MgfVertex& at, double radius) {
    if (radius == 0.0) return remark_no_area();
    if (radius < 0.0) {
      return add_loops(mgf_bubble(), Eigen::Translation3d(at.position) * Eigen::Scaling(-radius));
    }
    const Sphere sphere{.center = at.position, .radius = radius};
    add_copies([&](const Eigen::Affine3d& to_world) {
      const double scale = to_world.linear().col(0).norm();  // the same in all directions
      return Sphere{.center = to_world * sphere.center, .radius = scale * sphere.radius};
    });
  }

  void add_round(const Frustum& frustum) {
    add_copies([&](const Eigen::Affine3d& to_world) { return placed_frustum(frustum, to_world); });
  }

  /// Adds placed(to_world) as a surface for each transformation in force.
  template <class Placed>
  void add_copies(const Placed& placed) {
    count(1);
    complete_surface();
    const int material = material_number();
    for (const Eigen::Affine3d& to_world : transforms_.back()) {
      scene_.surfaces.push_back(
          {.name = names_.unique(object_name()), .material = material, .shape = placed(to_world)});
    }
  }

  void add_cone(const MgfVertex& from, double radius, const MgfVertex& to, double top) {
    if (radius * top < 0.0) location_.fail(fmt::format("'{}' has radii of different signs", key_));
    const Eigen::Vector3d axis = to.position - from.position;
    if ((radius == 0.0 && top == 0.0) || !(axis.stableNorm() > 0.0)) return remark_no_area();
    add_round(frustum_about(from.position, axis, axis.stableNorm(), std::abs(radius), std::abs(top),
                            radius < 0.0 || top < 0.0));
  }

  void add_ring() {
    require(3, 3);
    const double inner = positive(1), outer = positive(2);
    if (!(outer - inner > flatness * outer)) return remark_no_area();
    add_round(frustum_about(vertex(0).position, vertex(0).normal, 0.0, outer, inner, false));
  }

  void add_torus() {
    require(3, 3);
    const double inner = std::abs(number(1)), outer = std::abs(number(2));
    if (!(outer - inner > flatness * outer)) return remark_no_area();
    add_loops(mgf_torus(inner, outer, number(2) < 0.0), stand(vertex(0), vertex(0).normal));
  }

  void add_prism() {
    require(4, words_.size());
    const std::size_t sides = words_.size() - 1;
    const auto shape = mgf_prism(corners(0, sides), number(sides));
    if (!shape) return remark_no_area();
    add_loops(*shape, Eigen::Affine3d::Identity());
  }

  void add_loops(const MgfShape& shape, const Eigen::Affine3d& placed) {
    count(triangles_of(shape.loops));
    complete_surface();
    const int material = material_number();
    if (!shape.normals.empty()) {
      remarks_.add(
          "Round shapes were read as facets of the same area with the normals of round ones",
          object_name());
    }
    for (const Eigen::Affine3d& to_world : transforms_.back()) {
      PolygonMesh mesh = placed_loops(shape.loops, to_world * placed, shape.is_inward, repairs_, {},
                                      shape.normals);
      if (mesh.facets.empty()) {
        remark_no_area();
        continue;
      }
      scene_.surfaces.push_back(
          {.name = names_.unique(object_name()), .material = material, .shape = std::move(mesh)});
    }
  }

  void remark_no_area() { remarks_.add("Shapes without area were left out", object_name()); }

  void complete_surface() {
    if (!mesh_.empty()) {
      scene_.surfaces.push_back(
          {.name = names_.unique(stem_), .material = of_faces_, .shape = mesh_.mesh()});
    }
    mesh_ = {};
    of_faces_ = -1;
  }

  std::string object_name() const {
    std::string name;
    for (const std::string& object : objects_) name += (name.empty() ? "" : ".") + object;
    return shortened(name.empty() ? "surface" : name);
  }

  std::string material_name() const {
    return materials_.name().empty() ? "unnamed" : materials_.name();
  }

  int material_number() {
    MgfMaterial& current = materials_.current();
    if (current.number < 0) {
      current.number = static_cast<int>(scene_.materials.size());
      scene_.materials.push_back(
          mgf_material(current, material_names_.unique(material_name()), remarks_));
    }
    return current.number;
  }

  struct Color {
    MgfColor color = MgfColor::Ones();
  };

  Scene& scene_;
  Remarks remarks_;
  Repairs repairs_;
  SceneSize size_;
  NumberedNames names_, material_names_;
  std::deque<TextFile> files_{};
  RadianceLocation location_{};
  int depth_ = 0;
  std::string key_{};
  Words words_{};
  MgfContext<Color> colors_;
  MgfContext<MgfMaterial> materials_;
  MgfContext<MgfVertex> vertices_;
  std::vector<std::string> objects_{};
  std::vector<Transforms> transforms_ = {{Eigen::Affine3d::Identity()}};
  // The surface to which further faces may be added.
  std::string stem_{};
  int of_faces_ = -1;
  MeshBuilder mesh_;
};

}  // namespace

Scene read_mgf(const std::filesystem::path& path) {
  Scene scene{.file = path, .title = path.stem().string()};
  MgfReader reader(scene);
  reader.read(path);
  reader.finish();
  note_if_dark(scene);
  validate(scene);
  return scene;
}

}  // namespace lightwell
