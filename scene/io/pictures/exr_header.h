#pragma once

#include <filesystem>

namespace lightwell {

/// Throws InputError that names the file and the fault unless the attributes of an OpenEXR file's
/// headers lie within the file, are of the size that their types have, and describe pictures for
/// whose pixels the file has room. OpenEXR takes memory for all the bytes that an attribute claims
/// before reading the first, reads values of known types without regard to the size, and takes
/// memory for a block of lines when it opens the file. Files that are no OpenEXR files pass.
void check_exr_header(const std::filesystem::path& path);

}  // namespace lightwell
