#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "raytrace/pictures/layers.h"
#include "scene/bands.h"

namespace lightwell {

/// Radiance, W/(m^2 sr) per band; pixel (x, y) is row y * width + x of `radiance`, row 0 on top.
struct Image {
  int width = 0, height = 0;
  BandArray radiance{};
  LayerColumns layers{};  ///< empty, or as many rows as radiance
};

/// Largest number of pixels that is rendered, written or read: 805 MB of RGB. The limit is checked
/// before memory is allocated for a hostile or damaged header.
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 26;

/// Metadata stored with an image: camera, units, version, options. All values are texts in a PNG.
using ImageAttribute = std::variant<std::string, double, Eigen::Vector3d>;
using ImageMetadata = std::vector<std::pair<std::string, ImageAttribute>>;

/// Lossless compressions of OpenEXR.
enum class ExrCompression { none, rle, zips, zip, piz };

struct ExrOptions {
  /// 16-bit floats: half the size, 11 bits of precision, up to 65504. Depth, patch, luminance and
  /// illuminance stay 32-bit.
  bool half = false;
  ExrCompression compression = ExrCompression::zip;
};

/// Writes a scanline OpenEXR file. RGB bands become channels R, G, B. Other bands become linear
/// sRGB R, G, B plus one channel per band, named after the band. Layers follow under their names.
///
/// The file is written under a temporary name and renamed. Throws std::runtime_error that names the
/// file if the image does not fit its bands, a value is too large for half floats, or writing
/// fails.
void write_exr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const ImageMetadata& metadata = {}, const ExrOptions& options = {});

/// Writes a RADIANCE picture (.hdr): R, G and B of 8 bits with a common exponent. Values are such
/// that 179 (0.265 R + 0.670 G + 0.065 B) is the luminance in cd/m^2, by which RADIANCE's programs
/// read them (Ward 1994). `header` are lines for the file's header, such as "VIEW= -vta ...".
/// Temporary name, renaming and errors as for write_exr.
void write_hdr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const std::vector<std::string>& header = {});

/// Channels to read of an EXR file: R, G and B, also those of wavelengths, or all.
enum class ExrChannels { rgb, bands, all };
/// Reads channels R, G, B of an EXR file, half or float, as radiance. ExrChannels::bands adds
/// channels of wavelengths ("400-404nm") as layers, ExrChannels::all adds all other channels, in
/// the order of their names. Throws InputError if the file is missing, not an EXR with R, G and B,
/// or larger than max_image_pixels, or if a channel is subsampled.
Image read_exr(const std::filesystem::path& path, ExrChannels which = ExrChannels::rgb);

/// Curve from exposed radiance to display values.
enum class ToneCurve {
  shoulder,  ///< linear up to half of white, then an exponential towards white
  linear,    ///< linear, clipped at white
  reinhard,  ///< Reinhard et al. 2002, equation 4, of luminance; white is 4 times the exposed white
  filmic,    ///< toe and shoulder of photographic film (Hable 2010)
  aces,      ///< Narkowicz's fit (2015) to the curve of the Academy Color Encoding System
};

struct ToneMapping {
  double exposure_ev = 0.0;  ///< stops, added to the exposure of the other options
  bool automatic = true;     ///< automatic exposure; false: radiance 1 is white
  /// Automatic exposure by the light that falls on what the camera sees (see IncidentLight);
  /// empty: by the picture's own luminances, whose typical one becomes 0.2 of white.
  std::optional<double> metered_scale{};
  /// Exposure value at ISO 100 of a camera, in place of `automatic`: white is 1.2 * 2^EV100 cd/m^2,
  /// see luminance_of_white. Meaningful only if the unit of light is known.
  std::optional<double> ev100{};
  ToneCurve curve = ToneCurve::shoulder;
  /// Factors of linear RGB before the curve (see white_balance()).
  Eigen::Array3f balance = Eigen::Array3f::Ones();
};

/// Luminance of white at an exposure value, cd/m^2: the largest that the sensor records, L = 78 /
/// (100 q) 2^EV100 with q = 0.65, by the saturation-based speed of ISO 12232 (Lagarde & de Rousiers
/// 2014).
double luminance_of_white(double ev100);
/// Exposure value at ISO 100 that corresponds to a multiplier of radiance, the inverse of
/// exposure_scale() with `ev100`.
double ev100_of_scale(double scale, const Bands& bands);

/// Tone-mapped picture: 8-bit sRGB, 3 bytes a pixel, row 0 on top. See docs/tone-mapping.md.
std::vector<std::uint8_t> tone_map(const Image& image, const Bands& bands,
                                   const ToneMapping& options = {});

/// Multiplier of radiance that tone_map() applies, for viewers that must match its pictures.
double exposure_scale(const Image& image, const Bands& bands, const ToneMapping& options = {});

/// Writes sRGB-encoded bytes, 3 per pixel, as a PNG file. Temporary name, renaming and errors as
/// for write_exr. Throws as well if a metadata key is no PNG keyword of 1 to 79 ASCII characters.
void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& rgb, const ImageMetadata& metadata = {});

}  // namespace lightwell
