#include "viewer/export/pack_rectangles.h"

#include <gtest/gtest.h>

namespace lightwell::pack_rectangles_test {
namespace {

std::vector<Eigen::Vector2i> many_sizes() {
  std::vector<Eigen::Vector2i> sizes;
  for (int i = 0; i < 300; ++i) sizes.emplace_back(3 + 7 * i % 31, 2 + 11 * i % 23);
  return sizes;
}

TEST(PackRectangles, NothingOverlapsOrSticksOut) {
  const std::vector<Eigen::Vector2i> sizes = many_sizes();
  constexpr int size = 128;
  const auto places = pack_rectangles(sizes, size, 10);
  ASSERT_TRUE(places);
  std::vector<char> taken(std::size_t{10} * size * size, 0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const PackedPosition& at = (*places)[i];
    ASSERT_GE(at.x, 0);
    ASSERT_GE(at.y, 0);
    ASSERT_LE(at.x + sizes[i].x(), size);
    ASSERT_LE(at.y + sizes[i].y(), size);
    for (int y = at.y; y < at.y + sizes[i].y(); ++y) {
      for (int x = at.x; x < at.x + sizes[i].x(); ++x) {
        char& texel = taken[(static_cast<std::size_t>(at.square) * size + y) * size + x];
        ASSERT_EQ(texel, 0) << "rectangle " << i << " lies on another";
        texel = 1;
      }
    }
  }
}

/// Equal squares that divide the large one leave nothing free.
TEST(PackRectangles, EqualSquaresFillTheSquare) {
  const std::vector<Eigen::Vector2i> sizes(16, {8, 8});
  EXPECT_TRUE(pack_rectangles(sizes, 32, 1));
  const std::vector<Eigen::Vector2i> one_more(17, {8, 8});
  EXPECT_FALSE(pack_rectangles(one_more, 32, 1));
  const auto places = pack_rectangles(one_more, 32, 2);
  ASSERT_TRUE(places);
  int in_the_second = 0;
  for (const PackedPosition& place : *places) in_the_second += place.square;
  EXPECT_EQ(in_the_second, 1);
}

TEST(PackRectangles, WhatIsTooLongFitsNowhere) {
  const std::vector<Eigen::Vector2i> sizes = {{33, 1}};
  EXPECT_FALSE(pack_rectangles(sizes, 32, 100));
}

}  // namespace
}  // namespace lightwell::pack_rectangles_test
