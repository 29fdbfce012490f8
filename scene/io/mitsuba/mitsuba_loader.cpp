#include "scene/io/mitsuba/mitsuba_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <pugixml.hpp>

#include "scene/errors.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr int deepest_element = 64;             // nested elements; real scenes stay below ten
constexpr std::size_t most_nested_scenes = 16;  // files
constexpr int most_files = 1000;
constexpr std::size_t longest = 1 << 16;  // bytes of an attribute with a $name

// Converts names of Mitsuba 0.6 ("toWorld", "intIOR") to those of 2 and 3 ("to_world", "int_ior").
std::string snake_case(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]))) {
      result += '_';
    }
    result += static_cast<char>(std::tolower(c));
  }
  return result;
}

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

}  // namespace

// An XML file during its conversion.
struct MitsubaLoader::Source {
  const std::filesystem::path* path = nullptr;
  pugi::xml_document document{};
  std::vector<std::ptrdiff_t> line_ends{};

  int line_at(std::ptrdiff_t offset) const {
    return 1 + static_cast<int>(std::ranges::lower_bound(line_ends, offset) - line_ends.begin());
  }
};

void MitsubaLoader::load(const std::filesystem::path& path) {
  tree_.root_ = load_file(path, nullptr);
}

MitsubaNode MitsubaLoader::load_file(const std::filesystem::path& path,
                                     const MitsubaNode* including) {
  const TextFile text(path);
  const auto canonical = std::filesystem::weakly_canonical(path);
  if (including) {
    if (std::ranges::find(open_, canonical) != open_.end()) {
      throw LimitError(
          including->called(fmt::format("includes '{}', which includes this file", path.string())));
    }
    if (open_.size() >= most_nested_scenes || files_ >= most_files) {
      including->fail(
          fmt::format("is one include too many: at most {} files, nested at most {} "
                      "deep, are read",
                      most_files, most_nested_scenes));
    }
  }
  open_.push_back(canonical);
  ++files_;
  tree_.files_.push_back(std::make_unique<std::filesystem::path>(path));
  Source source{.path = tree_.files_.back().get()};
  const std::string& bytes = text.text();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '\n') source.line_ends.push_back(static_cast<std::ptrdiff_t>(i));
  }
  const pugi::xml_parse_result parsed = source.document.load_buffer(bytes.data(), bytes.size());
  if (!parsed) {
    text.fail(source.line_at(parsed.offset),
              fmt::format("this is no well-formed XML: {}", parsed.description()));
  }
  const pugi::xml_node root = source.document.document_element();
  if (std::string_view(root.name()) != "scene") {
    text.fail(source.line_at(std::max<std::ptrdiff_t>(root.offset_debug(), 0)),
              fmt::format("the root element is <{}>; a Mitsuba scene begins with <scene>",
                          excerpt(root.name())));
  }
  MitsubaNode node = convert(source, root, 0);
  open_.pop_back();
  return node;
}

MitsubaNode MitsubaLoader::convert(const Source& source, const pugi::xml_node& from, int depth) {
  MitsubaNode node{.tag = from.name(), .file = source.path};
  node.line = source.line_at(std::max<std::ptrdiff_t>(from.offset_debug(), 0));
  if (depth > deepest_element)
    node.fail(fmt::format("is nested more than {} deep", deepest_element));
  for (const pugi::xml_attribute& attribute : from.attributes()) {
    const std::string_view key = attribute.name();
    std::string value = substituted(node, attribute.value());
    if (key == "type") {
      node.type = std::move(value);
    } else if (key == "id") {
      node.id = std::move(value);
    } else if (key == "name") {
      node.name = node.tag == "default" ? std::move(value) : snake_case(value);
    } else {
      node.attributes.emplace_back(key, std::move(value));
    }
  }
  for (const pugi::xml_node& child : from.children()) {
    if (child.type() != pugi::node_element) continue;
    MitsubaNode next = convert(source, child, depth + 1);
    if (next.tag == "default") {
      const std::string* value = next.attribute("value");
      if (next.name.empty() || !value) next.fail("needs a 'name' and a 'value'");
      defaults_.emplace(next.name, *value);
    } else if (next.tag == "include") {
      include(next, node);
    } else {
      node.children.push_back(std::move(next));
    }
  }
  return node;
}

void MitsubaLoader::include(const MitsubaNode& node, MitsubaNode& parent) {
  const std::string* name = node.attribute("filename");
  if (!name || name->empty()) node.fail("lacks the attribute 'filename'");
  auto path = (node.file->parent_path() / *name).lexically_normal();
  if (!is_file(path)) {
    path = (tree_.files_.front()->parent_path() / *name).lexically_normal();
  }
  if (!is_file(path)) {
    tree_.gaps_.push_back(
        {.what = "Included files are missing, with all that they hold",
         .name = *name,
         .why = node.called(fmt::format("names the file '{}', but there is no such file", *name))});
    return;
  }
  MitsubaNode included = load_file(path, &node);
  for (MitsubaNode& child : included.children) parent.children.push_back(std::move(child));
}

std::string MitsubaLoader::substituted(const MitsubaNode& node, std::string_view text) const {
  std::string result;
  while (!text.empty()) {
    const std::size_t dollar = text.find('$');
    result += text.substr(0, dollar);
    if (dollar == std::string_view::npos) break;
    text.remove_prefix(dollar + 1);
    std::size_t length = 0;
    while (length < text.size() && is_name_character(text[length])) ++length;
    // "$resx_big" means resx followed by "_big" if only resx is defined.
    auto found = defaults_.end();
    std::size_t used = length;
    for (; used > 0 && found == defaults_.end(); --used)
      found = defaults_.find(text.substr(0, used));
    if (found == defaults_.end()) {
      node.fail(
          fmt::format("uses '${}', which no <default> before it defines", text.substr(0, length)));
    }
    result += found->second;
    text.remove_prefix(used + 1);
    // Defaults that refer to each other could grow without bound.
    if (result.size() > longest) node.fail("has an attribute that grows beyond all measure");
  }
  return result;
}

}  // namespace lightwell
