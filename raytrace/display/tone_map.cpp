#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "raytrace/display/display.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/pictures/image.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int pixel_grain = 4096;

Eigen::Array3f pixel_rgb(const Image& image, const Bands& bands, Eigen::Index i) {
  const Spectrum L = image.radiance.row(i).transpose();
  return linear_rgb(bands, L);
}

// Picture in linear RGB after exposure and white balance; white is 1.
class ScaledPicture {
 public:
  ScaledPicture(const Image& image, const Bands& bands, const Eigen::Array3f& scale)
      : width_(image.width), height_(image.height), rgb_(image.radiance.rows()) {
    parallel_for(static_cast<int>(rgb_.size()), pixel_grain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        rgb_[i] = pixel_rgb(image, bands, i) * scale;
      }
    });
  }

  const Eigen::Array3f& at(int x, int y) const { return rgb_[std::size_t(y) * width_ + x]; }

  // Display value of a pixel, softened at the edge of a lamp. The mean of lamp and wall in such a
  // pixel is still far above white, so the pixel would show as lamp and the edge as a staircase.
  // The softened value is the mean of the display values of the brightest neighbour and the pixel
  // opposite, in the proportion that gives the pixel's own luminance.
  Eigen::Array3f shown_softly(int x, int y, ToneCurve curve) const {
    const auto shown = [&](int i, int j) { return display_rgb(at(i, j), 1.0, curve); };
    Eigen::Array3f own = shown(x, y);
    int dx = 0, dy = 0;
    double brightest = luminance(at(x, y));
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (!contains(x + i, y + j) || !contains(x - i, y - j)) continue;
        const double Y = luminance(at(x + i, y + j));
        if (!(Y > brightest)) continue;
        brightest = Y;
        dx = i;
        dy = j;
      }
    }
    // In units of white; below this value the shoulder is not flat yet.
    constexpr double lamp = 2.0;
    const double darker = luminance(at(x - dx, y - dy)), Y = luminance(at(x, y));
    if (!(brightest > lamp && brightest > Y && Y >= darker)) return own;
    const auto covered = static_cast<float>((Y - darker) / (brightest - darker));
    const Eigen::Array3f mixed =
        covered * shown(x + dx, y + dy) + (1.0f - covered) * shown(x - dx, y - dy);
    return mixed.min(own);
  }

 private:
  bool contains(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }

  int width_, height_;
  std::vector<Eigen::Array3f> rgb_;
};

}  // namespace

double luminance(const Eigen::Array3f& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

float shoulder(float x) {
  constexpr float knee = 0.5f;
  if (x <= knee) return x;
  return knee + (1.0f - knee) * -std::expm1(-(x - knee) / (1.0f - knee));
}

float srgb_encode(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

float filmic(float x) {
  const auto curve = [](float y) {
    constexpr float A = 0.15f, B = 0.50f, C = 0.10f, D = 0.20f, E = 0.02f, F = 0.30f;
    return (y * (A * y + C * B) + D * E) / (y * (A * y + B) + D * F) - E / F;
  };
  constexpr float bias = 2.0f, white = 11.2f;
  return curve(std::clamp(bias * x, 0.0f, white)) / curve(white);
}

float aces_like(float x) {
  constexpr float brightest = 65536.0f;  // far above where the curve reaches 1, and finite
  using Fit = AcesFit;
  const double y = std::clamp(x, 0.0f, brightest);
  return static_cast<float>(
      std::min(1.0, y * (Fit::a * y + Fit::b) / (y * (Fit::c * y + Fit::d) + Fit::e)));
}

Eigen::Array3f display_rgb(const Eigen::Array3f& linear, double scale, ToneCurve curve) {
  const Eigen::Array3f x = linear * static_cast<float>(scale);
  Eigen::Array3f shown = x;
  if (curve == ToneCurve::shoulder) shown = x.unaryExpr([](float c) { return shoulder(c); });
  if (curve == ToneCurve::filmic) shown = x.unaryExpr([](float c) { return filmic(c); });
  if (curve == ToneCurve::aces) shown = x.unaryExpr([](float c) { return aces_like(c); });
  if (curve == ToneCurve::reinhard) {
    constexpr double white = 4.0;
    const double Y = luminance(x);
    if (Y > 0.0) shown *= static_cast<float>((1.0 + Y / (white * white)) / (1.0 + Y));
  }
  return shown.unaryExpr([](float c) { return std::isnan(c) ? 0.0f : std::clamp(c, 0.0f, 1.0f); });
}

double luminance_of_white(double ev100) {
  constexpr double q = 0.65;  // factor of lens and vignetting
  return 78.0 / (100.0 * q) * std::exp2(ev100);
}

double ev100_of_scale(double scale, const Bands& bands) {
  return std::log2(bands.lumens_per_watt / (scale * luminance_of_white(0.0)));
}

double exposure_scale(const Image& image, const Bands& bands, const ToneMapping& options) {
  const double stops = std::exp2(options.exposure_ev);
  if (options.ev100) return stops * bands.lumens_per_watt / luminance_of_white(*options.ev100);
  if (!options.automatic) return stops;
  if (options.metered_scale) return stops * *options.metered_scale;
  // Display luminance of the typical luminance of the picture, with white = 1 (sRGB byte 124). The
  // value is a little above the photographic 0.18, since a room seen whole has no sky that needs
  // headroom.
  constexpr double key = 0.2;
  const std::optional<double> Y = typical_luminance(image, bands);
  return Y ? stops * key / *Y : stops;
}

std::vector<std::uint8_t> tone_map(const Image& image, const Bands& bands,
                                   const ToneMapping& options) {
  const auto scale = static_cast<float>(exposure_scale(image, bands, options));
  const ScaledPicture picture(image, bands, scale * options.balance);
  // Under the linear curve equal radiance gives equal bytes, so nothing is softened.
  const bool is_soft = options.curve != ToneCurve::linear;
  std::vector<std::uint8_t> bytes(std::size_t{3} * image.width * image.height);
  parallel_for(image.height, 1, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const Eigen::Array3f shown = is_soft ? picture.shown_softly(x, y, options.curve)
                                             : display_rgb(picture.at(x, y), 1.0, options.curve);
        std::uint8_t* pixel = bytes.data() + 3 * (std::size_t(y) * image.width + x);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * srgb_encode(shown[c])));
        }
      }
    }
  });
  return bytes;
}

}  // namespace lightwell
