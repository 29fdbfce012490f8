#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <ostream>
#include <stdexcept>

#include "raytrace/pictures/image.h"
#include "raytrace/pictures/picture_output.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"
#include "scene/io/pictures/exr_header.h"

namespace lightwell {
namespace {

const std::array<const char*, 3> rgb_names = {"R", "G", "B"};

// Output stream that throws on errors. OpenEXR writes its line table in a destructor, which
// swallows exceptions, but the underlying stream keeps its error state for AtomicStream::commit().
class ExrStream : public Imf::OStream {
 public:
  ExrStream(AtomicStream& file, const std::string& name)
      : Imf::OStream(name.c_str()), file_(file), stream_(file.stream()) {}
  void write(const char c[], int n) override {
    if (!stream_.write(c, n)) throw std::runtime_error(file_.failure());
  }
  std::uint64_t tellp() override { return static_cast<std::uint64_t>(stream_.tellp()); }
  void seekp(std::uint64_t pos) override { stream_.seekp(static_cast<std::streamoff>(pos)); }

 private:
  AtomicStream& file_;
  std::ostream& stream_;
};

// One channel of an EXR file: the values first[0], first[step], first[2 step], ... are the pixels'.
struct ChannelPlane {
  std::string name{};
  const float* first = nullptr;
  Eigen::Index step = 0;
  bool may_be_half = true;
};

// Returns false for channels that half floats would spoil: distances, patch numbers, and light in
// cd/m^2 and lx, which exceeds 65504.
bool may_be_half(const std::string& channel) {
  return std::ranges::none_of(
      std::array{Layer::depth, Layer::patch, Layer::luminance, Layer::illuminance},
      [&](Layer layer) { return channel_names(layer).front() == channel; });
}

void add_planes(std::vector<ChannelPlane>& planes, const std::vector<std::string>& names,
                const BandArray& values) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    planes.push_back({.name = names[k],
                      .first = values.data() + k,
                      .step = values.cols(),
                      .may_be_half = may_be_half(names[k])});
  }
}

BandArray rgb_of_bands(const Image& image, const Bands& bands) {
  BandArray rgb(image.radiance.rows(), 3);
  for (Eigen::Index i = 0; i < rgb.rows(); ++i) {
    const Spectrum L = image.radiance.row(i).transpose();
    rgb.row(i).head<3>() = linear_rgb(bands, L).transpose();
  }
  return rgb;
}

Imf::Slice slice(Imf::PixelType type, const void* first, std::size_t pixel, int width) {
  return {type, static_cast<char*>(const_cast<void*>(first)), pixel, pixel * width};
}

std::vector<half> halves(const ChannelPlane& plane, const Image& image,
                         const std::filesystem::path& path) {
  std::vector<half> result(static_cast<std::size_t>(image.radiance.rows()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const float value = plane.first[static_cast<Eigen::Index>(i) * plane.step];
    constexpr float largest = HALF_MAX;
    if (std::isfinite(value) && std::abs(value) > largest) {
      fail_write(path, fmt::format("channel '{}' is {:.6g} at pixel ({}, {}), and half floats end "
                                   "at {}; write it without half floats",
                                   plane.name, value, i % image.width, i / image.width, largest));
    }
    result[i] = value;
  }
  return result;
}

Imf::Compression imf_compression(ExrCompression compression) {
  switch (compression) {
    case ExrCompression::none:
      return Imf::NO_COMPRESSION;
    case ExrCompression::rle:
      return Imf::RLE_COMPRESSION;
    case ExrCompression::zips:
      return Imf::ZIPS_COMPRESSION;
    case ExrCompression::piz:
      return Imf::PIZ_COMPRESSION;
    case ExrCompression::zip:
      break;
  }
  return Imf::ZIP_COMPRESSION;
}

void add_attribute(Imf::Header& header, const std::string& key, const ImageAttribute& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    header.insert(key, Imf::FloatAttribute(static_cast<float>(*number)));
  } else if (const auto* v = std::get_if<Eigen::Vector3d>(&value)) {
    header.insert(key, Imf::V3dAttribute({v->x(), v->y(), v->z()}));
  } else {
    header.insert(key, Imf::StringAttribute(std::get<std::string>(value)));
  }
}

struct ImageSize {
  int width = 0, height = 0;
};

