#include "scene/io/obj/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "scene/io/non_finite.h"

namespace lightwell {
namespace {

// Numbers names in the order of their first use.
class Numbering {
 public:
  int of(const std::string& name, std::vector<std::string>& names) {
    const auto [entry, is_new] = numbers_.emplace(name, static_cast<int>(names.size()));
    if (is_new) names.push_back(name);
    return entry->second;
  }

 private:
  std::unordered_map<std::string, int> numbers_;
};

class ObjParser {
 public:
  ObjParser(const TextFile& file, double metres_per_unit)
      : file_(file), metres_per_unit_(metres_per_unit) {}

  ObjContent parse() {
    std::string continued;
    int first_line = 0;
    file_.for_each_line([&](int line, std::string_view text) {
      if (continued.empty()) first_line = line;
      if (trimmed(text).ends_with('\\')) {
        const std::string_view part = trimmed(text);
        continued.append(part.substr(0, part.size() - 1)).append(" ");
        return;
      }
      line_ = first_line;
      if (continued.empty()) return read_line(text);
      continued += text;
      read_line(continued);
      continued.clear();
    });
    if (!continued.empty()) {
      line_ = first_line;
      read_line(continued);
    }
    check_indices();
    return std::move(content_);
  }

 private:
  void read_line(std::string_view text) {
    const std::string_view key = next_word(text);
    if (key == "v") {
      read_vertex(text);
    } else if (key == "vt") {
      read_uv(text);
    } else if (key == "vn") {
      read_normal(text);
    } else if (key == "f") {
      read_face(text);
    } else if (key == "o") {
      object_ = trimmed(text);
      in_group_ = false;
    } else if (key == "g") {
      group_ = trimmed(text);
      in_group_ = true;
    } else if (key == "usemtl") {
      material_ = materials_.of(std::string(trimmed(text)), content_.material_names);
    } else if (key == "mtllib") {
      content_.material_files.emplace_back(trimmed(text));
    } else if (key == "curv" || key == "curv2" || key == "surf") {
      ++content_.free_form;
    }
    if (key == "o" || key == "g") current_group_ = -1;
  }

  // Programs write "nan" for vertices that they could not compute, in files that are otherwise
  // whole. Other words show that the file is damaged or no OBJ file.
  void read_vertex(std::string_view text) {
    const auto number = static_cast<int>(content_.vertices.size());
    Eigen::Vector3d p;
    for (double& x : p) {
      const std::string_view word = next_word(text);
      const auto value = parse_finite(word);
      if (!value && !names_non_finite(word)) {
        file_.fail(line_, word.empty() ? std::string("a vertex needs three coordinates")
                                       : fmt::format("coordinate '{}' is not a finite number",
                                                     excerpt(word)));
      }
      if (!value) content_.placeless.emplace(number, PlacelessVertex{line_, excerpt(word)});
      x = value.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    content_.vertices.push_back(metres_per_unit_ * p);
  }

  // A malformed number does not make the file unreadable: facets that use the entry have no texture
  // coordinates.
  void read_uv(std::string_view text) {
    const auto u = parse_finite(next_word(text)), v = parse_finite(next_word(text));
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    content_.uv.emplace_back(u.value_or(none), u ? 1.0 - v.value_or(0.0) : none);
  }

  // A malformed normal is stored as zero, for the same reason as malformed texture coordinates.
  void read_normal(std::string_view text) {
    const auto x = parse_finite(next_word(text)), y = parse_finite(next_word(text)),
               z = parse_finite(next_word(text));
    const bool is_whole = x && y && z;
    content_.normals.push_back(is_whole ? Eigen::Vector3d(*x, *y, *z) : Eigen::Vector3d::Zero());
  }

  void read_face(std::string_view text) {
    ObjFace face{.line = line_,
                 .group = current_group(),
                 .material = material_,
                 .first = content_.corners.size()};
    for (auto word = next_word(text); !word.empty() && word.front() != '#';
         word = next_word(text)) {
      long index = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
      if (error != std::errc() || (end != word.data() + word.size() && *end != '/')) {
        file_.fail(line_, fmt::format("'{}' is not a vertex index", excerpt(word)));
      }
      // OBJ indices count from 1, or backwards from the latest vertex.
      const long vertex =
          index < 0 ? static_cast<long>(content_.vertices.size()) + index : index - 1;
      if (vertex < 0 || vertex > std::numeric_limits<int>::max()) {
        file_.fail(line_,
                   fmt::format("vertex index {} is out of range; there are {} vertices before "
                               "this line",
                               index, content_.vertices.size()));
      }
      content_.corners.push_back(static_cast<int>(vertex));
      if (!content_.normals.empty()) {
        content_.corner_normals.resize(content_.corners.size() - 1, -1);
        content_.corner_normals.push_back(normal_of(word));
      }
      if (!content_.uv.empty()) {
        content_.corner_uv.resize(content_.corners.size() - 1, -1);
        content_.corner_uv.push_back(uv_of(word));
      }
    }
    face.count = content_.corners.size() - face.first;
    content_.faces.push_back(face);
  }

  // The last number of "vertex/texture/normal"; -1 if missing or out of range.
  int normal_of(std::string_view corner) const {
    const std::size_t slash = corner.rfind('/');
    if (slash == corner.find('/')) return -1;
    return index_within(corner.substr(slash + 1), content_.normals.size());
  }

  // The middle number of "vertex/texture/normal"; -1 if missing or out of range.
  int uv_of(std::string_view corner) const {
    const std::size_t slash = corner.find('/');
    if (slash == std::string_view::npos) return -1;
    return index_within(corner.substr(slash + 1), content_.uv.size());
  }

  // Zero-based index of an OBJ index, which counts from 1 or backwards from the latest.
  static int index_within(std::string_view word, std::size_t size) {
    long index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const auto count = static_cast<long>(size);
    const long place = index < 0 ? count + index : index - 1;
    const bool is_known = error == std::errc() && place >= 0 && place < count;
    return is_known ? static_cast<int>(place) : -1;
  }

  // Checked after reading, because a file may list its faces before its vertices.
  void check_indices() const {
    for (const ObjFace& face : content_.faces) {
      for (std::size_t i = 0; i < face.count; ++i) {
        const int vertex = content_.corners[face.first + i];
        if (vertex >= static_cast<int>(content_.vertices.size())) {
          file_.fail(face.line,
                     fmt::format("vertex index {} is out of range; the file has {} vertices",
                                 std::int64_t{vertex} + 1, content_.vertices.size()));
        }
      }
    }
  }

  // A "g" after an "o" divides the object; without an "o" the name is the group's alone.
  int current_group() {
    if (current_group_ < 0) {
      const std::string name = !in_group_ || group_.empty() ? object_
                               : object_.empty() || object_ == group_
                                   ? group_
                                   : fmt::format("{}/{}", object_, group_);
      current_group_ =
          groups_.of(name.empty() ? file_.path().stem().string() : name, content_.groups);
    }
    return current_group_;
  }

  const TextFile& file_;
  double metres_per_unit_;
  int line_ = 0;
  std::string object_, group_;
  bool in_group_ = false;
  int current_group_ = -1, material_ = -1;
  Numbering groups_, materials_;
  ObjContent content_;
};

}  // namespace

std::string_view without_quotes(std::string_view name) {
  const bool is_quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  return is_quoted ? name.substr(1, name.size() - 2) : name;
}

ObjContent read_obj_content(const TextFile& file, double metres_per_unit) {
  return ObjParser(file, metres_per_unit).parse();
}

}  // namespace lightwell
