#pragma once

#include <filesystem>

namespace lightwell {

/// Throws InputError that names the file and the attribute unless the attributes of an OpenEXR
/// file's headers lie within the file: OpenEXR takes memory for all the bytes that an attribute
/// claims before reading the first. Files that are no OpenEXR files pass.
void check_exr_header(const std::filesystem::path& path);

}  // namespace lightwell
