#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "raytrace/pictures/encode_png.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pictures/picture_output.h"
#include "scene/atomic_file.h"

namespace lightwell {
namespace {

// Data of one call of libpng. libpng reports errors through longjmp, which must not skip
// destructors of C++ objects: the caller owns all memory, and run_png() holds plain data alone.
struct PngJob {
  std::ostream* stream;
  int width, height;
  int channels;  ///< 3, or 4 with alpha
  png_bytep* rows;
  png_text* texts = nullptr;
  int text_count = 0;
  char message[200] = {};
};

void png_write_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto& stream = *static_cast<std::ostream*>(png_get_io_ptr(png));
  if (!stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size))) {
    png_error(png, "a write failed");
  }
}

void png_flush_bytes(png_structp) {}

void png_on_error(png_structp png, png_const_charp message) {
  auto& job = *static_cast<PngJob*>(png_get_error_ptr(png));
  std::snprintf(job.message, sizeof job.message, "%s", message);
  std::longjmp(png_jmpbuf(png), 1);
}

void png_on_warning(png_structp, png_const_charp) {}

bool run_png(PngJob& job) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, png_on_error, png_on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) {
    std::snprintf(job.message, sizeof job.message, "libpng could not be started");
    png_destroy_write_struct(&png, nullptr);
    return false;
  }
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, job.stream, png_write_bytes, png_flush_bytes);
  png_set_IHDR(png, info, static_cast<png_uint_32>(job.width), static_cast<png_uint_32>(job.height),
               8, job.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (job.text_count > 0) png_set_text(png, info, job.texts, job.text_count);
  png_write_info(png, info);
  png_write_image(png, job.rows);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

std::vector<png_bytep> row_pointers(int height, std::span<const std::uint8_t> pixels) {
  std::vector<png_bytep> rows(static_cast<std::size_t>(height));
  const std::size_t row = pixels.size() / rows.size();
  for (int y = 0; y < height; ++y) rows[y] = const_cast<png_bytep>(pixels.data()) + row * y;
  return rows;
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 128; });
}

png_text png_entry(const std::string& key, const std::string& value) {
  png_text text{};
  // tEXt is Latin-1, iTXt is UTF-8; texts beyond ASCII go into iTXt.
  const bool ascii = is_ascii(value);
  text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
  text.key = const_cast<char*>(key.c_str());
  text.text = const_cast<char*>(value.c_str());
  (ascii ? text.text_length : text.itxt_length) = value.size();
  return text;
}

}  // namespace

std::string encode_png(int width, int height, std::span<const std::uint8_t> pixels) {
  std::ostringstream stream;
  std::vector<png_bytep> rows = row_pointers(height, pixels);
  const std::size_t count = static_cast<std::size_t>(width) * height;
  PngJob job{.stream = &stream,
             .width = width,
             .height = height,
             .channels = static_cast<int>(pixels.size() / count),
             .rows = rows.data()};
  if (!run_png(job)) throw std::runtime_error(fmt::format("a PNG cannot be made: {}", job.message));
  return std::move(stream).str();
}

void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& rgb, const ImageMetadata& metadata) {
  const std::int64_t pixels = std::int64_t{width} * height;
  if (width <= 0 || height <= 0 || pixels > max_image_pixels ||
      static_cast<std::int64_t>(rgb.size()) != 3 * pixels) {
    fail_write(path, fmt::format("{} x {} pixels with {} bytes is not a picture of 1 to {} pixels",
                                 width, height, rgb.size(), max_image_pixels));
  }
  std::vector<png_bytep> rows = row_pointers(height, rgb);
  std::vector<std::string> values;  // png_text holds pointers to these strings
  for (const auto& [key, value] : metadata) values.push_back(to_text(value));
  std::vector<png_text> texts;
  for (std::size_t i = 0; i < metadata.size(); ++i) {
    const std::string& key = metadata[i].first;
    constexpr std::size_t longest_keyword = 79;  // PNG specification, 11.3.4.2
    if (key.empty() || key.size() > longest_keyword || !is_ascii(key)) {
      fail_write(path, fmt::format("'{}' is not a PNG keyword of 1 to 79 ASCII letters", key));
    }
    texts.push_back(png_entry(key, values[i]));
  }
  AtomicStream output(path);
  PngJob job{.stream = &output.stream(),
             .width = width,
             .height = height,
             .channels = 3,
             .rows = rows.data(),
             .texts = texts.data(),
             .text_count = static_cast<int>(texts.size())};
  if (!run_png(job)) {
    if (!output.stream()) output.close();  // throws with the reason
    fail_write(path, job.message);
  }
  output.commit();
}

}  // namespace lightwell
