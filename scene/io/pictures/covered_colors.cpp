#include "scene/io/pictures/covered_colors.h"

#include <Eigen/Core>
#include <algorithm>

namespace lightwell {
namespace {

// A level of the pyramid: red, green and blue times the cover, and the cover in [0,1].
struct Level {
  std::size_t width = 0, height = 0;
  std::vector<Eigen::Array4f> texels{};

  Eigen::Array4f& at(std::size_t x, std::size_t y) { return texels[y * width + x]; }
  const Eigen::Array4f& at(std::size_t x, std::size_t y) const { return texels[y * width + x]; }
};

// Returns the level of half the size; `texel(x, y)` is that of a level of width x height. A texel
// is as covered as the sum of its four, up to 1: one covered pixel decides its surroundings.
template <class Texel>
Level pulled(std::size_t width, std::size_t height, Texel texel) {
  Level half{.width = (width + 1) / 2, .height = (height + 1) / 2};
  half.texels.assign(half.width * half.height, Eigen::Array4f::Zero());
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) half.at(x / 2, y / 2) += texel(x, y);
  }
  for (Eigen::Array4f& sum : half.texels) sum /= std::max(sum[3], 1.0f);
  return half;
}

// Fills what a level does not cover with the colours of the coarser one.
void push(const Level& coarse, Level& fine) {
  for (std::size_t y = 0; y < fine.height; ++y) {
    for (std::size_t x = 0; x < fine.width; ++x) {
      Eigen::Array4f& texel = fine.at(x, y);
      texel += (1.0f - texel[3]) * coarse.at(x / 2, y / 2);
    }
  }
}

}  // namespace

std::vector<Texture::Code> covered_colors(std::span<const unsigned char> rgba, std::size_t width,
                                          std::span<const double, 256> linear) {
  const std::size_t height = rgba.size() / 4 / width;
  const auto pixel = [&](std::size_t x, std::size_t y) -> Eigen::Array4f {
    const unsigned char* at = &rgba[4 * (y * width + x)];
    const float alpha = static_cast<float>(at[3]) / 255.0f;
    return {alpha * static_cast<float>(linear[at[0]]), alpha * static_cast<float>(linear[at[1]]),
            alpha * static_cast<float>(linear[at[2]]), alpha};
  };
  std::vector<Level> levels{pulled(width, height, pixel)};
  while (levels.back().texels.size() > 1) {
    const Level& fine = levels.back();
    levels.push_back(pulled(fine.width, fine.height,
                            [&](std::size_t x, std::size_t y) { return fine.at(x, y); }));
  }
  Eigen::Array4f& all = levels.back().texels.front();
  if (all[3] > 0.0f) all /= all[3];
  for (std::size_t i = levels.size() - 1; i-- > 0;) push(levels[i + 1], levels[i]);
  std::vector<Texture::Code> colors;
  colors.reserve(3 * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Eigen::Array4f own = pixel(x, y);
      const Eigen::Array4f filled = own + (1.0f - own[3]) * levels.front().at(x / 2, y / 2);
      for (int c = 0; c < 3; ++c) colors.push_back(Texture::encode(filled[c]));
    }
  }
  return colors;
}

}  // namespace lightwell
