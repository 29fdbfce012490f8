#include "scene/io/mitsuba/mitsuba_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "scene/errors.h"
#include "scene/io/mitsuba/mitsuba_loader.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

void index_ids(const MitsubaNode& node,
               std::map<std::string, const MitsubaNode*, std::less<>>& by_id,
               std::vector<const MitsubaNode*>& aliases) {
  if (node.tag == "alias") aliases.push_back(&node);
  if (!node.id.empty() && node.tag != "ref" && node.tag != "alias") {
    const auto [first, is_new] = by_id.emplace(node.id, &node);
    if (!is_new) {
      node.fail(fmt::format("has the id '{}', which <{}> on line {} has; give it another", node.id,
                            first->second->tag, first->second->line));
    }
  }
  for (const MitsubaNode& child : node.children) index_ids(child, by_id, aliases);
}

// The ids and aliases that references may name.
void collect_ids(const MitsubaNode& node, std::set<std::string, std::less<>>& ids) {
  if (!node.id.empty() && node.tag != "ref" && node.tag != "alias") ids.insert(node.id);
  const std::string* as = node.tag == "alias" ? node.attribute("as") : nullptr;
  if (as) ids.insert(*as);
  for (const MitsubaNode& child : node.children) collect_ids(child, ids);
}

}  // namespace

const std::string* MitsubaNode::attribute(std::string_view key) const {
  const auto found = std::ranges::find(attributes, key, [](const auto& a) { return a.first; });
  return found == attributes.end() ? nullptr : &found->second;
}

std::string MitsubaNode::label() const {
  if (!id.empty()) return id;
  return fmt::format("{} on line {}", type.empty() ? tag : type, line);
}

std::string MitsubaNode::called(std::string_view problem) const {
  const std::string property = name.empty() ? "" : fmt::format(" '{}'", name);
  return fmt::format("{}:{}: <{}>{} {}", file->string(), line, tag, property, problem);
}

void MitsubaNode::fail(std::string_view problem) const {
  throw InputError(called(problem));
}

const MitsubaNode* MitsubaNode::property(std::string_view property_name) const {
  const auto found = std::ranges::find(children, property_name, &MitsubaNode::name);
  return found == children.end() ? nullptr : &*found;
}

double MitsubaNode::number_attribute(std::string_view key) const {
  const std::string* text = attribute(key);
  if (!text) fail(fmt::format("lacks the attribute '{}'", key));
  const auto value = parse_finite(trimmed(*text));
  if (!value) fail(fmt::format("has {} \"{}\", which is not a finite number", key, *text));
  return *value;
}

std::optional<double> MitsubaNode::number(std::string_view property_name) const {
  const MitsubaNode* node = property(property_name);
  if (!node) return std::nullopt;
  if (node->tag != "float" && node->tag != "integer") {
    node->fail("is no number; write <float> or <integer>");
  }
  return node->number_attribute("value");
}

double MitsubaNode::number_or(std::string_view property_name, double otherwise) const {
  return number(property_name).value_or(otherwise);
}

bool MitsubaNode::boolean_or(std::string_view property_name, bool otherwise) const {
  const MitsubaNode* node = property(property_name);
  if (!node) return otherwise;
  const std::string* value = node->attribute("value");
  if (value && (*value == "true" || *value == "True")) return true;
  if (value && (*value == "false" || *value == "False")) return false;
  node->fail("must be 'true' or 'false'");
}

std::string MitsubaNode::string_or(std::string_view property_name,
                                   std::string_view otherwise) const {
  const MitsubaNode* node = property(property_name);
  if (!node) return std::string(otherwise);
  const std::string* value = node->attribute("value");
  if (!value) node->fail("lacks the attribute 'value'");
  return *value;
}

std::vector<double> parse_numbers(const MitsubaNode& node, std::string_view text) {
  std::string parted(text);
  std::replace(parted.begin(), parted.end(), ',', ' ');
  std::replace(parted.begin(), parted.end(), '\n', ' ');
  std::string_view rest = parted;
  std::vector<double> numbers;
  for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
    const auto value = parse_finite(word);
    if (!value) node.fail(fmt::format("has '{}', which is not a finite number", word));
    numbers.push_back(*value);
  }
  return numbers;
}

MitsubaTree::MitsubaTree(const std::filesystem::path& path) {
  MitsubaLoader(*this).load(path);
  std::set<std::string, std::less<>> ids;
  collect_ids(root_, ids);
  drop_dangling(root_, ids);
  std::vector<const MitsubaNode*> aliases;
  index_ids(root_, by_id_, aliases);
  for (const MitsubaNode* alias : aliases) {
    const std::string* as = alias->attribute("as");
    const auto found = by_id_.find(alias->id);
    if (!as || found == by_id_.end()) alias->fail("needs the 'id' of an element and a name 'as'");
    by_id_.emplace(*as, found->second);
  }
}

// Removes references to no element. Done before elements are indexed by address.
void MitsubaTree::drop_dangling(MitsubaNode& node, const std::set<std::string, std::less<>>& ids) {
  std::erase_if(node.children, [&](const MitsubaNode& child) {
    if (child.tag != "ref" || ids.contains(child.id)) return false;
    gaps_.push_back(
        {.what = "References that name no element were left out",
         .name = child.id,
         .why = child.called(fmt::format("names '{}', which is the id of no element.{}", child.id,
                                         did_you_mean(child.id, {ids.begin(), ids.end()})))});
    return true;
  });
  for (MitsubaNode& child : node.children) drop_dangling(child, ids);
}

const MitsubaNode& MitsubaTree::resolved(const MitsubaNode& node) const {
  if (node.tag != "ref") return node;
  return *by_id_.find(node.id)->second;
}

std::vector<const MitsubaNode*> MitsubaTree::children(const MitsubaNode& node,
                                                      std::string_view tag) const {
  std::vector<const MitsubaNode*> result;
  for (const MitsubaNode& child : node.children) {
    const MitsubaNode& target = resolved(child);
    if (target.tag == tag) result.push_back(&target);
  }
  return result;
}

std::optional<std::filesystem::path> MitsubaTree::found_file(const MitsubaNode& node,
                                                             const std::string& name) const {
  std::string portable = name;
  std::replace(portable.begin(), portable.end(), '\\', '/');
  for (const auto* file : {node.file, root_.file}) {
    const auto path = (file->parent_path() / portable).lexically_normal();
    if (!name.empty() && is_file(path)) return path;
  }
  return std::nullopt;
}

bool MitsubaTree::has_file(const MitsubaNode& node, const std::string& name) const {
  return found_file(node, name).has_value();
}

std::filesystem::path MitsubaTree::file_named(const MitsubaNode& node,
                                              const std::string& name) const {
  if (name.empty()) node.fail("names no file");
  if (const auto path = found_file(node, name)) return *path;
  node.fail(fmt::format("names the file '{}', but there is no such file; it was looked for in {}",
                        name, node.file->parent_path().string()));
}

}  // namespace lightwell
