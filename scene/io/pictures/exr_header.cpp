#include "scene/io/pictures/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::size_t longest_name = 255;

std::int32_t number_at(std::string_view bytes, std::size_t at) {
  std::int32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A number in the file's byte order, which is that of the machine.
std::int32_t number(std::ifstream& file) {
  std::array<char, sizeof(std::int32_t)> bytes{};
  file.read(bytes.data(), bytes.size());
  return number_at({bytes.data(), bytes.size()}, 0);
}

// Bytes of a value of a type whose values have the same size; empty for other types.
std::optional<std::size_t> bytes_of(std::string_view type) {
  constexpr auto sizes = std::to_array<std::pair<std::string_view, std::size_t>>(
      {{"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
       {"compression", 1}, {"double", 8},   {"envmap", 1},
       {"float", 4},       {"int", 4},      {"keycode", 28},
       {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
       {"m44d", 128},      {"m44f", 64},    {"rational", 8},
       {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
       {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
       {"v3f", 12},        {"v3i", 12},     {"deepImageState", 1}});
  const auto found =
      std::ranges::find(sizes, type, &std::pair<std::string_view, std::size_t>::first);
  if (found == sizes.end()) return std::nullopt;
  return found->second;
}

// Channels: a name, its end, and 16 bytes each; an empty name ends the list.
bool are_channels(std::string_view value) {
  constexpr std::size_t rest_of_channel = 16;
  std::size_t at = 0;
  while (at < value.size() && value[at] != '\0') {
    const std::size_t end = value.find('\0', at);
    if (end == std::string_view::npos || end - at > longest_name) return false;
    at = end + 1 + rest_of_channel;
  }
  return at + 1 == value.size();
}

// Strings, each behind its length.
bool are_strings(std::string_view value) {
  constexpr std::size_t head = sizeof(std::int32_t);
  while (value.size() >= head) {
    const std::int32_t length = number_at(value, 0);
    value.remove_prefix(head);
    if (length < 0 || static_cast<std::size_t>(length) > value.size()) return false;
    value.remove_prefix(static_cast<std::size_t>(length));
  }
  return value.empty();
}

// A small picture: width, height, and four bytes for each pixel.
bool is_preview(std::string_view value) {
  constexpr std::size_t head = 2 * sizeof(std::int32_t);
  if (value.size() < head) return false;
  const std::int64_t width = number_at(value, 0), height = number_at(value, head / 2);
  const auto pixels = static_cast<std::int64_t>((value.size() - head) / 4);
  if (width < 0 || height < 0 || (value.size() - head) % 4 != 0) return false;
  return width == 0 || height == 0 ? pixels == 0 : pixels % width == 0 && pixels / width == height;
}

// True if OpenEXR reads as many bytes of a value as the file says, which it does not compare, and
// takes no more memory than these.
bool is_sound(std::string_view type, std::string_view value) {
  if (const auto size = bytes_of(type)) return value.size() == *size;
  if (type == "chlist") return are_channels(value);
  if (type == "stringvector") return are_strings(value);
  if (type == "preview") return is_preview(value);
  if (type == "floatvector") return value.size() % sizeof(float) == 0;
  return type != "idmanifest";  // of deep pictures, whose uncompressed size OpenEXR trusts
}

// Sizes by which OpenEXR takes memory when it opens a part.
struct PartSize {
  double width = 0.0, height = 0.0, channels = 0.0;
  double lines = 1.0;                          // of a block
  double tile_width = 0.0, tile_height = 0.0;  // 0: no tiles

  void note(std::string_view name, std::string_view type, std::string_view value) {
    if (name == "dataWindow" && type == "box2i") {
      width = 1.0 + number_at(value, 8) - number_at(value, 0);
      height = 1.0 + number_at(value, 12) - number_at(value, 4);
    } else if (type == "chlist") {
      for (std::size_t at = 0; at + 1 < value.size(); at = value.find('\0', at) + 17) ++channels;
    } else if (type == "compression") {
      // None, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
      constexpr std::array<double, 10> all = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
      const auto code = static_cast<std::size_t>(static_cast<unsigned char>(value[0]));
      if (code < all.size()) lines = all[code];
    } else if (type == "tiledesc") {
      tile_width = static_cast<std::uint32_t>(number_at(value, 0));
      tile_height = static_cast<std::uint32_t>(number_at(value, 4));
    }
  }

  // Memory for a block of lines is that of all its lines, however low the picture is.
  bool is_in_proportion(double bytes) const {
    // An even block of 2048 x 256 pixels takes some 130 bytes (DWAB).
    constexpr double most_of_a_byte = 8192.0;
    constexpr double usual = 0x1p28, each = 4.0;
    const double block = each * channels * std::max(width * lines, tile_width * tile_height);
    return width * height * channels <= most_of_a_byte * bytes && block <= std::max(usual, bytes);
  }
};

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
  PartSize part;
  for (std::string name, type, value; std::getline(file, name, '\0');) {
    if (name.empty()) {
      if (!part.is_in_proportion(static_cast<double>(end))) {
        throw InputError(
            fmt::format("{}: the file is too short for its {} x {} pixels of {} channels; it was "
                        "damaged or cut off",
                        path.string(), part.width, part.height, part.channels));
      }
      if (begins || !has_parts) return;
      begins = true;
      part = {};
      continue;
    }
    begins = false;
    std::getline(file, type, '\0');
    const std::int32_t size = number(file);
    const auto fail = [&](std::string_view what_is_wrong) {
      throw InputError(
          fmt::format("{}: the attribute '{}' of its header {}; it was damaged or cut "
                      "off",
                      path.string(), name.substr(0, longest_name), what_is_wrong));
    };
    if (!file || size < 0 || size > end - static_cast<std::int64_t>(file.tellg())) {
      fail("does not end within the file");
    }
    value.resize(static_cast<std::size_t>(size));
    file.read(value.data(), size);
    if (name.size() > longest_name || type.size() > longest_name || !is_sound(type, value)) {
      fail("is not what its type and its size say");
    }
    part.note(name, type, value);
  }
}

}  // namespace lightwell
