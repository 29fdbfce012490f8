#include "design/moved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

/// A piece of a text, in bytes, and what replaces it.
struct Edit {
  std::size_t begin = 0, end = 0;
  std::string with{};
};

/// A TOML file whose values are replaced where they stand.
class EditedText {
 public:
  explicit EditedText(const std::string& text) : text_(text) {
    line_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') line_.push_back(i + 1);
    }
  }

  void replace(const toml::source_region& at, std::string with) {
    edits_.push_back({.begin = byte_of(at.begin), .end = byte_of(at.end), .with = std::move(with)});
  }

  std::string text() {
    std::ranges::sort(edits_, {}, &Edit::begin);
    std::string edited;
    std::size_t done = 0;
    for (const Edit& edit : edits_) {
      edited += text_.substr(done, edit.begin - done) + edit.with;
      done = edit.end;
    }
    return edited + text_.substr(done);
  }

 private:
  // Columns count characters of UTF-8, whose further bytes are 10xxxxxx.
  std::size_t byte_of(const toml::source_position& at) const {
    std::size_t byte = line_[at.line - 1];
    for (toml::source_index column = 1; column < at.column && byte < text_.size(); ++column) {
      do ++byte;
      while (byte < text_.size() && (static_cast<unsigned char>(text_[byte]) & 0xC0u) == 0x80u);
    }
    return byte;
  }

  const std::string& text_;
  std::vector<std::size_t> line_{};  // first byte of each
  std::vector<Edit> edits_{};
};

std::string quoted(const std::string& word) {
  std::string text = "\"";
  for (const char letter : word) {
    if (letter == '"' || letter == '\\') text += '\\';
    text += letter;
  }
  return text + '"';
}

/// The files that a scene names, and the folders they are named from.
struct NamedFiles {
  std::set<fs::path> files{};  // canonical
  fs::path before{}, after{};  // folders
};

// Replaces all strings that are paths of the scene's files by paths from the new folder.
void name_anew(const toml::node& node, const NamedFiles& named, EditedText& edited) {
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) name_anew(value, named, edited);
  } else if (const auto* array = node.as_array()) {
    for (const toml::node& value : *array) name_anew(value, named, edited);
  } else if (const auto* word = node.as_string()) {
    const fs::path given(word->get());
    if (word->get().empty() || given.is_absolute()) return;
    const fs::path file = fs::weakly_canonical(named.before / given);
    if (!named.files.contains(file)) return;
    edited.replace(node.source(), quoted(file.lexically_relative(named.after).generic_string()));
  }
}

// A coordinate in the unit of the file, without rounding of the unit.
std::string coordinate(double metres, double metres_per_unit) {
  std::string text = fmt::format("{:.6f}", metres / metres_per_unit);
  text.erase(text.find_last_not_of('0') + 1);
  return text + (text.back() == '.' ? "0" : "");
}

// Gives a lamp that looks at a point the direction of before, as the reader has it: the point less
// the position, to the last bit.
void keep_direction(const toml::table& lamp, const std::array<double, 3>& position,
                    EditedText& edited) {
  for (const auto& [key, value] : lamp) {
    const auto* point = value.as_array();
    if (key.str() != "look_at" || !point) continue;
    std::array<double, 3> aim{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      aim[axis] = (*point)[axis].value_or(0.0) - position[axis];
    }
    edited.replace(key.source(), "aim");
    edited.replace(value.source(), fmt::format("[{}, {}, {}]", aim[0], aim[1], aim[2]));
  }
}

void place_lamp(const toml::table& table, const Lamp& lamp, double metres_per_unit,
                EditedText& edited) {
  const toml::array* position = table["position"].as_array();
  if (!position || position->size() != 3) return;
  std::array<double, 3> given{};
  bool is_moved = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    given[axis] = (*position)[axis].value_or(0.0);
    const double place = lamp.position[static_cast<Eigen::Index>(axis)];
    if (metres_per_unit * given[axis] == place) continue;
    edited.replace((*position)[axis].source(), coordinate(place, metres_per_unit));
    is_moved = true;
  }
  if (is_moved) keep_direction(table, given, edited);
}

}  // namespace

std::optional<std::string> moved_scene_text(const Scene& scene, const fs::path& folder) {
  if (lower_extension(scene.file) != ".toml") return std::nullopt;
  const TextFile file(scene.file);
  const toml::table document = parse_toml(file);
  EditedText edited(file.text());
  NamedFiles named{.before = fs::weakly_canonical(scene.file).parent_path(),
                   .after = fs::weakly_canonical(folder)};
  for (const fs::path& path : scene.files) named.files.insert(fs::weakly_canonical(path));
  name_anew(document, named, edited);
  if (const auto* lamps = document["lamps"].as_array()) {
    for (std::size_t i = 0; i < std::min(lamps->size(), scene.lamps.size()); ++i) {
      const auto* table = (*lamps)[i].as_table();
      if (table) place_lamp(*table, scene.lamps[i], scene.metres_per_unit, edited);
    }
  }
  return edited.text();
}

}  // namespace lightwell
