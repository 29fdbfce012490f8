#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "raytrace/pictures/image.h"
#include "raytrace/pictures/picture_output.h"
#include "scene/atomic_file.h"

namespace lightwell {
namespace {

// Weights of R, G and B in RADIANCE's luminance, and its lumens per watt (Ward 1994).
const Eigen::Array3d radiance_weights(0.265, 0.670, 0.065);
constexpr double radiance_efficacy = 179.0;

// R, G and B that RADIANCE's programs read with the luminance of L.
Eigen::Array3d radiance_rgb(const Bands& bands, const Spectrum& L) {
  const Eigen::Array3d rgb = linear_rgb(bands, L).cast<double>().max(0.0);
  const double weighted = (radiance_weights * rgb).sum();
  if (!(weighted > 0.0)) return Eigen::Array3d::Zero();
  return luminous(bands, L) / (radiance_efficacy * weighted) * rgb;
}

// Mantissas of 8 bits and a common exponent; black is all zeros.
std::array<char, 4> rgbe(const Eigen::Array3d& rgb) {
  constexpr double least = 1e-32, most = 1e38, bias = 128;
  const double largest = std::min(most, rgb.maxCoeff());
  if (!(largest > least)) return {};
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto byte = [&](double value) {
    const double steps = std::floor(std::ldexp(value, 8 - exponent));
    return static_cast<char>(static_cast<std::uint8_t>(std::min(255.0, steps)));
  };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2]),
          static_cast<char>(static_cast<std::uint8_t>(exponent + bias))};
}

}  // namespace

void write_hdr(const std::filesystem::path& path, const Image& image, const Bands& bands,
               const std::vector<std::string>& header) {
  check_writable(image, bands, path);
  AtomicStream output(path);
  output.stream() << "#?RADIANCE\n";
  for (const std::string& line : header) output.stream() << line << '\n';
  output.stream() << "FORMAT=32-bit_rle_rgbe\n\n-Y " << image.height << " +X " << image.width
                  << '\n';
  // Pixels are not run-length encoded, which the format allows.
  std::vector<std::array<char, 4>> row(static_cast<std::size_t>(image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Spectrum L = image.radiance.row(Eigen::Index{y} * image.width + x).transpose();
      row[static_cast<std::size_t>(x)] = rgbe(radiance_rgb(bands, L));
    }
    output.stream().write(row.front().data(), static_cast<std::streamsize>(4 * row.size()));
  }
  output.commit();
}

}  // namespace lightwell
