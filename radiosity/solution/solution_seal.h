#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lightwell {

/// The version of the arrays inside a solution file. Raised whenever a reader of the older version
/// could misread the newer.
inline constexpr int solution_format = 1;

/// The processing instruction a solution file begins with, so that `head` tells a person what it
/// is: `summary` is free text, one "name: value" line each.
std::string solution_preamble(const std::string& summary);

/// FNV-1a over all bytes (64 bits; Fowler, Noll & Vo). Throws std::runtime_error if unreadable.
std::uint64_t file_checksum(const std::filesystem::path& path);

/// Appends the last line, a processing instruction with the checksum of everything before it.
/// Throws std::runtime_error naming the file.
void seal_solution(const std::filesystem::path& path);

/// Throws InputError, with the reason, unless the file is a whole solution file of this version:
/// missing, a folder, foreign, another version, torn, or changed since it was sealed.
void check_seal(const std::filesystem::path& path);

}  // namespace lightwell
