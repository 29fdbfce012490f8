#include "standards/colour_fidelity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "standards/colour_rendering.h"
#include "tests/temporary_folder.h"

namespace lightwell::colour_fidelity_test {
namespace {

double bell(double nm, double peak, double width) {
  return std::exp(-std::pow((nm - peak) / width, 2));
}

/// Bumps and dips of reflectance, 120 nm wide, that move over the spectrum. The samples of CIE 224
/// are not part of the program; the method is the same for any.
ColourSamples bumps_and_dips() {
  ColourSamples samples(99);
  for (int i = 0; i < 99; ++i) {
    auto& [wavelengths, values] = samples[static_cast<std::size_t>(i)];
    for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
      const double bump = 0.7 * bell(nm, 390.0 + 4.0 * i, 60.0);
      wavelengths.push_back(nm);
      values.push_back(i % 2 == 0 ? 0.1 + bump : 0.8 - bump);
    }
  }
  return samples;
}

struct Peak {
  double nm, width, height;
};

// Sums of bells in intervals of 1 nm, each with `more` of variance, nm^2.
SpectralPower light_of(const std::vector<Peak>& peaks, double more = 0.0) {
  SpectralPower power{.edges_nm = {379.5}};
  for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
    double sum = 0.0;
    for (const Peak& peak : peaks) {
      const double width = std::hypot(peak.width, std::sqrt(2.0 * more));
      sum += peak.height * peak.width / width * bell(nm, peak.nm, width);
    }
    power.edges_nm.push_back(nm + 0.5);
    power.watts.push_back(sum);
  }
  return power;
}

/// Change of R_f or R_g for a change of the logarithm of the reference's temperature by 1. Measured
/// in OfAReferenceIsPerfect: 34 for a mixture whose temperature comes out 1.1e-4 off, 26 for
/// daylight.
constexpr double index_per_temperature = 40.0;

/// R_f and R_g that the package colour-science 0.4.7 computes for the same lights and samples:
/// three narrow lines above 5000 K, a warm white below 4000 K, and a cool white in between, whose
/// references are daylight, a black body and a mixture. Power that is even within intervals of 1 nm
/// adds 1/12 nm^2 to the variance of each bell, and samples of colour matching that are linear in
/// between 1/6 nm^2: the test takes the change that both make. Temperatures differ by less than 1
/// K.
TEST(ColourFidelity, IsThatOfAnotherProgram) {
  const double line = 10.0 * std::sqrt(2.0), wide = 55.0 * std::sqrt(2.0);
  struct Case {
    std::vector<Peak> peaks;
    double fidelity, gamut;
  };
  for (const auto& [peaks, fidelity, gamut] :
       {Case{{{450, line, 1.0}, {545, line, 1.0}, {610, line, 1.0}}, 57.567507, 106.036489},
        Case{{{450, line, 0.5}, {590, wide, 1.0}}, 74.298826, 91.488766},
        Case{{{450, line, 1.2}, {570, wide, 1.0}}, 72.227871, 91.129020}}) {
    const auto computed = colour_fidelity(light_of(peaks), bumps_and_dips());
    const auto wider = colour_fidelity(light_of(peaks, 1.0 / 12.0 + 1.0 / 6.0), bumps_and_dips());
    ASSERT_TRUE(computed && wider);
    const double of_kelvin =
        index_per_temperature / *eye_light(light_of(peaks))->colour_temperature;
    EXPECT_NEAR(computed->fidelity, fidelity,
                of_kelvin + std::abs(wider->fidelity - computed->fidelity));
    EXPECT_NEAR(computed->gamut, gamut, of_kelvin + std::abs(wider->gamut - computed->gamut));
  }
}

// Y of the 1964 observer of power in intervals of 1 nm.
double luminance_10(const SpectralPower& power) {
  const auto matching = spectra_of_table(standards_data::colour_matching_10);
  double sum = 0.0;
  for_each_visible_interval(power, [&](double low, double high, double watts) {
    sum += watts * mean(matching[1], low, high);
  });
  return sum;
}

