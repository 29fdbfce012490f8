#include "viewer/export/fill_texels.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace lightwell::fill_texels_test {
namespace {

/// Two bright squares in the dark, eight texels apart.
struct TwoSquares {
  static constexpr int size = 32;
  BandArray picture = BandArray::Zero(size * size, 1);
  std::vector<char> is_known = std::vector<char>(size * size, 0);
  TwoSquares() {
    for (int y = 10; y < 20; ++y) {
      for (int x = 4; x < 10; ++x) set(x, y, 1.0f);
      for (int x = 18; x < 24; ++x) set(x, y, 3.0f);
    }
  }
  void set(int x, int y, float value) {
    picture(y * size + x, 0) = value;
    is_known[static_cast<std::size_t>(y * size + x)] = 1;
  }
  void fill(int rings) {
    BandArray* const pictures[] = {&picture};
    fill_texels(size, is_known, rings, pictures);
  }
  float at(int x, int y) const { return picture(y * size + x, 0); }
};

/// Four rings from each side fill a gap of eight; each side has the light of its own square.
TEST(FillTexels, RingsContinueTheirOwnSquareAlone) {
  TwoSquares two;
  two.fill(4);
  for (int y = 6; y < 24; ++y) {
    for (int x = 0; x < 14; ++x) EXPECT_EQ(two.at(x, y), 1.0f) << x << " " << y;
    for (int x = 14; x < 28; ++x) EXPECT_EQ(two.at(x, y), 3.0f) << x << " " << y;
  }
}

/// Every texel that is filled by a mean of 1 and 3 lies between 1 and 3.
TEST(FillTexels, NothingStaysBlack) {
  TwoSquares two;
  two.fill(1);
  EXPECT_GE(two.picture.minCoeff(), 1.0f);
  EXPECT_LE(two.picture.maxCoeff(), 3.0f);
}

TEST(FillTexels, WhatIsKnownIsKeptAndNothingIsInvented) {
  TwoSquares two;
  const BandArray before = two.picture;
  two.fill(2);
  for (int i = 0; i < TwoSquares::size * TwoSquares::size; ++i) {
    if (two.is_known[static_cast<std::size_t>(i)] == 0) continue;
    EXPECT_EQ(two.picture(i, 0), before(i, 0));
  }
  TwoSquares dark;
  dark.is_known.assign(dark.is_known.size(), 0);
  dark.picture.setZero();
  dark.fill(2);
  EXPECT_EQ(dark.picture.maxCoeff(), 0.0f);
}

}  // namespace
}  // namespace lightwell::fill_texels_test
