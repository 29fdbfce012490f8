#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "scene/io/text_file.h"

namespace lightwell {

/// The file in the folder of `path` whose name differs from that of `path` in upper and lower case
/// alone, as other systems permit; of several the first by name.
inline std::optional<std::filesystem::path> file_of_any_case(const std::filesystem::path& path) {
  const std::string wanted = lower_case(path.filename().string());
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::optional<std::filesystem::path> found;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::filesystem::path name = entry->path().filename();
    if (lower_case(name.string()) != wanted || (found && found->filename() <= name)) continue;
    if (is_file(path.parent_path() / name)) found = path.parent_path() / name;
  }
  return found;
}

/// The file that a scene in `folder` names, perhaps by a path of another machine: with backslashes,
/// a drive, folders that are not here, or in other upper and lower case. The file then lies beside
/// the scene. Empty if there is none.
inline std::optional<std::filesystem::path> find_foreign_file(const std::filesystem::path& folder,
                                                              std::string name) {
  std::ranges::replace(name, '\\', '/');
  if (name.starts_with("file://")) name = name.substr(std::string_view("file://").size());
  const std::filesystem::path path(name), beside = folder / path.filename();
  if (!path.has_filename()) return std::nullopt;
  const bool has_drive = name.size() > 1 && name[1] == ':';
  std::vector<std::filesystem::path> places = {folder / path, beside};
  if (has_drive) places = {beside};
  if (path.is_absolute()) places = {beside, path};
  for (const auto& place : places) {
    if (is_file(place)) return place;
  }
  for (const auto& place : places) {
    if (auto found = file_of_any_case(place)) return found;
  }
  return std::nullopt;
}

}  // namespace lightwell
