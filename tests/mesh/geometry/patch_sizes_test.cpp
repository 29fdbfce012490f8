#include "mesh/geometry/patch_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lightwell::patch_sizes_test {
namespace {

using Eigen::Vector3d;

// A cube of 1 m about the origin with patches of 0.1 m, among surroundings with patches of 0.1 x
// 2^7 m: facets 0 and 1 are near, 2 is not.
PatchSizes sizes() {
  const Eigen::AlignedBox3d box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
  return {{.patch_size = 0.1, .elements_per_edge = 2},
          12.0,
          {.box = box, .is_near = {1, 1, 0}, .has_surroundings = true}};
}

// Sizes are 0.1 m times the largest power of two up to half of the distance, 2^7 at most. Products
// with powers of two are exact.
TEST(PatchSizes, GrowWithTheDistance) {
  const PatchSizes all = sizes();
  const auto at = [&](double distance) {
    return all.within(Vector3d(0.5 + distance, 0, 0), 0.0) / 0.1;
  };
  EXPECT_EQ(at(0.0), 1.0);
  EXPECT_EQ(at(0.39), 1.0);
  EXPECT_EQ(at(0.41), 2.0);
  EXPECT_EQ(at(10.0), 32.0);
  EXPECT_EQ(at(1e6), 128.0);
  // The nearest place decides.
  EXPECT_EQ(all.within(Vector3d(10.5, 0, 0), 9.7), 0.1);
}

TEST(PatchSizes, AreThoseOfWhatIsNearOnItsFacets) {
  const PatchSizes all = sizes();
  const Eigen::AlignedBox3d far(Vector3d(100, 0, 0), Vector3d(101, 1, 0)),
      wide(Vector3d(-100, -100, 0), Vector3d(100, 100, 0));
  EXPECT_EQ(all.of_facet(1, wide).cut.patch_size, 0.1);
  EXPECT_EQ(all.of_facet(1, wide).graded, nullptr);
  EXPECT_EQ(all.of_facet(2, far).cut.patch_size, 12.8);
  EXPECT_EQ(all.of_facet(2, far).graded, nullptr);
  EXPECT_EQ(all.of_facet(2, wide).cut.patch_size, 0.1);
  EXPECT_NE(all.of_facet(2, wide).graded, nullptr);
  EXPECT_EQ(PatchSizes({.patch_size = 0.3}).of_facet(2, wide).cut.patch_size, 0.3);
}

// No piece of a line through the cube is longer than an element there, half a patch; none is
// shorter than an eighth: two levels in one part, and a part that is just too long for one element.
TEST(PatchSizes, CutLinesByTheSizesAlongThem) {
  const PatchSizes all = sizes();
  const Vector3d a(-300, 0.2, 0), b(400, 0.2, 0);
  std::vector<double> cuts = all.cuts(a, b);
  EXPECT_TRUE(std::ranges::is_sorted(cuts));
  cuts.insert(cuts.begin(), 0.0);
  cuts.push_back(1.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double length = (cuts[i] - cuts[i - 1]) * (b - a).norm();
    const Vector3d middle = a + 0.5 * (cuts[i] + cuts[i - 1]) * (b - a);
    const double element = 0.5 * all.within(middle, 0.0);
    // A product of the line's 700 m rounds by 2^-53 of these a few times.
    EXPECT_LE(length, element + 1e-12) << middle.x();
    EXPECT_GE(length, 0.125 * element) << middle.x();
  }
}

}  // namespace
}  // namespace lightwell::patch_sizes_test
