#include "scene/io/pictures/environment_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scene/errors.h"
#include "scene/io/pictures/exr_header.h"
#include "scene/io/text_file.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

constexpr std::int64_t most_environment_pixels = std::int64_t{1} << 26;

[[noreturn]] void fail_environment(const std::filesystem::path& path, std::string_view problem) {
  throw InputError(fmt::format("{}: {}", path.string(), problem));
}

void check_environment_size(const std::filesystem::path& path, std::int64_t width,
                            std::int64_t height) {
  if (width < 1 || height < 1 || width > most_environment_pixels ||
      height > most_environment_pixels / width) {
    fail_environment(path, fmt::format("has {} x {} pixels; an environment map has at most {}",
                                       width, height, most_environment_pixels));
  }
}

LightPixels read_exr_pixels(const std::filesystem::path& path) {
  check_exr_header(path);
  try {
    Imf::InputFile file(path.string().c_str());
    const auto window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_environment_size(path, width, height);
    LightPixels pixels{.width = static_cast<int>(width),
                       .height = static_cast<int>(height),
                       .rgb = BandArray::Zero(width * height, 3)};
    Imf::FrameBuffer buffer;
    constexpr std::array names = {"R", "G", "B"};
    constexpr std::ptrdiff_t pixel = 3 * sizeof(float);
    // OpenEXR addresses pixels by the file's absolute coordinates, so the base pointer is shifted
    // by the minimum of the data window.
    const std::ptrdiff_t origin = window.min.x + window.min.y * std::ptrdiff_t{width};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const Imf::Channel* channel = file.header().channels().findChannel(names[k]);
      if (!channel || channel->xSampling != 1 || channel->ySampling != 1) {
        fail_environment(
            path, fmt::format("has no channel '{}' at full resolution; save it as RGB", names[k]));
      }
      auto* first = reinterpret_cast<char*>(pixels.rgb.data() + k);
      buffer.insert(names[k], Imf::Slice(Imf::FLOAT, first - pixel * origin, pixel,
                                         static_cast<std::size_t>(pixel * width)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return pixels;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;  // the file is not to blame
  } catch (const std::exception& error) {
    fail_environment(path, fmt::format("cannot be read as OpenEXR: {}", error.what()));
  }
}

// Uses of a RADIANCE picture: as light, or as a pattern, where RADIANCE leaves EXPOSURE in and
// takes old files, which do not begin with "#?".
enum class RgbeUse { light, pattern };

// A RADIANCE picture (Ward 1991, "Real pixels"): header lines, an empty line, the resolution, and
// rows of shared-exponent pixels, run-length encoded or not.
class RgbeFile {
 public:
  explicit RgbeFile(const std::filesystem::path& path) : path_(path), file_(path) {
    rest_ = file_.text();
  }

  LightPixels read(RgbeUse use) {
    if (use == RgbeUse::light && !rest_.starts_with("#?"))
      fail_environment(path_, "is no RADIANCE picture: it does not begin with '#?'");
    double exposure = 1.0;
    for (std::string_view text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe") {
        fail_environment(path_,
                         fmt::format("is in the {}; only FORMAT=32-bit_rle_rgbe is read", text));
      }
      constexpr std::string_view key = "EXPOSURE=";
      if (text.starts_with(key)) exposure *= number(text.substr(key.size()));
    }
    if (use == RgbeUse::pattern) exposure = 1.0;
    const auto [width, height] = resolution(line());
    LightPixels pixels{.width = width, .height = height};
    pixels.rgb = BandArray::Zero(std::int64_t{width} * height, 3);
    std::vector<std::uint8_t> row(4 * static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      read_row(row);
      for (int x = 0; x < width; ++x) {
        const std::uint8_t* p = row.data() + 4 * x;
        if (p[3] == 0) continue;
        constexpr int bias = 128 + 8;
        for (int k = 0; k < 3; ++k) {
          pixels.rgb(std::int64_t{y} * width + x, k) =
              static_cast<float>(std::ldexp(p[k] + 0.5, p[3] - bias) / exposure);
        }
      }
    }
    return pixels;
  }

 private:
  std::string_view line() {
    const auto end = rest_.find('\n');
    if (end == std::string_view::npos) fail_environment(path_, "ends within its header");
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  double number(std::string_view text) const {
    const auto value = parse_finite(trimmed(text));
    if (!value || !(*value > 0.0)) {
      fail_environment(path_,
                       fmt::format("has an EXPOSURE of '{}', which is no number above 0", text));
    }
    return *value;
  }

  std::pair<int, int> resolution(std::string_view text) const {
    std::string_view rest = text;
    std::array<std::int64_t, 2> size{};
    bool is_sound = true;
    for (std::size_t i = 0; i < 2; ++i) {
      is_sound = is_sound && next_word(rest) == (i == 0 ? "-Y" : "+X");
      const std::string_view word = next_word(rest);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), size[i]);
      is_sound = is_sound && error == std::errc() && end == word.data() + word.size();
    }
    if (!is_sound || !trimmed(rest).empty()) {
      fail_environment(
          path_, fmt::format("has the resolution '{}'; only '-Y height +X width' is read", text));
    }
    // An even row of 32 767 pixels takes twelve bytes, in runs of the older kind.
    constexpr std::int64_t most_of_a_byte = 4096;
    check_environment_size(path_, size[1], size[0]);
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path_));
    if (size[0] * size[1] / most_of_a_byte > bytes) {
      fail_environment(path_, fmt::format("is too short for its {} x {} pixels; it was damaged or "
                                          "cut off",
                                          size[1], size[0]));
    }
    return {static_cast<int>(size[1]), static_cast<int>(size[0])};
  }

  std::uint8_t byte() {
    if (rest_.empty()) fail_environment(path_, "ends before its last pixel");
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }

  void read_row(std::span<std::uint8_t> row) {
    const std::size_t width = row.size() / 4;
    constexpr std::size_t shortest_packed = 8, longest_packed = 32767;
    const bool may_be_packed = width >= shortest_packed && width <= longest_packed;
    if (may_be_packed && rest_.size() >= 4 && rest_[0] == 2 && rest_[1] == 2 &&
        (static_cast<std::uint8_t>(rest_[2]) & 0x80) == 0) {
      rest_.remove_prefix(4);
      for (std::size_t k = 0; k < 4; ++k) read_component(row, k, width);
      return;
    }
    std::size_t x = 0;
    int shift = 0;
    while (x < width) {
      std::array<std::uint8_t, 4> p{};
      for (std::uint8_t& value : p) value = byte();
      if (p[0] == 1 && p[1] == 1 && p[2] == 1 && x > 0) {  // a run: repeats the last pixel
        const std::size_t count = std::size_t{p[3]} << shift;
        if (shift > 16 || count > width - x)
          fail_environment(path_, "has a run beyond the end of its row");
        for (std::size_t i = 0; i < 4 * count; ++i) row[4 * x + i] = row[4 * x - 4 + i % 4];
        x += count;
        shift += 8;
        continue;
      }
      std::copy(p.begin(), p.end(), row.begin() + static_cast<std::ptrdiff_t>(4 * x));
      ++x;
      shift = 0;
    }
  }

  void read_component(std::span<std::uint8_t> row, std::size_t k, std::size_t width) {
    for (std::size_t x = 0; x < width;) {
      const std::uint8_t code = byte();
      constexpr std::uint8_t longest = 128;
      const bool is_run = code > longest;
      const std::size_t count = is_run ? code - longest : code;
      if (count == 0 || count > width - x)
        fail_environment(path_, "has a run beyond the end of its row");
      const std::uint8_t same = is_run ? byte() : std::uint8_t{0};
      for (std::size_t i = 0; i < count; ++i) row[4 * x++ + k] = is_run ? same : byte();
    }
  }

  const std::filesystem::path& path_;
  TextFile file_;
  std::string_view rest_;
};

}  // namespace

