#include "mesh/patches/area_shares.h"

#include <gtest/gtest.h>

#include <vector>

namespace lightwell::area_shares_test {
namespace {

// Walls of 1 m^2 have 8 of 8.4 m^2.
const std::vector<double> areas = {1, 1, 1, 1, 1, 1, 1, 1, 0.25, 0.125, 1.0 / 64.0, 1e-9};

TEST(AreaShares, TypicalAreaIsThatOfTheLargestOnesThatHoldHalf) {
  EXPECT_EQ(typical_area(areas), 1.0);
  EXPECT_EQ(typical_area(std::vector<double>{4.0, 1.0, 1.0, 1.0}), 4.0);
  EXPECT_EQ(typical_area({}), 0.0);
}

TEST(AreaShares, SamplesFallWithTheAreaBelowAQuarterOfTheTypicalOne) {
  const std::vector<int> expected = {16, 16, 16, 16, 16, 16, 16, 16, 16, 8, 2, 2};
  EXPECT_EQ(samples_by_area(areas, 16, 8), expected);
}

TEST(AreaShares, EverySurfaceHasASample) {
  for (const int count : samples_by_area(areas, 4, 16)) EXPECT_GE(count, 1);
  EXPECT_EQ(samples_by_area(std::vector<double>{0.0, 0.0}, 16, 8), (std::vector<int>{16, 16}));
}

}  // namespace
}  // namespace lightwell::area_shares_test
