#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lightwell::fuzz {

/// Writes `bytes` to a file of this name, for readers that take a path. The file replaces the one
/// before in a folder of this process, which lies in TMPDIR, goes at the end of the process, and
/// holds the files of tests/fuzz/beside, for scenes that name other files.
std::filesystem::path input_file(const std::string& name, std::string_view bytes);

/// All bytes of a file; none if the file cannot be read.
std::string bytes_of_file(const std::filesystem::path& path);

}  // namespace lightwell::fuzz
