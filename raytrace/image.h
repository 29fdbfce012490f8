#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "raytrace/layers.h"
#include "scene/bands.h"

namespace lightwell {

/// Radiance, W/(m^2 sr) per band; pixel (x, y) is row y * width + x of `radiance`, row 0 on top.
struct Image {
  int width = 0, height = 0;
  BandArray radiance{};
  LayerColumns layers{};  ///< empty, or as many rows as radiance
};

/// The largest picture that is rendered, written or read: 805 MB of RGB. A hostile or torn header
/// may ask for no more than this before a byte of it is believed.
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 26;

/// Free text stored with an image: camera, units, version, how it was made.
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

/// 32-bit float scanline OpenEXR. RGB bands become channels R, G, B; other bands become linear sRGB
/// R, G, B plus one channel per band named after it. Written to a temporary name and renamed;
/// throws std::runtime_error naming the file.
void write_exr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const ImageMetadata& metadata = {});

/// Channels R, G, B of an EXR file (half or float). Throws InputError if missing or not an EXR with
/// those channels.
Image read_exr(const std::filesystem::path& path);

struct ToneMapping {
  double exposure_ev = 0.0;  ///< added to the automatic exposure, in stops
  bool automatic = true;     ///< false: radiance is multiplied by 2^exposure_ev alone
};

/// 8-bit sRGB, 3 bytes a pixel, row 0 on top. Documented in docs/tone-mapping.md.
std::vector<std::uint8_t> tone_map(const Image& image, const Bands& bands,
                                   const ToneMapping& options = {});

/// The multiplier tone_map uses, for viewers that must look the same.
double exposure_scale(const Image& image, const Bands& bands, const ToneMapping& options = {});

/// sRGB-encoded bytes to PNG; same promises as write_exr.
void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& rgb, const ImageMetadata& metadata = {});

}  // namespace lightwell
