#include "scene/io/spectrum_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::spectrum_file_test {
namespace {

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
  says(refused("<SpectralDistribution>", "<Header><SpectralDistribution>"), "this is not XML");
  const auto whole = [&](const char* text) {
    return message_of<InputError>([&] { read_tm27(folder.write("lamp.spdx", text)); });
  };
  says(whole("<IESTM33></IESTM33>"), "there is no <SpectralDistribution> in <IESTM2714>");
  says(whole("<IESTM2714><SpectralDistribution><SpectralData wavelength=\"400\">1</SpectralData>"
             "</SpectralDistribution></IESTM2714>"),
       "at least two");
}

}  // namespace
}  // namespace lightwell::spectrum_file_test