ImageSize window_size(const Imf::InputFile& file, const std::string& name) {
  const auto window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0 || width > max_image_pixels || height > max_image_pixels / width) {
    throw InputError(fmt::format("{}: {} x {} pixels; at most {} pixels are read", name, width,
                                 height, max_image_pixels));
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

void require_full_resolution(const Imf::Channel& channel, const std::string& channel_name,
                             const std::string& name) {
  if (channel.xSampling == 1 && channel.ySampling == 1) return;
  throw InputError(fmt::format(
      "{}: channel '{}' is subsampled; save the image with full resolution", name, channel_name));
}

// Reads channels of a file, one per column.
BandArray read_exr_channels(Imf::InputFile& file, const std::vector<std::string>& channels,
                            const std::string& name) {
  const auto [width, height] = window_size(file, name);
  const auto window = file.header().dataWindow();
  const auto columns = static_cast<std::ptrdiff_t>(channels.size());
  BandArray values(std::int64_t{width} * height, columns);
  Imf::FrameBuffer buffer;
  for (std::ptrdiff_t k = 0; k < columns; ++k) {
    // The frame buffer counts pixels from the file's own origin.
    const std::ptrdiff_t origin = window.min.x + window.min.y * static_cast<std::ptrdiff_t>(width);
    buffer.insert(channels[k], slice(Imf::FLOAT, values.data() + k - columns * origin,
                                     columns * sizeof(float), width));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return values;
}

Image read_image(Imf::InputFile& file, const std::string& name, ExrChannels which) {
  const Imf::ChannelList& list = file.header().channels();
  const std::vector<std::string> rgb(rgb_names.begin(), rgb_names.end());
  const auto [width, height] = window_size(file, name);
  for (const std::string& channel : rgb) {
    const Imf::Channel* found = list.findChannel(channel);
    if (!found) {
      throw InputError(
          fmt::format("{}: has no channel '{}'; an image needs R, G and B", name, channel));
    }
    require_full_resolution(*found, channel, name);
  }
  Image image{.width = width, .height = height};
  image.radiance = read_exr_channels(file, rgb, name);
  if (which == ExrChannels::rgb) return image;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string channel = it.name();
    if (std::ranges::find(rgb, channel) != rgb.end()) continue;
    if (which == ExrChannels::bands && !channel.ends_with("nm")) continue;
    require_full_resolution(it.channel(), channel, name);
    image.layers.names.push_back(channel);
  }
  if (!image.layers.is_empty())
    image.layers.values = read_exr_channels(file, image.layers.names, name);
  return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const ImageMetadata& metadata, const ExrOptions& options) {
  check_writable(image, bands, path);
  const bool is_rgb = bands.wavelengths_nm.empty();
  const BandArray rgb = is_rgb ? BandArray() : rgb_of_bands(image, bands);
  std::vector<ChannelPlane> planes;
  add_planes(planes, {rgb_names.begin(), rgb_names.end()}, is_rgb ? image.radiance : rgb);
  if (!is_rgb) add_planes(planes, bands.names, image.radiance);
  add_planes(planes, image.layers.names, image.layers.values);

  // Values of the half-float planes until the file is written.
  std::vector<std::vector<half>> kept;
  for (const ChannelPlane& plane : planes) {
    if (options.half && plane.may_be_half) kept.push_back(halves(plane, image, path));
  }
  AtomicStream output(path);
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = imf_compression(options.compression);
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
    for (const auto& [key, value] : metadata) add_attribute(header, key, value);
    Imf::FrameBuffer buffer;
    auto next_half = kept.begin();
    for (const ChannelPlane& plane : planes) {
      const bool is_half = options.half && plane.may_be_half;
      header.channels().insert(plane.name, Imf::Channel(is_half ? Imf::HALF : Imf::FLOAT));
      buffer.insert(plane.name,
                    is_half
                        ? slice(Imf::HALF, (next_half++)->data(), sizeof(half), image.width)
                        : slice(Imf::FLOAT, plane.first, plane.step * sizeof(float), image.width));
    }
    ExrStream exr_stream(output, path.string());
    Imf::OutputFile file(exr_stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  } catch (const std::bad_alloc&) {
    throw;  // the file is not to blame
  } catch (const std::exception& error) {
    if (!output.stream()) output.close();  // throws with the reason alone
    fail_write(path, error.what());
  }
  output.commit();
}

Image read_exr(const std::filesystem::path& path, ExrChannels which) {
  const std::string name = path.string();
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(fmt::format("{}: there is no such file", name));
  }
  check_exr_header(path);
  try {
    Imf::InputFile file(name.c_str());
    return read_image(file, name, which);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;  // the file is not to blame
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot be read as OpenEXR: {}", name, error.what()));
  }
}

}  // namespace lightwell
