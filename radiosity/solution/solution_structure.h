#pragma once

#include <filesystem>

namespace lightwell {

/// Checks what VTK's reader takes on trust: that the XML of a solution file is what
/// write_solution() writes, that every array has a name, a known type and as many values as its
/// count says, that its blocks lie within the file, that strings end, and that polygons have as
/// many corners as their offsets say. The values of other numbers are not read. Throws InputError
/// that names the file and the array.
void check_structure(const std::filesystem::path& path);

}  // namespace lightwell
