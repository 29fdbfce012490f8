#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

class TomlTable;

/// A value of a TOML file with its place and its description ("reflectance of material 'white'").
/// Every accessor throws InputError "file:line:column: what ..." unless the value has the requested
/// type. Refers to the document, which must outlive the TomlValue. A path without a file name,
/// "folder/", is that of a document in memory: messages then have no place, and begin with `what`.
class TomlValue {
 public:
  TomlValue(const std::filesystem::path& file, const toml::node& node, std::string what);

  bool is_number() const { return node_->is_number(); }
  bool is_array() const { return node_->is_array(); }
  bool is_table() const { return node_->is_table(); }

  double number() const;                                ///< finite; whole numbers too
  double number_at_least(double low) const;             ///< finite and >= low
  double positive() const;                              ///< finite and > 0
  double number_within(double low, double high) const;  ///< in [low, high]
  std::int64_t integer_within(std::int64_t low, std::int64_t high) const;
  bool boolean() const;
  std::string string() const;
  std::string name() const;  ///< a string that is not empty
  /// A name that files can be called after: without slashes, no dot first, at most
  /// longest_camera_name bytes.
  std::string file_name() const;
  /// A string among `words`.
  std::string one_of(std::initializer_list<const char*> words) const;
  Eigen::Vector3d vector() const;  ///< [x, y, z]
  /// Members of an array, described as "`member` 1 of ..." and so on.
  std::vector<TomlValue> elements(std::string_view member) const;
  /// A table without keys other than `keys`.
  TomlTable table(std::initializer_list<const char*> keys) const;
  /// One member of a table with any other keys.
  std::optional<TomlValue> member(std::string_view key) const;
  /// Members of a table with any keys, described as "`member` 'KEY'".
  std::vector<std::pair<std::string, TomlValue>> members(std::string_view member) const;

  const std::string& what() const { return what_; }
  const std::filesystem::path& file() const { return *file_; }
  /// The same value with another description, for values whose name is part of their contents.
  TomlValue renamed(std::string what) const { return {*file_, *node_, std::move(what)}; }

  /// "file:line:column: `what` `problem`"
  std::string located(std::string_view problem) const;
  /// Throws InputError with the sentence located() makes.
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  [[noreturn]] void wrong_type(std::string_view wanted) const;
  const std::filesystem::path* file_;
  const toml::node* node_;
  std::string what_;
};

/// A TOML table whose keys have been checked against the known ones.
class TomlTable {
 public:
  TomlTable(TomlValue value, const toml::table& table, std::initializer_list<const char*> keys);

  bool has(std::string_view key) const { return table_->contains(key); }
  std::optional<TomlValue> find(std::string_view key) const;
  /// Throws InputError if the table lacks `key`.
  TomlValue require(std::string_view key) const;
  /// The keys among `choices` that the table has.
  std::vector<std::string> present(std::initializer_list<const char*> choices) const;
  const TomlValue& value() const { return value_; }
  [[noreturn]] void fail(std::string_view problem) const { value_.fail(problem); }

 private:
  TomlValue value_;
  const toml::table* table_;
};

/// "'a', 'b' or 'c'"
std::string quoted_list(const std::vector<std::string>& words);

}  // namespace lightwell
