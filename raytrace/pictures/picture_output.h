#pragma once

#include <filesystem>
#include <string>

#include "raytrace/pictures/image.h"

namespace lightwell {

/// Throws std::runtime_error with the file's name and the reason.
[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why);

/// Calls fail_write() for an image without pixels, with too many or too few of them, or with other
/// bands than `bands`.
void check_writable(const Image& image, const Bands& bands, const std::filesystem::path& path);

/// Returns an attribute as text: numbers with 9 significant digits, vectors as three numbers.
std::string to_text(const ImageAttribute& value);

}  // namespace lightwell
