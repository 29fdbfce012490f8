#include "scene/io/toml/toml_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/errors.h"
#include "scene/io/camera_name.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

const char* type_name(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_integer()) return "a whole number";
  if (node.is_floating_point()) return "a number";
  if (node.is_boolean()) return "true or false";
  if (node.is_array()) return "an array";
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::string located(const std::filesystem::path& file, const toml::source_position& position,
                    std::string_view message) {
  if (!file.has_filename()) return std::string(message);
  return fmt::format("{}:{}:{}: {}", file.string(), position.line, position.column, message);
}

std::string member_of(std::string_view member, const std::string& owner) {
  return owner.empty() ? std::string(member) : fmt::format("{} of {}", member, owner);
}

}  // namespace

std::string quoted_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  }
  return list;
}

TomlValue::TomlValue(const std::filesystem::path& file, const toml::node& node, std::string what)
    : file_(&file), node_(&node), what_(std::move(what)) {}

std::string TomlValue::located(std::string_view problem) const {
  return lightwell::located(*file_, node_->source().begin,
                            fmt::format("{}{}{}", what_, what_.empty() ? "" : " ", problem));
}

void TomlValue::fail(std::string_view problem) const {
  throw InputError(located(problem));
}

void TomlValue::wrong_type(std::string_view wanted) const {
  fail(fmt::format("must be {}, but is {}", wanted, type_name(*node_)));
}

double TomlValue::number() const {
  double value = 0.0;
  if (const auto* real = node_->as_floating_point()) {
    value = real->get();
  } else if (const auto* whole = node_->as_integer()) {
    value = static_cast<double>(whole->get());
  } else {
    wrong_type("a number");
  }
  if (!std::isfinite(value)) fail(fmt::format("is {}; give a finite number", value));
  return value;
}

double TomlValue::number_at_least(double low) const {
  const double value = number();
  if (!(value >= low)) fail(fmt::format("is {}; it must be at least {}", value, low));
  return value;
}

double TomlValue::positive() const {
  const double value = number();
  if (!(value > 0.0)) fail(fmt::format("is {}; it must be greater than 0", value));
  return value;
}

double TomlValue::number_within(double low, double high) const {
  const double value = number();
  if (!(value >= low && value <= high)) {
    fail(fmt::format("is {}; it must lie between {} and {}", value, low, high));
  }
  return value;
}

std::int64_t TomlValue::integer_within(std::int64_t low, std::int64_t high) const {
  const auto* whole = node_->as_integer();
  if (!whole) wrong_type("a whole number");
  if (whole->get() < low || whole->get() > high) {
    fail(fmt::format("is {}; it must lie between {} and {}", whole->get(), low, high));
  }
  return whole->get();
}

bool TomlValue::boolean() const {
  const auto* value = node_->as_boolean();
  if (!value) wrong_type("true or false");
  return value->get();
}

std::string TomlValue::string() const {
  const auto* value = node_->as_string();
  if (!value) wrong_type("a string");
  return value->get();
}

std::string TomlValue::name() const {
  std::string value = string();
  if (value.empty()) fail("is empty; give a name or leave the key out");
  return value;
}

std::string TomlValue::file_name() const {
  std::string value = name();
  if (value.find_first_of("/\\") != std::string::npos || value.starts_with('.')) {
    fail(
        fmt::format("is '{}'; files are called after it, so it must not contain a slash or start "
                    "with a dot",
                    value));
  }
  if (value.size() > longest_camera_name) {
    fail(fmt::format("is of {} bytes; files are called after it, so give at most {}", value.size(),
                     longest_camera_name));
  }
  return value;
}

std::string TomlValue::one_of(std::initializer_list<const char*> words) const {
  std::string value = string();
  const std::vector<std::string> known(words.begin(), words.end());
  if (std::find(known.begin(), known.end(), value) == known.end()) {
    fail(fmt::format("is '{}'; it must be {}.{}", value, quoted_list(known),
                     did_you_mean(value, known)));
  }
  return value;
}

Eigen::Vector3d TomlValue::vector() const {
  const auto* array = node_->as_array();
  if (!array) wrong_type("three numbers [x, y, z]");
  if (array->size() != 3) {
    fail(fmt::format("must be three numbers [x, y, z], but has {}", array->size()));
  }
  constexpr const char* axes[] = {"x", "y", "z"};
  Eigen::Vector3d result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[static_cast<Eigen::Index>(c)] =
        TomlValue(*file_, (*array)[c], member_of(axes[c], what_)).number();
  }
  return result;
}

std::vector<TomlValue> TomlValue::elements(std::string_view member) const {
  const auto* array = node_->as_array();
  if (!array) wrong_type("an array");
  std::vector<TomlValue> result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    result.emplace_back(*file_, (*array)[i], member_of(fmt::format("{} {}", member, i + 1), what_));
  }
  return result;
}

TomlTable TomlValue::table(std::initializer_list<const char*> keys) const {
  const auto* table = node_->as_table();
  if (!table) wrong_type("a table");
  return {*this, *table, keys};
}

std::optional<TomlValue> TomlValue::member(std::string_view key) const {
  const auto* table = node_->as_table();
  if (!table) wrong_type("a table");
  const toml::node* node = table->get(key);
  if (!node) return std::nullopt;
  return TomlValue(*file_, *node, member_of(key, what_));
}

std::vector<std::pair<std::string, TomlValue>> TomlValue::members(std::string_view member) const {
  const auto* table = node_->as_table();
  if (!table) wrong_type("a table");
  std::vector<std::pair<std::string, TomlValue>> result;
  for (const auto& [key, node] : *table) {
    result.emplace_back(std::string(key.str()),
                        TomlValue(*file_, node, fmt::format("{} '{}'", member, key.str())));
  }
  return result;
}

TomlTable::TomlTable(TomlValue value, const toml::table& table,
                     std::initializer_list<const char*> keys)
    : value_(std::move(value)), table_(&table) {
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    const std::string near = did_you_mean(key.str(), known);
    throw InputError(
        located(value_.file(), key.source().begin,
                fmt::format("unknown key '{}'{}{}.{}", key.str(),
                            value_.what().empty() ? "" : " in ", value_.what(),
                            near.empty() ? " Known are " + quoted_list(known) + "." : near)));
  }
}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
  return value_.member(key);
}

TomlValue TomlTable::require(std::string_view key) const {
  if (auto value = find(key)) return *value;
  fail(fmt::format("lacks the key '{}'", key));
}

std::vector<std::string> TomlTable::present(std::initializer_list<const char*> choices) const {
  std::vector<std::string> result;
  for (const char* key : choices) {
    if (has(key)) result.emplace_back(key);
  }
  return result;
}

}  // namespace lightwell
