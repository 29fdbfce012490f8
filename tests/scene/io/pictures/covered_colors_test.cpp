#include "scene/io/pictures/covered_colors.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "scene/sampling.h"

namespace lightwell::covered_colors_test {
namespace {

struct Rgba {
  unsigned char r = 0, g = 0, b = 0, a = 0;
};

// The codes of a picture whose bytes are shares of 255.
std::vector<Texture::Code> codes_of(const std::vector<Rgba>& pixels, std::size_t width) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = static_cast<double>(i) / 255.0;
  std::vector<unsigned char> bytes;
  for (const Rgba& p : pixels) bytes.insert(bytes.end(), {p.r, p.g, p.b, p.a});
  return covered_colors(bytes, width, linear);
}

Texture::Code code(int byte) {
  return Texture::encode(static_cast<float>(byte / 255.0));
}

// Means of one colour differ from it by roundings: a code is 65535 sqrt(share), so that some 100
// roundings of 6e-8 of the share (ten levels of a few operations) move a code of at most 65535 by
// 65535 / 2 x 6e-6 = 0.2, and what is rounded to a whole code by one at most.
TEST(CoveredColors, OneColourFillsWhateverIsClear) {
  constexpr std::size_t width = 37, height = 21;
  std::vector<Rgba> pixels;
  for (std::uint64_t p = 0; p < width * height; ++p) {
    const double u = random_uniform(random_key(p, 1));
    if (u < 0.9) pixels.push_back({255, 255, 255, 0});
    if (u >= 0.9) pixels.push_back({40, 90, 10, static_cast<unsigned char>(u < 0.95 ? 255 : 100)});
  }
  const auto codes = codes_of(pixels, width);
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    EXPECT_NEAR(codes[3 * p], code(40), 1) << p;
    EXPECT_NEAR(codes[3 * p + 1], code(90), 1) << p;
    EXPECT_NEAR(codes[3 * p + 2], code(10), 1) << p;
  }
}

TEST(CoveredColors, OpaquePixelsKeepTheirOwn) {
  const std::vector<Rgba> pixels = {{200, 0, 7, 255}, {1, 2, 3, 0}, {9, 100, 8, 255}};
  const auto codes = codes_of(pixels, 3);
  for (const std::size_t p : {0U, 2U}) {
    EXPECT_EQ(codes[3 * p], code(pixels[p].r));
    EXPECT_EQ(codes[3 * p + 1], code(pixels[p].g));
    EXPECT_EQ(codes[3 * p + 2], code(pixels[p].b));
  }
  // The clear pixel in between shares a texel of the coarser level with the first.
  EXPECT_NEAR(codes[3], code(200), 1);
}

TEST(CoveredColors, NothingCoveredIsBlack) {
  for (const Texture::Code c : codes_of(std::vector<Rgba>(6, {255, 255, 255, 0}), 2)) {
    EXPECT_EQ(c, 0);
  }
}

}  // namespace
}  // namespace lightwell::covered_colors_test
