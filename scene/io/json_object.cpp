#include "scene/io/json_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/errors.h"

namespace lightwell {
namespace {

// 2^53: a double holds smaller whole numbers exactly.
constexpr double most_exact = 9007199254740992.0;

}  // namespace

nlohmann::json parse_json(const std::filesystem::path& file, std::string_view text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    std::string_view what = error.what();
    // Format of nlohmann's messages: "[json.exception.parse_error.101] parse error at line 3,
    // column 7: syntax error ..."
    what.remove_prefix(std::min(what.size(), what.find("] ") + 2));
    std::string line;
    if (const auto at = what.find("line "); at != std::string_view::npos) {
      const std::string_view digits = what.substr(at + 5);
      line = fmt::format("{}:", digits.substr(0, digits.find_first_not_of("0123456789")));
    }
    what = what.substr(0, what.find("; last read"));  // quotes the file, to any length
    throw InputError(
        fmt::format("{}:{} this is no well-formed JSON: {}", file.string(), line, what));
  }
}

JsonObject::JsonObject(const std::filesystem::path& file, const nlohmann::json& value,
                       std::string place)
    : file_(&file), value_(&value), place_(std::move(place)) {
  if (!value.is_object()) fail("must be an object");
}

std::string JsonObject::sentence(std::string_view problem) const {
  return fmt::format("{}: {}{}{}", file_->string(), place_, place_.empty() ? "" : ": ", problem);
}

void JsonObject::fail(std::string_view problem) const {
  throw InputError(sentence(problem));
}

void JsonObject::fail_limit(std::string_view problem) const {
  throw LimitError(sentence(problem));
}

const nlohmann::json* JsonObject::find(const char* key) const {
  const auto found = value_->find(key);
  return found == value_->end() || found->is_null() ? nullptr : &*found;
}

const nlohmann::json* JsonObject::find_array(const char* key) const {
  const nlohmann::json* value = find(key);
  if (value && !value->is_array()) fail(fmt::format("'{}' must be an array", key));
  return value;
}

bool JsonObject::has(const char* key) const {
  return find(key) != nullptr;
}

bool JsonObject::is_object(const char* key) const {
  const nlohmann::json* value = find(key);
  return value && value->is_object();
}

double JsonObject::number_or(const char* key, double otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_number()) fail(fmt::format("'{}' must be a number", key));
  return value->get<double>();
}

bool JsonObject::boolean_or(const char* key, bool otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_boolean()) fail(fmt::format("'{}' must be true or false", key));
  return value->get<bool>();
}

std::string JsonObject::string_or(const char* key, std::string_view otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return std::string(otherwise);
  if (!value->is_string()) fail(fmt::format("'{}' must be a string", key));
  return value->get<std::string>();
}

std::optional<std::size_t> JsonObject::index(const char* key) const {
  if (!has(key)) return std::nullopt;
  const double value = number_or(key, 0.0);
  if (!(value >= 0.0 && value < most_exact && value == std::floor(value))) {
    fail(fmt::format("'{}' is {}; it must be a whole number that is at least 0", key, value));
  }
  return static_cast<std::size_t>(value);
}

std::size_t JsonObject::index_or(const char* key, std::size_t otherwise) const {
  return index(key).value_or(otherwise);
}

std::vector<double> JsonObject::numbers(const char* key, std::size_t count) const {
  const nlohmann::json* array = find_array(key);
  std::vector<double> result;
  if (!array) return result;
  for (const auto& value : *array) {
    if (!value.is_number()) fail(fmt::format("'{}' must be an array of numbers", key));
    result.push_back(value.get<double>());
  }
  if (result.size() != count) {
    fail(fmt::format("'{}' has {} numbers; it needs {}", key, result.size(), count));
  }
  return result;
}

std::vector<std::size_t> JsonObject::indices_of(const char* key,
                                                const nlohmann::json& array) const {
  std::vector<std::size_t> result;
  for (const auto& value : array) {
    if (!value.is_number_unsigned()) {
      fail(fmt::format("'{}' must be an array of whole numbers that are at least 0", key));
    }
    result.push_back(value.get<std::size_t>());
  }
  return result;
}

std::vector<std::size_t> JsonObject::indices(const char* key) const {
  const nlohmann::json* array = find_array(key);
  return array ? indices_of(key, *array) : std::vector<std::size_t>();
}

// The lists of an array of arrays, each read by `read`.
template <class Read>
auto JsonObject::lists_of(const char* key, const Read& read) const {
  std::vector<decltype(read(*value_))> lists;
  const nlohmann::json* array = find_array(key);
  if (!array) return lists;
  for (const auto& list : *array) {
    if (!list.is_array()) fail(fmt::format("'{}' must be an array of arrays", key));
    lists.push_back(read(list));
  }
  return lists;
}

std::vector<std::vector<std::size_t>> JsonObject::index_lists(const char* key) const {
  return lists_of(key, [&](const nlohmann::json& list) { return indices_of(key, list); });
}

std::vector<std::string> JsonObject::strings(const char* key) const {
  const nlohmann::json* array = find_array(key);
  std::vector<std::string> result;
  if (!array) return result;
  for (const auto& value : *array) {
    if (!value.is_string()) fail(fmt::format("'{}' must be an array of strings", key));
    result.push_back(value.get<std::string>());
  }
  return result;
}

std::vector<Eigen::Vector3d> JsonObject::points_of(const char* key,
                                                   const nlohmann::json& array) const {
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : array) {
    const bool is_point =
        point.is_array() && point.size() == 3 &&
        std::ranges::all_of(point, [](const auto& value) { return value.is_number(); });
    if (!is_point) fail(fmt::format("'{}' must be an array of points [x, y, z]", key));
    points.emplace_back(point[0].get<double>(), point[1].get<double>(), point[2].get<double>());
  }
  return points;
}

std::optional<Eigen::Vector3d> JsonObject::point(const char* key) const {
  const std::vector<double> numbers = has(key) ? this->numbers(key, 3) : std::vector<double>();
  if (numbers.empty()) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

std::vector<Eigen::Vector3d> JsonObject::points(const char* key) const {
  const nlohmann::json* array = find_array(key);
  return array ? points_of(key, *array) : std::vector<Eigen::Vector3d>();
}

std::vector<std::vector<Eigen::Vector3d>> JsonObject::point_lists(const char* key) const {
  return lists_of(key, [&](const nlohmann::json& list) { return points_of(key, list); });
}

std::optional<JsonObject> JsonObject::object(const char* key) const {
  const nlohmann::json* value = find(key);
  if (!value) return std::nullopt;
  return JsonObject(*file_, *value, place_.empty() ? key : fmt::format("{}.{}", place_, key));
}

std::vector<JsonObject> JsonObject::objects(const char* key) const {
  const nlohmann::json* array = find_array(key);
  std::vector<JsonObject> result;
  if (!array) return result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    result.emplace_back(*file_, (*array)[i],
                        fmt::format("{}{}{}[{}]", place_, place_.empty() ? "" : ".", key, i));
  }
  return result;
}

std::optional<JsonObject> JsonObject::extension(const char* name) const {
  const auto extensions = object("extensions");
  return extensions ? extensions->object(name) : std::nullopt;
}

std::string JsonObject::name() const {
  const std::string given = string_or("name", "");
  return given.empty() ? place_ : given;
}

}  // namespace lightwell
