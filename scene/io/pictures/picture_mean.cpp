#include "scene/io/pictures/picture_mean.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <string_view>
#include <vector>

// jpeglib.h needs <cstdio> but does not include it.
#include <jpeglib.h>

#include "scene/errors.h"
#include "scene/io/pictures/covered_colors.h"
#include "scene/io/pictures/environment_file.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// 10 000 x 10 000: larger pictures take seconds and gigabytes.
constexpr double most_picture_pixels = 1e8;

// Pixels of one byte of a JPEG. The emptiest picture has a bit for each of six blocks in 16 x 16
// pixels: 340.
constexpr double most_of_a_jpeg_byte = 1024.0;

// Pixels of one byte of a PNG: deflate makes at most 1032 bytes of one, of eight pixels each.
constexpr double most_of_a_png_byte = 8.0 * 1032.0;

// Scans of a progressive JPEG, each of which costs time as for the whole picture. Programs write
// ten.
constexpr int most_jpeg_scans = 100;

// Eight bits each of r, g, b and alpha, rows from the top.
struct PicturePixels {
  std::size_t width = 0, height = 0, count = 0;
  std::vector<unsigned char> bytes{};
};

void check_picture_size(double width, double height, const std::string& called) {
  if (width * height <= most_picture_pixels) return;
  throw InputError(fmt::format("{} has {} x {} pixels; at most {:g} are read", called, width,
                               height, most_picture_pixels));
}

[[noreturn]] void fail_damaged(const std::string& called, const char* why) {
  throw InputError(fmt::format("{} is no picture that can be decoded: {}", called, why));
}

// Chunks are a length, a type, as many bytes, and a CRC. libpng takes memory for a text of the
// length that is claimed before it reads the text.
void check_png_chunks(std::string_view bytes, const std::string& called) {
  constexpr std::size_t signature = 8, head = 8, crc = 4;
  for (std::size_t at = signature; at + head <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    if (length > bytes.size() - at - head) fail_damaged(called, "a chunk does not end");
    if (bytes.substr(at + 4, 4) == "IEND") return;
    at += head + length + crc;
  }
}

PicturePixels decode_png(std::string_view bytes, const std::string& called) {
  check_png_chunks(bytes, called);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) {
    fail_damaged(called, image.message);
  }
  struct Guard {
    png_image& image;
    ~Guard() { png_image_free(&image); }
  } const guard{image};
  check_picture_size(image.width, image.height, called);
  if (static_cast<double>(image.width) * image.height >
      most_of_a_png_byte * static_cast<double>(bytes.size())) {
    fail_damaged(called, "it is too short for its width and height");
  }
  image.format = PNG_FORMAT_RGBA;
  // 16-bit files without a statement are sRGB, as 8-bit ones are.
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  PicturePixels pixels{.width = image.width,
                       .height = image.height,
                       .count = std::size_t{image.width} * image.height};
  pixels.bytes.resize(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, pixels.bytes.data(), 0, nullptr)) {
    fail_damaged(called, image.message);
  }
  return pixels;
}

struct JpegError {
  jpeg_error_mgr base{};  // first, so that libjpeg's pointer to it is a pointer to this
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> message{};
};

void leave(j_common_ptr decoder) {
  auto* error = reinterpret_cast<JpegError*>(decoder->err);
  decoder->err->format_message(decoder, error->message.data());
  std::longjmp(error->jump, 1);
}

void leave_after_many_scans(j_common_ptr decoder) {
  if (reinterpret_cast<j_decompress_ptr>(decoder)->input_scan_number <= most_jpeg_scans) return;
  auto* error = reinterpret_cast<JpegError*>(decoder->err);
  std::snprintf(error->message.data(), error->message.size(), "it has more than %d scans",
                most_jpeg_scans);
  std::longjmp(error->jump, 1);
}

bool is_too_large(const jpeg_decompress_struct& decoder, std::size_t bytes) {
  const double pixels = static_cast<double>(decoder.image_width) * decoder.image_height;
  return pixels > std::min(most_picture_pixels, most_of_a_jpeg_byte * static_cast<double>(bytes));
}

