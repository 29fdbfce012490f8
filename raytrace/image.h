#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
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

/// Stored with an image: camera, units, version, how it was made. In a PNG all are texts.
using ImageAttribute = std::variant<std::string, double, Eigen::Vector3d>;
using ImageMetadata = std::vector<std::pair<std::string, ImageAttribute>>;

/// Those without loss.
enum class ExrCompression { none, rle, zips, zip, piz };

struct ExrOptions {
  /// 16-bit floats: half the size, 11 bits of precision, up to 65504. Depth, patch, luminance and
  /// illuminance stay 32-bit.
  bool half = false;
  ExrCompression compression = ExrCompression::zip;
};

/// Scanline OpenEXR. RGB bands become channels R, G, B; other bands become linear sRGB R, G, B plus
/// one channel per band named after it; layers follow under their names. Written to a temporary
/// name and renamed; throws std::runtime_error naming the file, and a value that is too large for
/// half floats.
void write_exr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const ImageMetadata& metadata = {}, const ExrOptions& options = {});

/// Channels R, G, B of an EXR file (half or float) as radiance; with `bands`, those of wavelengths
/// ("400-404nm") as layers, with `all`, all others, in the order of their names. Throws InputError
/// if missing or not an EXR with R, G and B.
enum class ExrChannels { rgb, bands, all };
Image read_exr(const std::filesystem::path& path, ExrChannels which = ExrChannels::rgb);

/// How exposed light becomes what a screen shows.
enum class ToneCurve {
  shoulder,  ///< in proportion up to half of white, then an exponential towards white
  linear,    ///< in proportion, cut off at white
  reinhard,  ///< Reinhard et al. 2002, equation 4, of luminance; white is 4 times the exposed white
  filmic,    ///< Hable 2010: a photographic film's toe and shoulder
};

struct ToneMapping {
  double exposure_ev = 0.0;  ///< stops, on top of what the others say
  bool automatic = true;     ///< exposed for the picture; false: radiance 1 is white
  /// Exposed as a camera set to this exposure value at ISO 100, whatever `automatic`: white is
  /// 1.2 * 2^EV100 cd/m^2, see luminance_of_white. Only where the unit of light is known.
  std::optional<double> ev100{};
  ToneCurve curve = ToneCurve::shoulder;
};

/// cd/m^2 that an exposure value makes the largest a sensor takes: L = 78 / (100 q) 2^EV100 with
/// q = 0.65, by the saturation-based speed of ISO 12232 (Lagarde & de Rousiers 2014).
double luminance_of_white(double ev100);
/// The exposure value at ISO 100 that a multiplier of radiance amounts to: the other way round.
double ev100_of_scale(double scale, const Bands& bands);

/// 8-bit sRGB, 3 bytes a pixel, row 0 on top. Documented in docs/tone-mapping.md.
std::vector<std::uint8_t> tone_map(const Image& image, const Bands& bands,
                                   const ToneMapping& options = {});

/// The multiplier tone_map uses, for viewers that must look the same.
double exposure_scale(const Image& image, const Bands& bands, const ToneMapping& options = {});

/// sRGB-encoded bytes to PNG; same promises as write_exr.
void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& rgb, const ImageMetadata& metadata = {});

}  // namespace lightwell
