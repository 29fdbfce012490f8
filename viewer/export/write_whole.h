#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <type_traits>

namespace lightwell {

/// Writes the pieces one after the other under a temporary name and renames the file. Throws
/// std::runtime_error naming the file and the system's reason if writing fails.
void write_whole(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

struct FileText {
  const std::filesystem::path& path;
  std::string_view text;
};
/// Writes files that belong together: none gets its name before all are written.
void write_together(std::initializer_list<FileText> files);

/// A JSON value as the text of a file, indented. Bytes of names that are not UTF-8 are replaced.
std::string json_text(const nlohmann::ordered_json& json);

/// Appends the bytes of a value in memory order. The formats written here are little-endian, as
/// x86-64 is.
template <typename T>
void append_bytes(std::string& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// `name` for one line of a text file: control characters become `_`.
std::string one_line(std::string name);

}  // namespace lightwell