// longjmp skips destructors, so no object with a destructor is created here: `rgb` belongs to the
// caller.
bool read_jpeg(std::string_view bytes, JpegError& error, jpeg_decompress_struct& decoder,
               std::vector<unsigned char>& rgb) {
  if (setjmp(error.jump)) return false;
  jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&decoder, TRUE);
  if (is_too_large(decoder, bytes.size())) return true;
  decoder.out_color_space = JCS_RGB;
  jpeg_start_decompress(&decoder);
  const std::size_t width = std::size_t{3} * decoder.output_width;
  rgb.resize(width * decoder.output_height);
  while (decoder.output_scanline < decoder.output_height) {
    unsigned char* row = rgb.data() + width * decoder.output_scanline;
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  return true;
}

PicturePixels decode_jpeg(std::string_view bytes, const std::string& called) {
  JpegError error;
  jpeg_decompress_struct decoder{};
  decoder.err = jpeg_std_error(&error.base);
  error.base.error_exit = &leave;
  error.base.emit_message = [](j_common_ptr, int) {};  // warnings: parts of the picture are missing
  jpeg_create_decompress(&decoder);
  jpeg_progress_mgr progress{};
  progress.progress_monitor = &leave_after_many_scans;
  decoder.progress = &progress;
  std::vector<unsigned char> rgb;
  const bool is_read = read_jpeg(bytes, error, decoder, rgb);
  const double width = decoder.image_width, height = decoder.image_height;
  jpeg_destroy_decompress(&decoder);
  if (!is_read) fail_damaged(called, error.message.data());
  check_picture_size(width, height, called);
  if (rgb.empty()) {
    throw InputError(
        fmt::format("{} is too short for its {} x {} pixels; it was damaged or cut off", called,
                    width, height));
  }
  PicturePixels pixels{.width = static_cast<std::size_t>(width),
                       .height = static_cast<std::size_t>(height),
                       .count = rgb.size() / 3};
  pixels.bytes.reserve(4 * pixels.count);
  for (std::size_t p = 0; p < pixels.count; ++p) {
    pixels.bytes.insert(pixels.bytes.end(), {rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2], 255});
  }
  return pixels;
}

// Linear values of the 256 codes.
std::array<double, 256> linear_values(PictureCode code) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    linear[i] = code == PictureCode::srgb ? linear_from_srgb(value) : value;
  }
  return linear;
}

PictureMean mean_of_pixels(const PicturePixels& pixels, PictureCode code) {
  const std::array<double, 256> linear = linear_values(code);
  PictureMean mean{.alpha = 0.0};
  for (std::size_t p = 0; p < pixels.count; ++p) {
    const unsigned char* at = &pixels.bytes[4 * p];
    const double alpha = at[3] / 255.0;
    const Eigen::Array3d color(linear[at[0]], linear[at[1]], linear[at[2]]);
    mean.color += color;
    mean.covered_color += alpha * color;
    mean.alpha += alpha;
  }
  const auto count = static_cast<double>(pixels.count);
  mean.color /= count;
  mean.covered_color =
      mean.alpha > 0.0 ? Eigen::Array3d(mean.covered_color / mean.alpha) : mean.color;
  mean.alpha /= count;
  return mean;
}

std::shared_ptr<const Texture> texture_of(const PicturePixels& pixels, std::size_t first_channel,
                                          std::size_t channels, PictureCode code) {
  std::array<Texture::Code, 256> codes{};
  const std::array<double, 256> linear = linear_values(code);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    codes[i] = Texture::encode(static_cast<float>(linear[i]));
  }
  std::vector<Texture::Code> texels;
  texels.reserve(channels * pixels.count);
  for (std::size_t p = 0; p < pixels.count; ++p) {
    for (std::size_t c = 0; c < channels; ++c) {
      texels.push_back(codes[pixels.bytes[4 * p + first_channel + c]]);
    }
  }
  return std::make_shared<const Texture>(static_cast<int>(pixels.width),
                                         static_cast<int>(pixels.height),
                                         static_cast<int>(channels), std::move(texels));
}

