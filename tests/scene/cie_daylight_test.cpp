#include "scene/cie_daylight.h"

#include <gtest/gtest.h>

#include <array>

#include "scene/colour_matching.h"

namespace lightwell::cie_daylight_test {
namespace {

Eigen::Vector2d chromaticity_of(const SpectrumSamples& spectrum) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (double nm = 360.0; nm < 830.0; nm += 1.0) {
    const auto [x, y, z] = colour_matching(nm, nm + 1.0);
    sum += mean(spectrum, nm, nm + 1.0) * Eigen::Vector3d(x, y, z);
  }
  return sum.head<2>() / sum.sum();
}

/// CIE 15:2018, chromaticities of D50, D55, D65 and D75, five digits. The spectrum comes to them to
/// 1e-4, since S_0, S_1 and S_2 have one or two decimals and lie 10 nm apart. The locus is a
/// parabola that CIE 15's own illuminants leave by up to 1.3e-4.
TEST(CieDaylight, HasTheChromaticitiesOfTheIlluminants) {
  struct Illuminant {
    double kelvin, x, y;
  };
  for (const auto& [kelvin, x, y] :
       {Illuminant{5003.0, 0.34567, 0.35850}, Illuminant{5503.0, 0.33242, 0.34743},
        Illuminant{6504.0, 0.31272, 0.32903}, Illuminant{7504.0, 0.29902, 0.31485}}) {
    const Eigen::Vector2d wanted(x, y);
    EXPECT_LT((daylight_chromaticity(kelvin) - wanted).cwiseAbs().maxCoeff(), 1.3e-4) << kelvin;
    EXPECT_LT((chromaticity_of(daylight_spectrum(kelvin)) - wanted).cwiseAbs().maxCoeff(), 1e-4)
        << kelvin;
  }
}

/// D65 as CIE 15 prints it, from M_1 and M_2 that are rounded to three decimals: half a unit of
/// these times S_1 and S_2, below 46 and 10, is 0.03.
TEST(CieDaylight, IsTheTableOfD65) {
  const SpectrumSamples d65 = daylight_spectrum(6504.0);
  for (const auto& [nm, power] :
       {std::pair(300.0, 0.0341), std::pair(400.0, 82.7549), std::pair(450.0, 117.0080),
        std::pair(560.0, 100.0), std::pair(700.0, 71.6091), std::pair(830.0, 60.3125)}) {
    EXPECT_NEAR(mean(d65, nm, nm + 1e-6), power, 0.03) << nm;
  }
}

}  // namespace
}  // namespace lightwell::cie_daylight_test
