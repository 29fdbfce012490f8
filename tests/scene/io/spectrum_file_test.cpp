#include "scene/io/spectrum_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

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

TEST(SpectrumCsv, ReadsTheNamedColumn) {
  const std::filesystem::path file = LIGHTWELL_TEST_DATA "/scene/spectra.csv";
  const SpectrumSamples ramp = read_spectrum_csv(file, "ramp");
  EXPECT_EQ(ramp.wavelengths_nm, (std::vector<double>{400, 500, 600, 700}));
  EXPECT_EQ(ramp.values, (std::vector<double>{0.1, 0.3, 0.5, 0.7}));
  EXPECT_THROW(read_spectrum_csv(file, ""), InputError);
}

const std::string tm27 = R"(<?xml version="1.0" encoding="utf-8"?>
<IESTM2714 xmlns="iestm2714" version="1.0">
  <Header><Manufacturer>Example</Manufacturer></Header>
  <SpectralDistribution>
    <SpectralQuantity>relative</SpectralQuantity>
    <SpectralData wavelength="400.0">0.25</SpectralData>
    <SpectralData wavelength="550">1.0e0</SpectralData>
    <SpectralData wavelength="700.0">0.5</SpectralData>
  </SpectralDistribution>
</IESTM2714>
)";

TEST(SpectrumTm27, ReadsSpectralData) {
  const TemporaryFolder folder;
  const SpectrumSamples lamp = read_tm27(folder.write("lamp.spdx", tm27));
  EXPECT_EQ(lamp.wavelengths_nm, (std::vector<double>{400, 550, 700}));
  EXPECT_EQ(lamp.values, (std::vector<double>{0.25, 1.0, 0.5}));
}

TEST(SpectrumTm27, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = tm27;
    text.replace(text.find(from), from.size(), to);
    return message_of<InputError>([&] { read_tm27(folder.write("lamp.spdx", text)); });
  };
  const auto says = [](const std::string& message, const char* sentence) {
    EXPECT_NE(message.find(sentence), std::string::npos) << message;
  };
  says(refused("1.0e0", "bright"), "lamp.spdx:7: the value 'bright' is not a finite number");
  says(refused("\"550\"", "\"350\""), "lamp.spdx:7: wavelength 350 nm follows 400 nm");
  says(refused("</SpectralDistribution>", ""), "this is not XML");
  says(refused("IESTM2714", "TM33"), "this is not XML");
  says(refused("<SpectralDistribution>", "<!--"), "this is not XML");
}

}  // namespace
}  // namespace lightwell::spectrum_samples_test
