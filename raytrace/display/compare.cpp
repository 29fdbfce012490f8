#include "raytrace/display/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/display/display.h"
#include "raytrace/display/flip.h"
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

// Returns RGB as given, and the grey of the bands' mean for any other bands, whose meaning an Image
// does not carry.
Image as_rgb(const Image& image) {
  if (image.radiance.cols() == 3) return image;
  Image rgb{.width = image.width, .height = image.height};
  rgb.radiance = image.radiance.rowwise().mean().replicate(1, 3);
  return rgb;
}

// Oklab: lightness and two opponent axes in which equal distances look about equally different
// (Ottosson 2020, "A perceptual color space for image processing"). The distance of black and white
// is 1.
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

// Returns the linear display values of a picture under the reference's exposure, so that a
// difference of brightness counts.
Image shown(const Image& rgb, const Image& reference) {
  const double scale = exposure_scale(reference, rgb_bands());
  Image result{.width = rgb.width, .height = rgb.height};
  result.radiance.resize(rgb.radiance.rows(), 3);
  for (Eigen::Index i = 0; i < rgb.radiance.rows(); ++i) {
    result.radiance.row(i).head<3>() =
        display_rgb(rgb.radiance.row(i).head<3>().transpose(), scale).transpose();
  }
  return result;
}

double perceptual_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < b.radiance.rows(); ++i) {
    const auto lab = [i](const Image& image) {
      return oklab(image.radiance.row(i).head<3>().transpose());
    };
    sum += std::min(1.0f, (lab(a) - lab(b)).matrix().norm());
  }
  return sum / static_cast<double>(b.radiance.rows());
}

// Names of the spectral bands among the layers, such as "400-404nm".
std::vector<std::string> band_names(const Image& image) {
  std::vector<std::string> names;
  for (const std::string& name : image.layers.names) {
    if (name.ends_with("nm")) names.push_back(name);
  }
  return names;
}

BandArray column(const Image& image, const std::string& name) {
  const auto& names = image.layers.names;
  return image.layers.values.col(std::find(names.begin(), names.end(), name) - names.begin());
}

void check_bands(const Image& a, const Image& b) {
  const std::vector<std::string> of_a = band_names(a), of_b = band_names(b);
  if (of_a.empty() || of_b.empty()) return;  // RGB alone is compared
  const auto require_all = [](const std::vector<std::string>& names, const auto& in,
                              const char* which) {
    for (const std::string& name : names) {
      if (std::find(in.begin(), in.end(), name) != in.end()) continue;
      throw InputError(fmt::format(
          "the {} image has no channel '{}', which the other has; compare pictures of one scene",
          which, name));
    }
  };
  require_all(of_a, of_b, "second");
  require_all(of_b, of_a, "first");
  for (const Image* image : {&a, &b}) {
    for (const std::string& name : of_b) {
      const BandArray values = column(*image, name);
      for (Eigen::Index i = 0; i < values.rows(); ++i) {
        if (std::isfinite(values(i, 0))) continue;
        throw InputError(fmt::format(
            "the {} image has a value that is not finite in channel '{}' at pixel ({}, {})",
            image == &a ? "first" : "second", name, i % image->width, i / image->width));
      }
    }
  }
}

// Pixels that count, and their squares.
class Kept {
 public:
  Kept(const Image& reference, const CompareOptions& options)
      : width_(reference.width), height_(reference.height), block_(options.block) {
    if (block_ < 1) throw InputError(fmt::format("a block of {} pixels; 1 is least", block_));
    if (!(options.exclude_above > 0.0)) {
      throw InputError(fmt::format("pixels above {} cannot be left out; give a number above 0",
                                   options.exclude_above));
    }
    for (Eigen::Index i = 0; i < reference.radiance.rows(); ++i) {
      const bool is_out = reference.radiance.row(i).maxCoeff() > options.exclude_above;
      out_.push_back(is_out ? 1 : 0);
      out_count_ += is_out ? 1 : 0;
    }
    if (out_count_ == reference.radiance.rows()) {
      throw InputError(
          fmt::format("every pixel of the reference is above {:g}: nothing is left to "
                      "compare",
                      options.exclude_above));
    }
  }

