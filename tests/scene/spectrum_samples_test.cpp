#include "scene/spectrum_samples.h"

#include <gtest/gtest.h>

namespace lightwell::spectrum_samples_test {
namespace {

const SpectrumSamples hat{.wavelengths_nm = {400, 500, 700}, .values = {0, 2, 0}};

TEST(SpectrumMean, IsTheExactMeanOfTheBrokenLine) {
  EXPECT_NEAR(mean(hat, 400, 700), 1.0, 1e-12);  // a triangle of height 2
  EXPECT_NEAR(mean(hat, 400, 500), 1.0, 1e-12);
  EXPECT_NEAR(mean(hat, 410, 420), 0.3, 1e-12);  // the value in the middle between two samples
  // 450-500: mean 1.5 over 50 nm; 500-600: 1.5 over 100 nm.
  EXPECT_NEAR(mean(hat, 450, 600), 1.5, 1e-12);
}

TEST(SpectrumMean, PiecesAddUpToTheWhole) {
  double sum = 0.0;
  for (int k = 0; k < 43; ++k) {
    const double width = 300.0 / 43;
    sum += mean(hat, 400 + k * width, 400 + (k + 1) * width) / 43;
  }
  EXPECT_NEAR(sum, mean(hat, 400, 700), 1e-12);
}

TEST(SpectrumCovers, ForgivesRoundingOnly) {
  EXPECT_TRUE(covers(hat, 400, 700.0 + 1e-10));
  EXPECT_FALSE(covers(hat, 400, 701));
  EXPECT_FALSE(covers(hat, 399, 700));
  EXPECT_FALSE(covers({}, 400, 700));
}

TEST(SpectraOfTable, AreItsColumns) {
  const auto spectra = spectra_of_table("wavelength_nm,a,b\n400,1,2.5\n410,-3e-1,0");
  ASSERT_EQ(spectra.size(), 2u);
  EXPECT_EQ(spectra[0].wavelengths_nm, (std::vector<double>{400, 410}));
  EXPECT_EQ(spectra[0].values, (std::vector<double>{1, -0.3}));
  EXPECT_EQ(spectra[1].values, (std::vector<double>{2.5, 0}));
}

}  // namespace
}  // namespace lightwell::spectrum_samples_test
