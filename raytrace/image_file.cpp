#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <fstream>
#include <stdexcept>

#include "raytrace/image.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

const std::array<const char*, 3> rgb_names = {"R", "G", "B"};

[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), why));
}

std::ofstream open_output(const std::filesystem::path& path, const std::filesystem::path& shown) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream) {
    fail_write(shown, "is its folder there, and may you write to it?");
  }
  return stream;
}

void close_output(std::ofstream& stream, const std::filesystem::path& shown) {
  stream.close();
  if (!stream) fail_write(shown, "the disk may be full");
}

// OpenEXR writes its line table in a destructor, which keeps errors to itself; a stream of our own
// remembers them.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(std::ofstream& stream, const std::string& name)
      : Imf::OStream(name.c_str()), stream_(stream) {}
  void write(const char c[], int n) override {
    if (!stream_.write(c, n)) throw std::runtime_error("the disk may be full");
  }
  std::uint64_t tellp() override { return static_cast<std::uint64_t>(stream_.tellp()); }
  void seekp(std::uint64_t pos) override { stream_.seekp(static_cast<std::streamoff>(pos)); }

 private:
  std::ofstream& stream_;
};

void check_size(const Image& image, const std::filesystem::path& path) {
  const std::int64_t pixels = std::int64_t{image.width} * image.height;
  if (image.width <= 0 || image.height <= 0 || pixels > max_image_pixels ||
      image.radiance.rows() != pixels) {
    fail_write(path,
               fmt::format("{} x {} pixels with {} values is not a picture of 1 to {} pixels",
                           image.width, image.height, image.radiance.rows(), max_image_pixels));
  }
}

// The columns of an EXR file: linear RGB first, then the bands themselves unless they are RGB.
struct Planes {
  std::vector<std::string> names{};
  BandArray values{};
};

Planes exr_planes(const Image& image, const Bands& bands) {
  Planes planes{.names = {rgb_names.begin(), rgb_names.end()}};
  if (bands.wavelengths_nm.empty()) {
    planes.values = image.radiance.leftCols<3>();
    return planes;
  }
  planes.names.insert(planes.names.end(), bands.names.begin(), bands.names.end());
  planes.values.resize(image.radiance.rows(), 3 + bands.count());
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
    const Spectrum L = image.radiance.row(i).transpose();
    planes.values.row(i).head<3>() = linear_rgb(bands, L).transpose();
  }
  planes.values.rightCols(bands.count()) = image.radiance;
  return planes;
}

Imf::Slice float_slice(float* first, int columns, int width) {
  const std::size_t pixel = columns * sizeof(float);
  return {Imf::FLOAT, reinterpret_cast<char*>(first), pixel, pixel * width};
}

Image read_rgb(Imf::InputFile& file, const std::string& name) {
  const auto window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0 || width > max_image_pixels || height > max_image_pixels / width) {
    throw InputError(fmt::format("{}: {} x {} pixels; at most {} pixels are read", name, width,
                                 height, max_image_pixels));
  }
  for (const char* channel : rgb_names) {
    const Imf::Channel* found = file.header().channels().findChannel(channel);
    if (!found) {
      throw InputError(
          fmt::format("{}: has no channel '{}'; an image needs R, G and B", name, channel));
    }
    if (found->xSampling != 1 || found->ySampling != 1) {
      throw InputError(fmt::format(
          "{}: channel '{}' is subsampled; save the image with full resolution", name, channel));
    }
  }
  Image image{.width = static_cast<int>(width), .height = static_cast<int>(height)};
  image.radiance.resize(width * height, 3);
  Imf::FrameBuffer buffer;
  for (int k = 0; k < 3; ++k) {
    // The frame buffer counts pixels from the file's own origin.
    const std::ptrdiff_t origin = window.min.x + window.min.y * static_cast<std::ptrdiff_t>(width);
    float* first = image.radiance.data() + k - 3 * origin;
    buffer.insert(rgb_names[k], float_slice(first, 3, image.width));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

// libpng reports through longjmp, which must not cross C++ objects: everything that owns memory is
// made by the caller, and this frame holds plain data alone.
struct PngJob {
  std::ofstream* stream;
  int width, height;
  png_bytep* rows;
  png_text* texts;
  int text_count;
  char message[200];
};

void png_write_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto& stream = *static_cast<std::ofstream*>(png_get_io_ptr(png));
  if (!stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size))) {
    png_error(png, "the disk may be full");
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
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (job.text_count > 0) png_set_text(png, info, job.texts, job.text_count);
  png_write_info(png, info);
  png_write_image(png, job.rows);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 128; });
}

