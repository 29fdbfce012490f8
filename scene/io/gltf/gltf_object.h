#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// A JSON object of a glTF file with its place ("meshes[2].primitives[0]"). Every accessor throws
/// InputError "file: place: ..." if a value has another type than requested. Refers to the
/// document, which must outlive the GltfObject.
class GltfObject {
 public:
  GltfObject(const std::filesystem::path& file, const nlohmann::json& value, std::string place);

  bool has(const char* key) const;
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
  std::optional<GltfObject> object(const char* key) const;
  std::vector<GltfObject> objects(const char* key) const;
  /// The object extensions.NAME.
  std::optional<GltfObject> extension(const char* name) const;

  const std::string& place() const { return place_; }
  /// Name of the object in the file, or its place if unnamed.
  std::string name() const;
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  const nlohmann::json* find(const char* key) const;
  const nlohmann::json* find_array(const char* key) const;
  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace lightwell
