#include "radiosity/journal/packed.h"

#include <gtest/gtest.h>

#include "radiosity/form_factors/estimated_row.h"

namespace lightwell::packed_test {
namespace {

EstimatedRow row() {
  BandArray share(2, 3);
  share << 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f;
  return {.inverse_variance = 12.5,
          .shares = {{3, 0.25f}, {7, 0.5f}},
          .escaped = 0.125,
          .specular = 0.0625,
          .specular_patch = {4, 9},
          .specular_share = share,
          .specular_escaped = Spectrum::Constant(3, 0.7f),
          .absorbed = Spectrum::Zero(3),
          .cut = {},
          .rays = 512.0};
}

TEST(Packed, GivesBackWhatWasPutIn) {
  EstimatedRow there = row(), back;
  Packed packed;
  packed.add(kept_parts(there));
  packed.add(-1.5);
  Unpacked unpacked(packed.bytes());
  auto parts = kept_parts(back);
  double number = 0.0;
  ASSERT_TRUE(unpacked.take(parts));
  ASSERT_TRUE(unpacked.take(number));
  EXPECT_TRUE(unpacked.is_empty());
  EXPECT_EQ(number, -1.5);
  EXPECT_EQ(back.inverse_variance, there.inverse_variance);
  ASSERT_EQ(back.shares.size(), 2u);
  EXPECT_EQ(back.shares[1].patch, 7);
  EXPECT_EQ(back.shares[1].value, 0.5f);
  EXPECT_EQ(back.specular_patch, there.specular_patch);
  EXPECT_TRUE((back.specular_share == there.specular_share).all());
  EXPECT_TRUE((back.specular_escaped == there.specular_escaped).all());
  EXPECT_EQ(back.cut.size(), 0);
  EXPECT_EQ(back.rays, 512.0);
}

TEST(Packed, IsNotTakenFromFewerBytes) {
  EstimatedRow there = row(), back;
  Packed packed;
  packed.add(kept_parts(there));
  for (std::size_t size = 0; size < packed.bytes().size(); ++size) {
    Unpacked unpacked(packed.bytes().first(size));
    auto parts = kept_parts(back);
    EXPECT_FALSE(unpacked.take(parts)) << size;
  }
}

// Impossible sizes are refused before memory is allocated.
TEST(Packed, SizesBeyondTheBytesAreRefused) {
  for (const std::size_t size : {std::size_t{9}, std::size_t{1} << 40U, ~std::size_t{0}}) {
    Packed packed;
    packed.add(size);
    packed.add(1.0);
    std::vector<double> values;
    EXPECT_FALSE(Unpacked(packed.bytes()).take(values)) << size;
  }
  for (const Eigen::Index rows : {Eigen::Index{-1}, Eigen::Index{2}, Eigen::Index{1} << 62}) {
    Packed packed;
    packed.add(rows);
    packed.add(Eigen::Index{1} << 61);
    BandArray values;
    EXPECT_FALSE(Unpacked(packed.bytes()).take(values)) << rows;
    Spectrum spectrum;
    EXPECT_FALSE(Unpacked(packed.bytes()).take(spectrum)) << rows;
  }
}

TEST(Packed, AnArrayOfAFixedSizeIsTakenFromThatSizeAlone) {
  Packed packed;
  packed.add(Eigen::ArrayXXf::Ones(4, 1).eval());
  Eigen::Array3f three;
  EXPECT_FALSE(Unpacked(packed.bytes()).take(three));
  Eigen::Array4f four;
  EXPECT_TRUE(Unpacked(packed.bytes()).take(four));
  EXPECT_TRUE((four == 1.0f).all());
}

TEST(Packed, ASpanKeepsItsSize) {
  const std::vector<float> three = {1, 2, 3};
  Packed packed;
  packed.add(std::span<const float>(three));
  std::vector<float> four(4), same(3);
  std::span<float> to_four(four), to_three(same);
  EXPECT_FALSE(Unpacked(packed.bytes()).take(to_four));
  EXPECT_TRUE(Unpacked(packed.bytes()).take(to_three));
  EXPECT_EQ(same, three);
}

}  // namespace
}  // namespace lightwell::packed_test
