#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/display.h"
#include "raytrace/image.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int pixel_grain = 4096;

// ITU-R BT.709.
double luminance(const Eigen::Array3f& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

Eigen::Array3f pixel_rgb(const Image& image, const Bands& bands, Eigen::Index i) {
  const Spectrum L = image.radiance.row(i).transpose();
  return linear_rgb(bands, L);
}

// Luminance of every pixel that shows something.
std::vector<double> positive_luminances(const Image& image, const Bands& bands) {
  std::vector<double> result;
  result.reserve(image.radiance.rows());
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
    const double Y = luminance(pixel_rgb(image, bands, i));
    if (Y > 0.0 && std::isfinite(Y)) result.push_back(Y);
  }
  return result;
}

// Geometric mean of what lies within `spread` of the median: lamps and windows above, black corners
// below do not pull the exposure.
double typical_luminance(std::vector<double> Y) {
  constexpr double spread = 10.0;
  const auto middle = Y.begin() + static_cast<std::ptrdiff_t>(Y.size() / 2);
  std::nth_element(Y.begin(), middle, Y.end());
  const double median = *middle;
  double sum = 0.0;
  int count = 0;
  for (double y : Y) {
    if (y < median / spread || y > median * spread) continue;
    sum += std::log(y);
    ++count;
  }
  return std::exp(sum / count);
}

}  // namespace

float shoulder(float x) {
  constexpr float knee = 0.5f;
  if (x <= knee) return x;
  return knee + (1.0f - knee) * -std::expm1(-(x - knee) / (1.0f - knee));
}

float srgb_encode(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

Eigen::Array3f display_rgb(const Eigen::Array3f& linear, double scale, bool with_shoulder) {
  Eigen::Array3f result;
  for (int c = 0; c < 3; ++c) {
    const float x = linear[c] * static_cast<float>(scale);
    const float shown = with_shoulder ? shoulder(x) : x;
    result[c] = std::isnan(shown) ? 0.0f : std::clamp(shown, 0.0f, 1.0f);
  }
  return result;
}

double exposure_scale(const Image& image, const Bands& bands, const ToneMapping& options) {
  const double stops = std::exp2(options.exposure_ev);
  if (!options.automatic) return stops;
  // Where the typical luminance of the picture lands, of white = 1 (sRGB byte 124): a little above
  // the photographic 0.18, because a room seen whole has no sky to leave headroom for.
  constexpr double key = 0.2;
  const std::vector<double> Y = positive_luminances(image, bands);
  return Y.empty() ? stops : stops * key / typical_luminance(Y);
}

std::vector<std::uint8_t> tone_map(const Image& image, const Bands& bands,
                                   const ToneMapping& options) {
  const double scale = exposure_scale(image, bands, options);
  const int pixels = static_cast<int>(image.radiance.rows());
  std::vector<std::uint8_t> bytes(std::size_t{3} * pixels);
  parallel_for(pixels, pixel_grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Eigen::Array3f shown =
          display_rgb(pixel_rgb(image, bands, i), scale, options.automatic);
      for (int c = 0; c < 3; ++c) {
        bytes[std::size_t{3} * i + c] =
            static_cast<std::uint8_t>(255.0f * srgb_encode(shown[c]) + 0.5f);
      }
    }
  });
  return bytes;
}

}  // namespace lightwell
