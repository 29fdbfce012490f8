#include "scene/io/pictures/exr_header.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "scene/errors.h"

namespace lightwell {
namespace {

// A number in the file's byte order, which is that of the machine.
std::int32_t number(std::ifstream& file) {
  std::int32_t value = 0;
  file.read(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

}  // namespace

// The layout is that of "OpenEXR File Layout" (Academy Software Foundation): magic, version and
// flags, then attributes of name, type, size and value. An empty name ends a header; in a file of
// several parts, one more ends the last header.
void check_exr_header(const std::filesystem::path& path) {
  constexpr std::int32_t magic = 20000630, several_parts = 0x1000;
  std::ifstream file(path, std::ios::binary);
  if (number(file) != magic) return;
  const bool has_parts = (number(file) & several_parts) != 0;
  const auto end = static_cast<std::int64_t>(std::filesystem::file_size(path));
  bool begins = true;  // a header
  for (std::string name, type; std::getline(file, name, '\0');) {
    if (name.empty()) {
      if (begins || !has_parts) return;
      begins = true;
      continue;
    }
    begins = false;
    std::getline(file, type, '\0');
    const std::int32_t size = number(file);
    if (!file || size < 0 || size > end - static_cast<std::int64_t>(file.tellg())) {
      constexpr std::size_t longest_name = 255;
      throw InputError(
          fmt::format("{}: the attribute '{}' of its header does not end within the file; it was "
                      "damaged or cut off",
                      path.string(), name.substr(0, longest_name)));
    }
    file.seekg(size, std::ios::cur);
  }
}

}  // namespace lightwell