Picture picture_of(const PicturePixels& pixels, PictureCode code) {
  Picture picture{.color = texture_of(pixels, 0, 3, code), .mean = mean_of_pixels(pixels, code)};
  if (!(picture.mean.alpha < 1.0)) return picture;
  picture.alpha = texture_of(pixels, 3, 1, PictureCode::linear);
  picture.covered = std::make_shared<const Texture>(
      static_cast<int>(pixels.width), static_cast<int>(pixels.height), 3,
      covered_colors(pixels.bytes, pixels.width, linear_values(code)));
  return picture;
}

bool holds_light(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return std::ranges::any_of(std::array{".exr", ".hdr", ".pic", ".rgbe"},
                             [&](const char* of_light) { return extension == of_light; });
}

LightPicture light_picture_of(const LightPixels& pixels, const std::filesystem::path& path) {
  if (!(pixels.rgb >= 0.0f).all() || !pixels.rgb.isFinite().all()) {
    throw InputError(fmt::format("{}: has pixels that are negative or no numbers", path.string()));
  }
  const float most = pixels.rgb.maxCoeff();
  const float brightest = most > 0.0f ? most : 1.0f;
  std::vector<Texture::Code> texels;
  texels.reserve(static_cast<std::size_t>(pixels.rgb.size()));
  for (Eigen::Index p = 0; p < pixels.rgb.rows(); ++p) {
    for (int c = 0; c < 3; ++c) texels.push_back(Texture::encode(pixels.rgb(p, c) / brightest));
  }
  return {
      .color = std::make_shared<const Texture>(pixels.width, pixels.height, 3, std::move(texels)),
      .brightest = brightest};
}

std::optional<PicturePixels> decode(std::string_view bytes, const std::string& called) {
  if (bytes.starts_with("\x89PNG")) return decode_png(bytes, called);
  if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes, called);
  return std::nullopt;
}

std::string name_of(const std::filesystem::path& path) {
  return fmt::format("{}: the file", path.string());
}

}  // namespace

std::shared_ptr<const Texture> channel_of(const Texture& picture, int channel) {
  std::vector<Texture::Code> texels;
  texels.reserve(static_cast<std::size_t>(picture.width()) *
                 static_cast<std::size_t>(picture.height()));
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      texels.push_back(Texture::encode(picture.texel(0, x, y)[channel]));
    }
  }
  return std::make_shared<const Texture>(picture.width(), picture.height(), 1, std::move(texels));
}

double linear_from_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::optional<PictureMean> picture_mean(std::string_view bytes, PictureCode code,
                                        const std::string& called) {
  const auto pixels = decode(bytes, called);
  if (!pixels) return std::nullopt;
  return mean_of_pixels(*pixels, code);
}

std::optional<Picture> read_picture(std::string_view bytes, PictureCode code,
                                    const std::string& called) {
  const auto pixels = decode(bytes, called);
  if (!pixels) return std::nullopt;
  return picture_of(*pixels, code);
}

std::optional<PictureMean> PictureFiles::mean(const std::filesystem::path& path, PictureCode code) {
  const auto known = known_.find({path, code});
  if (known != known_.end()) return known->second;
  const TextFile file(path);
  const auto result = picture_mean(file.text(), code, name_of(path));
  known_.emplace(std::pair(path, code), result);
  return result;
}

std::optional<Picture> PictureFiles::picture(const std::filesystem::path& path, PictureCode code) {
  const auto known = pictures_.find({path, code});
  if (known != pictures_.end()) return known->second;
  const TextFile file(path);
  return pictures_.emplace(std::pair(path, code), read_picture(file.text(), code, name_of(path)))
      .first->second;
}

std::optional<LightPicture> PictureFiles::light(const std::filesystem::path& path,
                                                PictureCode code) {
  if (!holds_light(path)) {
    const auto shown = picture(path, code);
    if (!shown) return std::nullopt;
    return LightPicture{.color = shown->color};
  }
  const auto known = lights_.find(path);
  if (known != lights_.end()) return known->second;
  return lights_.emplace(path, light_picture_of(read_light_pixels(path), path)).first->second;
}

}  // namespace lightwell