  double excluded() const {
    return static_cast<double>(out_count_) / static_cast<double>(out_.size());
  }

  // Means over each square that has any pixel: squares x bands.
  Eigen::ArrayXXd means(const BandArray& values) const {
    const Eigen::Index across = (width_ + block_ - 1) / block_,
                       down = (height_ + block_ - 1) / block_;
    Eigen::ArrayXXd sums = Eigen::ArrayXXd::Zero(across * down, values.cols());
    Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(across * down);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      if (out_[static_cast<std::size_t>(i)]) continue;
      const Eigen::Index square = i / width_ / block_ * across + i % width_ / block_;
      sums.row(square) += values.row(i).cast<double>();
      counts[square] += 1.0;
    }
    Eigen::Index filled = 0;
    for (Eigen::Index square = 0; square < counts.size(); ++square) {
      if (counts[square] > 0.0) sums.row(filled++) = (sums.row(square) / counts[square]).eval();
    }
    return sums.topRows(filled);
  }

 private:
  int width_, height_, block_;
  std::vector<char> out_{};
  Eigen::Index out_count_ = 0;
};

BandDifference difference(const std::string& band, const Eigen::ArrayXXd& A,
                          const Eigen::ArrayXXd& B) {
  BandDifference result{.band = band,
                        .rmse = std::sqrt((A - B).square().mean()),
                        .max_difference = (A - B).abs().maxCoeff(),
                        .mean_a = A.mean(),
                        .mean_b = B.mean()};
  result.relative_rmse = result.rmse > 0.0 ? result.rmse / result.mean_b : 0.0;
  return result;
}

// Colours of a glowing body, even in lightness, for `share` from 0 to 1: black, violet, red,
// orange, yellow, white.
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

ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options) {
  check_comparable(a, b);
  check_bands(a, b);
  const Kept kept(b, options);
  const Eigen::ArrayXXd A = kept.means(a.radiance), B = kept.means(b.radiance);
  const BandDifference all = difference("", A, B);
  ImageDifference result{.rmse = all.rmse,
                         .relative_rmse = all.relative_rmse,
                         .max_difference = all.max_difference,
                         .mean_a = all.mean_a,
                         .mean_b = all.mean_b,
                         .excluded = kept.excluded()};
  static constexpr std::array<const char*, 3> rgb = {"R", "G", "B"};
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    const std::string name = A.cols() == 3 ? rgb[k] : std::to_string(k);
    result.bands.push_back(difference(name, A.col(k), B.col(k)));
  }
  const bool both_are_spectral = !band_names(a).empty();
  for (const std::string& name : both_are_spectral ? band_names(b) : std::vector<std::string>()) {
    result.bands.push_back(
        difference(name, kept.means(column(a, name)), kept.means(column(b, name))));
  }
  const Image rgb_a = as_rgb(a), rgb_b = as_rgb(b);
  const Image shown_a = shown(rgb_a, rgb_b), shown_b = shown(rgb_b, rgb_b);
  result.perceptual = perceptual_difference(shown_a, shown_b);
  result.flip = flip(shown_a, shown_b).cast<double>().mean();
  result.hdr_flip = hdr_flip(rgb_a, rgb_b).cast<double>().mean();
  return result;
}

HalvesDifference compare_with_halves(const Image& a, const Image& first, const Image& second,
                                     const CompareOptions& options) {
  check_comparable(a, first);
  check_comparable(a, second);
  Image reference{.width = a.width, .height = a.height};
  reference.radiance = 0.5f * (first.radiance + second.radiance);
  const Kept kept(reference, options);
  const Eigen::ArrayXXd A = kept.means(a.radiance), H1 = kept.means(first.radiance),
                        H2 = kept.means(second.radiance);
  HalvesDifference result;
  result.mean_square = ((A - H1) * (A - H2)).mean();
  result.rmse = std::sqrt(std::max(0.0, result.mean_square));
  result.reference_noise = 0.5 * std::sqrt((H1 - H2).square().mean());
  result.mean_a = A.mean();
  result.mean_reference = 0.5 * (H1.mean() + H2.mean());
  result.relative_rmse = result.rmse > 0.0 ? result.rmse / result.mean_reference : 0.0;
  result.excluded = kept.excluded();
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
