#pragma once

#include <filesystem>

namespace lightwell {

/// Checks what VTK's reader takes on trust: that the XML of a solution file is what
/// write_solution() writes, that every array has a name, a known type and as many values as its
/// count says, that its blocks lie within the file, and that strings end. The values of numbers are
/// not read. Throws InputError that names the file and the array.
void check_structure(const std::filesystem::path& path);

}  // namespace lightwell
