#include "scene/found_by_chance.h"

#include <gtest/gtest.h>

#include <vector>

namespace lightwell {
namespace {

const Bands bands = rgb_bands();

Spectrum grey(float light) {
  return constant_spectrum(bands, light);
}

// Sums of small whole numbers and of halves, which floats hold exactly.
TEST(FoundByChance, StaysWhereOneSampleInFourFindsIt) {
  // Each of five among seventeen has four times the mean of the others, (4 / 16) times its light.
  const std::vector<Spectrum> found(5, grey(3.0f));
  EXPECT_EQ(limited_sum(found, 17, 0.0f)[0], 15.0f);
}

TEST(FoundByChance, IsLimitedInASingleBrightSample) {
  EXPECT_EQ(limited_sum(std::vector{grey(1000.0f)}, 64, 0.5f)[0], 0.5f);
  // Others of a mean of 1/4 besides allow 1 more.
  std::vector<Spectrum> found(16, grey(1.0f));
  found.push_back(grey(1000.0f));
  EXPECT_EQ(limited_sum(found, 65, 0.5f)[0], 16.0f + 1.5f);
}

TEST(FoundByChance, KeepsItsColour) {
  Spectrum red = grey(0.0f);
  red[0] = 30.0f;
  const Spectrum sum = limited_sum(std::vector{red}, 64, 1.0f);
  EXPECT_EQ(sum[0], 3.0f);  // of a mean of 1
  EXPECT_EQ(sum[1], 0.0f);
}

TEST(FoundByChance, StaysInASampleWithoutOthers) {
  EXPECT_EQ(limited_sum(std::vector{grey(7.0f)}, 1, 0.0f)[0], 7.0f);
}

}  // namespace
}  // namespace lightwell
