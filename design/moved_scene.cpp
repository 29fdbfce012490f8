#include "design/moved_scene.h"

#include <fmt/format.h>

#include <algorithm>
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

  void replace(const toml::node& node, std::string with) {
    const toml::source_region& at = node.source();
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
    edited.replace(node, quoted(file.lexically_relative(named.after).generic_string()));
  }
}

// A coordinate in the unit of the file, without rounding of the unit.
std::string coordinate(double metres, double metres_per_unit) {
  std::string text = fmt::format("{:.6f}", metres / metres_per_unit);
  text.erase(text.find_last_not_of('0') + 1);
  return text + (text.back() == '.' ? "0" : "");
}

void place_lamps(const Scene& scene, const toml::array& lamps, EditedText& edited) {
  for (std::size_t i = 0; i < std::min(lamps.size(), scene.lamps.size()); ++i) {
    const auto* table = lamps[i].as_table();
    const toml::array* position = table ? (*table)["position"].as_array() : nullptr;
    if (!position) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const toml::node* value = position->get(static_cast<std::size_t>(axis));
      const auto given = value ? value->value<double>() : std::nullopt;
      const double place = scene.lamps[i].position[axis];
      if (!given || scene.metres_per_unit * *given == place) continue;
      edited.replace(*value, coordinate(place, scene.metres_per_unit));
    }
  }
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
  if (const auto* lamps = document["lamps"].as_array()) place_lamps(scene, *lamps, edited);
  return edited.text();
}

}  // namespace lightwell
