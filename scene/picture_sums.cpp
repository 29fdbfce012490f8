#include "scene/picture_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell {
namespace {

// The squares of Texture::Code that make a share of 1.
constexpr double full = 65535.0 * 65535.0;

// An interval as a sum of intervals of whole texels that begin at `first`, with weights.
struct WholeTexels {
  int first = 0;
  std::array<int, 3> end{};
  std::array<double, 3> weight{};
};

WholeTexels whole_texels(double low, double high, int size) {
  const int first = std::clamp(static_cast<int>(low), 0, size - 1);
  const int last = std::clamp(static_cast<int>(high), 0, size - 1);
  const double before = low - first, after = high - last;
  return {
      .first = first, .end = {last, last + 1, first + 1}, .weight = {1.0 - after, after, -before}};
}

}  // namespace

TexelRect TexelRect::within(const TexelRect& other) const {
  return {.left = std::max(left, other.left),
          .right = std::min(right, other.right),
          .top = std::max(top, other.top),
          .bottom = std::min(bottom, other.bottom)};
}

PictureSums::PictureSums(std::shared_ptr<const Texture> picture) : picture_(std::move(picture)) {
  const int width = picture_->width(), height = picture_->height();
  const int channels = picture_->channels();
  const std::size_t row = std::size_t(width + 1) * std::size_t(channels);
  sums_.assign(row * std::size_t(height + 1), 0);
  for (int y = 0; y < height; ++y) {
    std::array<std::uint64_t, 3> along{};
    for (int x = 0; x < width; ++x) {
      const Eigen::Array3f texel = picture_->texel(0, x, y);
      for (int c = 0; c < channels; ++c) {
        const std::uint64_t code = Texture::encode(texel[c]);
        std::uint64_t& sum = along[std::size_t(c)];
        sum += code * code;
        const std::size_t at = std::size_t(x + 1) * std::size_t(channels) + std::size_t(c);
        sums_[std::size_t(y + 1) * row + at] = sums_[std::size_t(y) * row + at] + sum;
      }
    }
  }
}

TexelRect PictureSums::whole() const {
  return {.right = static_cast<double>(picture_->width()),
          .bottom = static_cast<double>(picture_->height())};
}

double PictureSums::block(int left, int right, int top, int bottom, int channel) const {
  const auto channels = static_cast<std::size_t>(picture_->channels());
  const std::size_t row = std::size_t(picture_->width() + 1) * channels;
  const auto at = [&](int x, int y) {
    return sums_[std::size_t(y) * row + std::size_t(x) * channels + std::size_t(channel)];
  };
  return static_cast<double>(at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top));
}

Eigen::Array3d PictureSums::over(const TexelRect& window) const {
  const WholeTexels along = whole_texels(window.left, window.right, picture_->width());
  const WholeTexels down = whole_texels(window.top, window.bottom, picture_->height());
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (std::size_t j = 0; j < down.end.size(); ++j) {
    for (std::size_t i = 0; i < along.end.size(); ++i) {
      const double weight = along.weight[i] * down.weight[j];
      if (weight == 0.0) continue;
      for (int c = 0; c < picture_->channels(); ++c) {
        sum[c] += weight * block(along.first, along.end[i], down.first, down.end[j], c);
      }
    }
  }
  if (picture_->channels() == 1) sum.fill(sum[0]);
  return (sum / full).max(0.0);
}

}  // namespace lightwell