/// A light that is its own reference: R is 100, so R_f = 10 ln(exp(10) + 1) = 100.00045. The
/// reference is that of the temperature which is found: to 1e-6 of a black body's, and for daylight
/// and mixtures the black body next to them, as much off their nominal temperature as the test
/// computes.
TEST(ColourFidelity, OfAReferenceIsPerfect) {
  const double even = 4500.0;  // K, of equal parts
  SpectralPower mixture = black_body_power(even);
  const SpectralPower day = daylight_illuminant(even);
  const double scale = luminance_10(mixture) / luminance_10(day);
  for (std::size_t k = 0; k < day.watts.size(); ++k) mixture.watts[k] += scale * day.watts[k];
  for (const auto& [power, kelvin] :
       {std::pair(black_body_power(2700.0), 2700.0), std::pair(mixture, even),
        std::pair(daylight_illuminant(6504.0), 6504.0)}) {
    const auto computed = colour_fidelity(power, bumps_and_dips());
    const double off = std::abs(std::log(*eye_light(power)->colour_temperature / kelvin));
    const double within = index_per_temperature * (off + 1e-6);
    EXPECT_NEAR(computed->fidelity, 100.00045399, within) << kelvin;
    EXPECT_NEAR(computed->gamut, 100.0, within) << kelvin;
    EXPECT_LT(off, 2e-4) << kelvin;
  }
  EXPECT_FALSE(colour_fidelity(light_of({{520, 10, 1.0}}), bumps_and_dips())) << "no temperature";
}

/// The bound is the difference that intervals twice as wide make. Power that is even within h adds
/// h^2 / 12 to the variance of a line, so intervals of 2 nm have four times the bound of those of 1
/// nm; the next order is about (4 nm)^2 / 12 over the variance of 100 nm^2, 1.3 %, of which a few
/// are left.
TEST(ColourFidelity, HasABoundByTheWidthOfTheIntervals) {
  const double line = 10.0 * std::sqrt(2.0);
  const SpectralPower fine = light_of({{450, line, 1.0}, {545, line, 1.0}, {610, line, 1.0}});
  const SpectralPower wider = in_wider_intervals(fine);
  const auto computed = colour_fidelity(fine, bumps_and_dips());
  const auto coarse = colour_fidelity(wider, bumps_and_dips());
  EXPECT_EQ(wider.watts.size(), 201u);
  EXPECT_EQ(computed->fidelity_within, std::abs(coarse->fidelity - computed->fidelity));
  EXPECT_EQ(computed->gamut_within, std::abs(coarse->gamut - computed->gamut));
  EXPECT_NEAR(coarse->fidelity_within / computed->fidelity_within, 4.0, 0.2);
  EXPECT_NEAR(coarse->gamut_within / computed->gamut_within, 4.0, 0.2);
}

std::string table(double last_nm, const std::string& value, int columns = 99) {
  std::string text = "nm";
  for (int i = 0; i < columns; ++i) text += ",ces";
  for (double nm = 380.0; nm <= last_nm; nm += 100.0) {
    text += "\n" + std::to_string(nm);
    for (int i = 0; i < columns; ++i) text += "," + value;
  }
  return text + "\n";
}

TEST(ColourSamples, AreReadFromAFile) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    folder.write("ces.csv", text);
    return message_of<InputError>([&] { read_colour_samples(folder / "ces.csv"); });
  };
  EXPECT_EQ(refusal(table(780.0, "0.5")), "");
  EXPECT_EQ(read_colour_samples(folder / "ces.csv")[98].values.size(), 5u);
  EXPECT_TRUE(says(refusal(table(680.0, "0.5")), "does not reach from 380 to 780 nm"));
  EXPECT_TRUE(says(refusal(table(780.0, "50")), "'50' is no reflectance from 0 to 1"));
  EXPECT_TRUE(says(refusal(table(780.0, "0.5", 15)), "ces.csv:2: has 16 fields"));
  EXPECT_TRUE(says(refusal(table(780.0, "0.5") + "500,1\n"), "fields"));
  EXPECT_TRUE(says(refusal(""), "does not reach"));
}

}  // namespace
}  // namespace lightwell::colour_fidelity_test
