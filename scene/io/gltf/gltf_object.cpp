#include "scene/io/gltf/gltf_object.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/errors.h"

namespace lightwell {
namespace {

// 2^53: a double holds smaller whole numbers exactly.
constexpr double most_exact = 9007199254740992.0;

}  // namespace

GltfObject::GltfObject(const std::filesystem::path& file, const nlohmann::json& value,
                       std::string place)
    : file_(&file), value_(&value), place_(std::move(place)) {
  if (!value.is_object()) fail("must be an object");
}

void GltfObject::fail(std::string_view problem) const {
  throw InputError(
      fmt::format("{}: {}{}{}", file_->string(), place_, place_.empty() ? "" : ": ", problem));
}

const nlohmann::json* GltfObject::find(const char* key) const {
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

const nlohmann::json* GltfObject::find_array(const char* key) const {
  const nlohmann::json* value = find(key);
  if (value && !value->is_array()) fail(fmt::format("'{}' must be an array", key));
  return value;
}

bool GltfObject::has(const char* key) const {
  return find(key) != nullptr;
}

double GltfObject::number_or(const char* key, double otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_number()) fail(fmt::format("'{}' must be a number", key));
  return value->get<double>();
}

bool GltfObject::boolean_or(const char* key, bool otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_boolean()) fail(fmt::format("'{}' must be true or false", key));
  return value->get<bool>();
}

std::string GltfObject::string_or(const char* key, std::string_view otherwise) const {
  const nlohmann::json* value = find(key);
  if (!value) return std::string(otherwise);
  if (!value->is_string()) fail(fmt::format("'{}' must be a string", key));
  return value->get<std::string>();
}

std::optional<std::size_t> GltfObject::index(const char* key) const {
  if (!has(key)) return std::nullopt;
  const double value = number_or(key, 0.0);
  if (!(value >= 0.0 && value < most_exact && value == std::floor(value))) {
    fail(fmt::format("'{}' is {}; it must be a whole number that is at least 0", key, value));
  }
  return static_cast<std::size_t>(value);
}

std::size_t GltfObject::index_or(const char* key, std::size_t otherwise) const {
  return index(key).value_or(otherwise);
}

std::vector<double> GltfObject::numbers(const char* key, std::size_t count) const {
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

std::vector<std::size_t> GltfObject::indices(const char* key) const {
  const nlohmann::json* array = find_array(key);
  std::vector<std::size_t> result;
  if (!array) return result;
  for (const auto& value : *array) {
    if (!value.is_number_unsigned()) {
      fail(fmt::format("'{}' must be an array of whole numbers that are at least 0", key));
    }
    result.push_back(value.get<std::size_t>());
  }
  return result;
}

std::vector<std::string> GltfObject::strings(const char* key) const {
  const nlohmann::json* array = find_array(key);
  std::vector<std::string> result;
  if (!array) return result;
  for (const auto& value : *array) {
    if (!value.is_string()) fail(fmt::format("'{}' must be an array of strings", key));
    result.push_back(value.get<std::string>());
  }
  return result;
}

std::optional<GltfObject> GltfObject::object(const char* key) const {
  const nlohmann::json* value = find(key);
  if (!value) return std::nullopt;
  return GltfObject(*file_, *value, place_.empty() ? key : fmt::format("{}.{}", place_, key));
}

std::vector<GltfObject> GltfObject::objects(const char* key) const {
  const nlohmann::json* array = find_array(key);
  std::vector<GltfObject> result;
  if (!array) return result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    result.emplace_back(*file_, (*array)[i],
                        fmt::format("{}{}{}[{}]", place_, place_.empty() ? "" : ".", key, i));
  }
  return result;
}

std::optional<GltfObject> GltfObject::extension(const char* name) const {
  const auto extensions = object("extensions");
  return extensions ? extensions->object(name) : std::nullopt;
}

std::string GltfObject::name() const {
  const std::string given = string_or("name", "");
  return given.empty() ? place_ : given;
}

}  // namespace lightwell
