#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace lightwell {

/// Version of the arrays inside a solution file. Raised whenever a reader of an older version could
/// misread a newer file.
inline constexpr int solution_format = 1;

/// The processing instruction at the beginning of a solution file, readable with `head`. `summary`:
/// free text, one "name: value" line each; text that is not UTF-8 is taken as Latin-1.
std::string solution_preamble(const std::string& summary);

/// FNV-1a over all bytes (64 bits; Fowler, Noll & Vo). Throws std::runtime_error if unreadable.
std::uint64_t file_checksum(const std::filesystem::path& path);

/// The last line of a file of these pieces: a processing instruction with the checksum of all.
std::string seal_of(std::span<const std::string> pieces);

/// Appends the last line, seal_of() what the file holds. Throws std::runtime_error naming the file.
void seal_solution(const std::filesystem::path& path);

/// Checks that the file is a complete solution file of this version. Throws InputError with the
/// reason for a file that is missing, a folder, of another kind, of another version, torn, or
/// changed since sealed.
void check_seal(const std::filesystem::path& path);

}  // namespace lightwell
