#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// The JSON document that `text` of a file holds. Throws InputError naming file and line.
nlohmann::json parse_json(const std::filesystem::path& file, std::string_view text);

/// A JSON object of a file with its place ("meshes[2].primitives[0]"). A value of null counts as
/// missing. Every accessor throws InputError "file: place: ..." if a value has another type than
/// requested. Refers to the document, which must outlive the JsonObject.
class JsonObject {
 public:
  JsonObject(const std::filesystem::path& file, const nlohmann::json& value, std::string place);

  bool has(const char* key) const;
  /// True if the value is there and is an object.
  bool is_object(const char* key) const;
  double number_or(const char* key, double otherwise) const;
  bool boolean_or(const char* key, bool otherwise) const;
  std::string string_or(const char* key, std::string_view otherwise) const;
  /// A whole number in [0, 2^53).
  std::optional<std::size_t> index(const char* key) const;
  std::size_t index_or(const char* key, std::size_t otherwise) const;
  /// The numbers of an array of exactly `count`; empty if the key is missing.
  std::vector<double> numbers(const char* key, std::size_t count) const;
  std::vector<std::size_t> indices(const char* key) const;
  std::vector<std::string> strings(const char* key) const;
  std::optional<JsonObject> object(const char* key) const;
  std::vector<JsonObject> objects(const char* key) const;
  /// Whole numbers of an array of such arrays.
  std::vector<std::vector<std::size_t>> index_lists(const char* key) const;
  /// The point [x, y, z]; empty if the key is missing.
  std::optional<Eigen::Vector3d> point(const char* key) const;
  /// Points of an array of [x, y, z].
  std::vector<Eigen::Vector3d> points(const char* key) const;
  /// Lists of points of an array of such arrays.
  std::vector<std::vector<Eigen::Vector3d>> point_lists(const char* key) const;
  /// The object extensions.NAME of glTF.
  std::optional<JsonObject> extension(const char* name) const;

  const std::string& place() const { return place_; }
  /// Name of the object in the file, or its place if unnamed.
  std::string name() const;
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws LimitError in place of InputError.
  [[noreturn]] void fail_limit(std::string_view problem) const;

 private:
  std::string sentence(std::string_view problem) const;
  const nlohmann::json* find(const char* key) const;
  const nlohmann::json* find_array(const char* key) const;
  template <class Read>
  auto lists_of(const char* key, const Read& read) const;
  std::vector<std::size_t> indices_of(const char* key, const nlohmann::json& array) const;
  std::vector<Eigen::Vector3d> points_of(const char* key, const nlohmann::json& array) const;
  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace lightwell
