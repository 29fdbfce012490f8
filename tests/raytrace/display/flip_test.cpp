#include "raytrace/display/flip.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/temporary_folder.h"

namespace lightwell::flip_test {
namespace {

constexpr int width = 32, height = 24;

/// A gradient with a red block.
Image reference() {
  Image image{.width = width, .height = height};
  image.radiance.resize(width * height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool in_block = y >= 8 && y < 16 && x >= 10 && x < 20;
      const Eigen::Array3f gradient(0.2f + 0.6f * static_cast<float>(x) / (width - 1),
                                    0.1f + 0.8f * static_cast<float>(y) / (height - 1), 0.5f);
      const Eigen::Array3f rgb = in_block ? Eigen::Array3f(0.9f, 0.1f, 0.2f) : gradient;
      image.radiance.row(y * width + x).head<3>() = rgb.transpose();
    }
  }
  return image;
}

/// reference() with a shadow on part of the block, and a white pixel.
Image with_faults() {
  Image image = reference();
  for (int y = 4; y < 12; ++y) {
    for (int x = 14; x < 26; ++x) image.radiance.row(y * width + x) *= 0.5f;
  }
  image.radiance.row(20 * width + 5) = 1.0f;
  return image;
}

Image with_lamp(Image image, float L) {
  image.radiance *= 4.0f;
  for (int y = 2; y < 5; ++y) {
    for (int x = 2; x < 6; ++x) image.radiance.row(y * width + x) = L;
  }
  return image;
}

float at(const Eigen::ArrayXf& error, int x, int y) {
  return error[y * width + x];
}

// Expected values are those of the authors' program (flip-evaluator 1.7, linear input) for these
// pictures at its default distance. The program sums in float; 1e-4 is ten times the effect.

TEST(Flip, AgreesWithTheAuthorsProgram) {
  const Eigen::ArrayXf error = flip(with_faults(), reference());
  EXPECT_NEAR(error.mean(), 0.112539, 1e-4);
  EXPECT_NEAR(at(error, 18, 6), 0.602585, 1e-4);
  EXPECT_NEAR(at(error, 5, 20), 0.270225, 1e-4);
  EXPECT_NEAR(at(error, 15, 10), 0.650454, 1e-4);
  EXPECT_NEAR(at(error, 7, 20), 0.088188, 1e-4);
  EXPECT_NEAR(error.maxCoeff(), 0.699515, 1e-4);
  EXPECT_EQ(at(error, 0, 0), 0.0f);
}

TEST(HdrFlip, AgreesWithTheAuthorsProgram) {
  const Image picture = with_lamp(with_faults(), 150), known = with_lamp(reference(), 200);
  const FlipExposures range = flip_exposures(known);
  EXPECT_NEAR(range.first, -6.560559, 1e-5);
  EXPECT_NEAR(range.last, 0.164614, 1e-5);
  EXPECT_EQ(range.count, 7);
  const Eigen::ArrayXf error = hdr_flip(picture, known);
  EXPECT_NEAR(error.mean(), 0.108129, 1e-4);
  EXPECT_NEAR(at(error, 0, 0), 0.030227, 1e-4);
  EXPECT_NEAR(at(error, 18, 6), 0.570371, 1e-4);
  EXPECT_NEAR(at(error, 3, 3), 0.145428, 1e-4);
  EXPECT_NEAR(error.maxCoeff(), 0.594730, 1e-4);
}

TEST(Flip, IsZeroForEqualOneForOppositeAndTheSameBothWays) {
  EXPECT_EQ(flip(reference(), reference()).maxCoeff(), 0.0f);
  const Eigen::ArrayXf one_way = flip(with_faults(), reference()),
                       other_way = flip(reference(), with_faults());
  EXPECT_LT((one_way - other_way).abs().maxCoeff(), 1e-6f);
  // The difference of green and blue is 1, the largest, by definition.
  Image green{.width = 4, .height = 4}, blue = green;
  green.radiance.setZero(16, 3);
  blue.radiance.setZero(16, 3);
  green.radiance.col(1) = 1.0f;
  blue.radiance.col(2) = 1.0f;
  EXPECT_NEAR(flip(green, blue).mean(), 1.0f, 1e-5f);
}

TEST(Flip, DoesNotDependOnThreads) {
  const auto on = [](int threads) {
    const ThreadLimit limit(threads);
    return hdr_flip(with_faults(), reference());
  };
  EXPECT_TRUE((on(1) == on(2)).all());
}

TEST(HdrFlip, BlackReferenceHasExposures) {
  Image black{.width = 4, .height = 4};
  black.radiance.setZero(16, 3);
  EXPECT_EQ(hdr_flip(black, black).maxCoeff(), 0.0f);
  Image one_lit = black;
  one_lit.radiance.row(3) = 2.0f;
  const FlipExposures range = flip_exposures(one_lit);
  EXPECT_TRUE(std::isfinite(range.last));
  EXPECT_EQ(range.count, 2);
  EXPECT_GT(hdr_flip(black, one_lit).maxCoeff(), 0.1f);
}

TEST(Flip, PicturesOfOtherSizeAreRefused) {
  Image small{.width = 2, .height = 2};
  small.radiance.setZero(4, 3);
  EXPECT_TRUE(says(message_of<InputError>([&] { flip(small, reference()); }), "2 x 2"));
}

}  // namespace
}  // namespace lightwell::flip_test
