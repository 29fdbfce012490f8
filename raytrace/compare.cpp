#include "raytrace/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/display.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

void check_comparable(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.radiance.rows() != b.radiance.rows()) {
    throw InputError(fmt::format(
        "images of different size cannot be compared: {} x {} and {} x {}; render both alike",
        a.width, a.height, b.width, b.height));
  }
  if (a.radiance.cols() != b.radiance.cols()) {
    throw InputError(fmt::format("images of {} and {} bands cannot be compared", a.radiance.cols(),
                                 b.radiance.cols()));
  }
  if (a.radiance.size() == 0) throw InputError("the images to compare have no pixels");
  for (const Image* image : {&a, &b}) {
    for (Eigen::Index i = 0; i < image->radiance.rows(); ++i) {
      if (image->radiance.row(i).isFinite().all()) continue;
      throw InputError(fmt::format("the {} image has a value that is not finite at pixel ({}, {})",
                                   image == &a ? "first" : "second", i % image->width,
                                   i / image->width));
    }
  }
}

// RGB as it is; other bands, whose meaning an Image does not carry, as grey of their mean.
Image as_rgb(const Image& image) {
  if (image.radiance.cols() == 3) return image;
  Image rgb{.width = image.width, .height = image.height};
  rgb.radiance = image.radiance.rowwise().mean().replicate(1, 3);
  return rgb;
}

// Lightness and two opponent axes in which equal distances look about equally different (Ottosson
// 2020, "A perceptual color space for image processing"); black to white is 1.
Eigen::Array3f oklab(const Eigen::Array3f& linear) {
  static const Eigen::Matrix3f cones =
      (Eigen::Matrix3f() << 0.4122214708f, 0.5363325363f, 0.0514459929f, 0.2119034982f,
       0.6806995451f, 0.1073969566f, 0.0883024619f, 0.2817188376f, 0.6299787005f)
          .finished();
  static const Eigen::Matrix3f opponents =
      (Eigen::Matrix3f() << 0.2104542553f, 0.7936177850f, -0.0040720468f, 1.9779984951f,
       -2.4285922050f, 0.4505937099f, 0.0259040371f, 0.7827717662f, -0.8086757660f)
          .finished();
  const Eigen::Vector3f lms =
      (cones * linear.matrix()).unaryExpr([](float x) { return std::cbrt(x); });
  return (opponents * lms).array();
}

// Both pictures under the reference's exposure: a change of brightness must count.
double perceptual_difference(const Image& a, const Image& b) {
  const double scale = exposure_scale(b, rgb_bands());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < b.radiance.rows(); ++i) {
    const auto shown = [&](const Image& image) {
      return oklab(display_rgb(image.radiance.row(i).transpose(), scale));
    };
    sum += std::min(1.0f, (shown(a) - shown(b)).matrix().norm());
  }
  return sum / static_cast<double>(b.radiance.rows());
}

// Colours of a glowing body, even in lightness: black, violet, red, orange, yellow, white.
std::array<std::uint8_t, 3> false_colour(double share) {
  static constexpr std::array<std::array<double, 3>, 6> stops = {
      {{0, 0, 0}, {68, 13, 110}, {186, 40, 60}, {240, 120, 20}, {252, 215, 80}, {255, 255, 255}}};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double w = place - static_cast<double>(left);
  std::array<std::uint8_t, 3> colour{};
  for (int c = 0; c < 3; ++c) {
    colour[c] =
        static_cast<std::uint8_t>(std::lround((1 - w) * stops[left][c] + w * stops[left + 1][c]));
  }
  return colour;
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b) {
  check_comparable(a, b);
  const auto A = a.radiance.cast<double>(), B = b.radiance.cast<double>();
  ImageDifference result;
  result.rmse = std::sqrt((A - B).square().mean());
  result.mean_a = A.mean();
  result.mean_b = B.mean();
  result.relative_rmse = result.rmse > 0.0 ? result.rmse / result.mean_b : 0.0;
  result.max_difference = (A - B).abs().maxCoeff();
  result.perceptual = perceptual_difference(as_rgb(a), as_rgb(b));
  return result;
}

std::vector<std::uint8_t> difference_picture(const Image& a, const Image& b, double full_scale) {
  check_comparable(a, b);
  if (!(full_scale > 0.0)) {
    throw InputError(
        fmt::format("the difference that shows as white must be above 0, not {}", full_scale));
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::size_t{3} * a.radiance.rows());
  for (Eigen::Index i = 0; i < a.radiance.rows(); ++i) {
    const double difference = (a.radiance.row(i) - b.radiance.row(i)).abs().mean();
    const auto colour = false_colour(difference / full_scale);
    bytes.insert(bytes.end(), colour.begin(), colour.end());
  }
  return bytes;
}

}  // namespace lightwell
