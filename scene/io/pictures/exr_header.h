#pragma once

#include <filesystem>

namespace lightwell {

/// Throws InputError that names the file and the attribute unless the attributes of an OpenEXR
/// file's headers lie within the file and are of the size that their types have. OpenEXR takes
/// memory for all the bytes that an attribute claims before reading the first, and reads values of
/// known types without regard to the size. Files that are no OpenEXR files pass.
void check_exr_header(const std::filesystem::path& path);

}  // namespace lightwell