png_text png_entry(const std::string& key, const std::string& value) {
  png_text text{};
  // tEXt is Latin-1; anything beyond ASCII goes into iTXt, which is UTF-8.
  const bool ascii = is_ascii(value);
  text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
  text.key = const_cast<char*>(key.c_str());
  text.text = const_cast<char*>(value.c_str());
  (ascii ? text.text_length : text.itxt_length) = value.size();
  return text;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const ImageMetadata& metadata) {
  check_size(image, path);
  if (image.radiance.cols() != bands.count()) {
    fail_write(path, fmt::format("the image has {} bands, its description {}",
                                 image.radiance.cols(), bands.count()));
  }
  Planes planes = exr_planes(image, bands);
  const int columns = static_cast<int>(planes.names.size());
  AtomicFile file(path);
  std::ofstream stream = open_output(file.temporary(), path);
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
    Imf::FrameBuffer buffer;
    for (int k = 0; k < columns; ++k) {
      header.channels().insert(planes.names[k], Imf::Channel(Imf::FLOAT));
      buffer.insert(planes.names[k], float_slice(planes.values.data() + k, columns, image.width));
    }
    ExrStream exr_stream(stream, path.string());
    Imf::OutputFile output(exr_stream, header);
    output.setFrameBuffer(buffer);
    output.writePixels(image.height);
  } catch (const std::exception& error) {
    fail_write(path, error.what());
  }
  close_output(stream, path);
  file.commit();
}

Image read_exr(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(fmt::format("{}: there is no such file", name));
  }
  try {
    Imf::InputFile file(name.c_str());
    return read_rgb(file, name);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot be read as OpenEXR: {}", name, error.what()));
  }
}

void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& rgb, const ImageMetadata& metadata) {
  const std::int64_t pixels = std::int64_t{width} * height;
  if (width <= 0 || height <= 0 || pixels > max_image_pixels ||
      static_cast<std::int64_t>(rgb.size()) != 3 * pixels) {
    fail_write(path, fmt::format("{} x {} pixels with {} bytes is not a picture of 1 to {} pixels",
                                 width, height, rgb.size(), max_image_pixels));
  }
  std::vector<png_bytep> rows(height);
  for (int y = 0; y < height; ++y) {
    rows[y] = const_cast<png_bytep>(rgb.data()) + std::size_t{3} * width * y;
  }
  std::vector<png_text> texts;
  for (const auto& [key, value] : metadata) {
    constexpr std::size_t longest_keyword = 79;  // PNG specification, 11.3.4.2
    if (key.empty() || key.size() > longest_keyword || !is_ascii(key)) {
      fail_write(path, fmt::format("'{}' is not a PNG keyword of 1 to 79 ASCII letters", key));
    }
    texts.push_back(png_entry(key, value));
  }
  AtomicFile file(path);
  std::ofstream stream = open_output(file.temporary(), path);
  PngJob job{.stream = &stream,
             .width = width,
             .height = height,
             .rows = rows.data(),
             .texts = texts.data(),
             .text_count = static_cast<int>(texts.size())};
  if (!run_png(job)) fail_write(path, job.message);
  close_output(stream, path);
  file.commit();
}

}  // namespace lightwell