LightPixels read_light_pixels(const std::filesystem::path& path) {
  require_readable(path);
  const std::string extension = lower_extension(path);
  LightPixels pixels;
  if (extension == ".exr") {
    pixels = read_exr_pixels(path);
  } else if (extension == ".hdr" || extension == ".pic" || extension == ".rgbe") {
    pixels = RgbeFile(path).read(RgbeUse::light);
  } else {
    fail_environment(path, "is no picture of light that is read: give an .exr or .hdr");
  }
  const float most = pixels.rgb.maxCoeff();
  if (most > most_light) {
    fail_environment(path,
                     fmt::format("has a pixel of {:g}; at most {:g} is read", most, most_light));
  }
  return pixels;
}

std::shared_ptr<const EnvironmentMap> read_environment_map(const std::filesystem::path& path) {
  LightPixels pixels = read_light_pixels(path);
  try {
    return std::make_shared<const EnvironmentMap>(pixels.width, pixels.height,
                                                  std::move(pixels.rgb));
  } catch (const std::invalid_argument& error) {
    fail_environment(path, error.what());
  }
}

BandArray read_rgbe_values(const std::filesystem::path& path) {
  require_readable(path);
  return RgbeFile(path).read(RgbeUse::pattern).rgb;
}

}  // namespace lightwell
