#include "standards/colour_fidelity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>

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

// Sums of bells in intervals of 1 nm.
SpectralPower light_of(std::initializer_list<Peak> peaks) {
  SpectralPower power{.edges_nm = {379.5}};
  for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
    double sum = 0.0;
    for (const Peak& peak : peaks) sum += peak.height * bell(nm, peak.nm, peak.width);
    power.edges_nm.push_back(nm + 0.5);
    power.watts.push_back(sum);
  }
  return power;
}

/// R_f and R_g that the package colour-science 0.4.7 computes for the same lights and samples:
/// three narrow lines above 5000 K, a warm white below 4000 K, and a cool white in between, whose
/// references are daylight, a black body and a mixture. Intervals in place of samples widen the
/// bells by (1/12 + 1/6) nm^2 of variance in 50, 0.5 %, and temperatures differ by less than 1 K;
/// both move an index by some thousandths.
TEST(ColourFidelity, IsThatOfAnotherProgram) {
  const double line = 10.0 * std::sqrt(2.0), wide = 55.0 * std::sqrt(2.0);
  struct Case {
    SpectralPower power;
    double fidelity, gamut;
  };
  for (const auto& [power, fidelity, gamut] :
       {Case{light_of({{450, line, 1.0}, {545, line, 1.0}, {610, line, 1.0}}), 57.567507,
             106.036489},
        Case{light_of({{450, line, 0.5}, {590, wide, 1.0}}), 74.298826, 91.488766},
        Case{light_of({{450, line, 1.2}, {570, wide, 1.0}}), 72.227871, 91.129020}}) {
    const auto computed = colour_fidelity(power, bumps_and_dips());
    ASSERT_TRUE(computed);
    EXPECT_NEAR(computed->fidelity, fidelity, 0.01);
    EXPECT_NEAR(computed->gamut, gamut, 0.01);
  }
}

/// A light that is its own reference: R is 100, so R_f = 10 ln(exp(10) + 1) = 100.00045.
/// Temperatures are found to 1e-6 of themselves.
TEST(ColourFidelity, OfAReferenceIsPerfect) {
  for (const SpectralPower& power : {black_body_power(2700.0), daylight_illuminant(6504.0)}) {
    const auto computed = colour_fidelity(power, bumps_and_dips());
    EXPECT_NEAR(computed->fidelity, 100.00045, 1e-2);
    EXPECT_NEAR(computed->gamut, 100.0, 1e-2);
  }
  EXPECT_FALSE(colour_fidelity(light_of({{520, 10, 1.0}}), bumps_and_dips())) << "no temperature";
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
