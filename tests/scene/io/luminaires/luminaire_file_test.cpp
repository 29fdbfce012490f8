#include "scene/io/luminaires/luminaire_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "scene/errors.h"
#include "tests/scene/expected_messages.h"
#include "tests/temporary_folder.h"

namespace lightwell::luminaire_file_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(LIGHTWELL_TEST_DATA) / "luminaires" / name;
}

double at(const LuminaireFile& luminaire, double gamma, double plane) {
  return luminaire.web->at({std::sin(gamma * degree) * std::cos(plane * degree),
                            std::sin(gamma * degree) * std::sin(plane * degree),
                            -std::cos(gamma * degree)});
}

bool has_note(const LuminaireFile& luminaire, const std::string& part) {
  for (const std::string& note : luminaire.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

struct Measured {
  const char* file;
  double lumens, candela;
};

class RealFiles : public testing::TestWithParam<Measured> {};

// Expected fluxes: the whole table by the trapezoid rule with exact solid angles, computed by
// another program.
TEST_P(RealFiles, FluxAndPeakAreThoseOfTheTable) {
  const LuminaireFile luminaire = read_luminaire(data(GetParam().file));
  EXPECT_NEAR(luminaire.flux() / GetParam().lumens, 1.0, 0.015);
  EXPECT_NEAR(luminaire.web->peak() / GetParam().candela, 1.0, 1e-3);
  EXPECT_FALSE(luminaire.is_radiometric);

  // Sampled directions give the same flux, with nearly constant weights.
  double sum = 0.0, squares = 0.0;
  constexpr int draws = 1 << 14;
  for (int i = 0; i < draws; ++i) {
    const double golden = std::fmod(i * 0.6180339887498949, 1.0);
    const double weight = luminaire.web->draw((i + 0.5) / draws, golden).weight;
    sum += weight;
    squares += weight * weight;
  }
  EXPECT_NEAR(sum / draws / luminaire.flux(), 1.0, 2e-3);
  EXPECT_LT(std::sqrt(squares / draws) / luminaire.flux(), 1.2);
}
INSTANTIATE_TEST_SUITE_P(
    Ies, RealFiles,
    testing::Values(Measured{"area_light.ies", 28351, 15060},
                    Measured{"bega_50899_no360plane.ies", 1232, 2160},
                    Measured{"bega_50975_absolute.ies", 321.5, 337},
                    Measured{"bollard.ies", 2551, 944}, Measured{"cylinder_narrow.ies", 3007, 8183},
                    Measured{"defined.ies", 13169, 8564}, Measured{"display.ies", 4070, 56580},
                    Measured{"jelly_fish.ies", 6486, 2700}, Measured{"overhead.ies", 37084, 19267},
                    Measured{"parallel_beam.ies", 3304, 11502}, Measured{"vee.ies", 851, 947},
                    Measured{"x_arrow.ies", 525, 315}));

TEST(Luminaires, RadiantIntensityIsNotCandela) {
  const LuminaireFile uv = read_luminaire(data("uv_LLIA001477-002.ies"));
  EXPECT_TRUE(uv.is_radiometric);
  EXPECT_NEAR(uv.flux(), 53.6e-3, 0.015 * 53.6e-3);
  EXPECT_NEAR(uv.web->peak(), 37.2e-3, 1e-4);
  EXPECT_EQ(uv.lamp_lumens, 0.0);
}

// The table is per 1000 lm of lamp flux and integrates to 10 times the light output ratio in
// percent.
TEST(Luminaires, EulumdatFilesKeepTheirLightOutputRatio) {
  // In all five files the luminaire emits the whole lamp flux, or photometry is absolute.
  for (const auto& [file, lumens] :
       {std::pair("sample1.ldt", 1983.0), std::pair("sample3.ldt", 12800.0),
        std::pair("sample5.ldt", 611.9), std::pair("sample6.ldt", 1800.0),
        std::pair("sample10.ldt", 7000.0)}) {
    EXPECT_NEAR(read_luminaire(data(file)).flux() / lumens, 1.0, 0.002) << file;
  }
}

TEST(Luminaires, LampSetsAreChosenByNumber) {
  EXPECT_EQ(read_luminaire(data("sample1.ldt")).lamp_lumens, 1983.0);
  const LuminaireFile second = read_luminaire(data("sample1.ldt"), 2);
  EXPECT_EQ(second.lamp_lumens, 2643.0);
  EXPECT_NEAR(second.flux(), 2643.0, 6.0);
  EXPECT_THROW(read_luminaire(data("sample1.ldt"), 3), InputError);
}

TEST(Luminaires, AbsolutePhotometryHasNoLamps) {
  EXPECT_EQ(read_luminaire(data("bega_50975_absolute.ies")).lamp_lumens, 0.0);
  EXPECT_EQ(read_luminaire(data("sample5.ldt")).lamp_lumens, 0.0);
}

// C0 is along the length of an opening in IES files, and across the length in EULUMDAT files.
TEST(Luminaires, OpeningsLieAlongTheirPlanes) {
  constexpr double foot = 0.3048;
  const LampOpening ies = read_luminaire(data("overhead.ies")).opening;
  EXPECT_NEAR(ies.along_c90, 2.083 * foot, 1e-9);
  EXPECT_NEAR(ies.along_c0, 4.0 * foot, 1e-9);
  EXPECT_FALSE(ies.is_round);
  const LampOpening ldt = read_luminaire(data("sample1.ldt")).opening;
  EXPECT_NEAR(ldt.along_c90, 1.208, 1e-9);
  EXPECT_NEAR(ldt.along_c0, 0.105, 1e-9);
  const LampBody body = read_luminaire(data("sample1.ldt")).body;
  EXPECT_TRUE(body.is_known());
  EXPECT_FALSE(read_luminaire(data("overhead.ies")).body.is_known());
  const LampOpening disc = read_luminaire(data("display.ies")).opening;
  EXPECT_TRUE(disc.is_round);
  EXPECT_NEAR(disc.along_c0, 0.12, 1e-9);
  EXPECT_EQ(disc.along_c0, disc.along_c90);
  EXPECT_TRUE(read_luminaire(data("defined.ies")).opening.is_point());
  EXPECT_TRUE(has_note(read_luminaire(data("bollard.ies")), "height of 0.124 m"));
}

TEST(Luminaires, PlanesGoOnAcrossTheLastToTheFirst) {
  const LuminaireFile spot = read_luminaire(data("bega_50899_no360plane.ies"));
  ASSERT_EQ(spot.web->planes().size(), 24u);
  const double between = 0.5 * (at(spot, 30.0, 345.0) + at(spot, 30.0, 0.0));
  EXPECT_NEAR(at(spot, 30.0, 352.5), between, 1e-9);
}

// A table in which every value identifies its direction: I = 100 + gamma + C / 10.
std::string ies(const std::string& planes, const std::vector<double>& angles,
                const std::string& before = "IESNA:LM-63-1995\n",
                const std::string& tilt = "NONE") {
  std::string text = before + "TILT=" + tilt + "\n1 1000 1 3 " + std::to_string(angles.size()) +
                     " 1 2 0 0 0\n1 1 10\n0 45 90\n" + planes + "\n";
  for (const double plane : angles) {
    for (const double gamma : {0.0, 45.0, 90.0}) {
      text += std::to_string(100.0 + gamma + plane / 10.0) + " ";
    }
    text += "\n";
  }
  return text;
}

class WrittenFiles : public testing::Test {
 protected:
  LuminaireFile read(const std::string& text, const std::string& name = "it.ies") {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return read_luminaire(folder_.path() / name);
  }
  void expect_error(const std::string& text, const std::vector<std::string>& parts,
                    const std::string& name = "it.ies") {
    test::expect_message([&] { read(text, name); }, parts);
  }
  TemporaryFolder folder_{};
};

TEST_F(WrittenFiles, SymmetriesAreUnfolded) {
  const LuminaireFile quarter = read(ies("0 90", {0, 90}));
  EXPECT_NEAR(at(quarter, 45, 30), 148.0, 1e-9);
  EXPECT_NEAR(at(quarter, 45, 150), 148.0, 1e-9);
  EXPECT_NEAR(at(quarter, 45, 210), 148.0, 1e-9);
  EXPECT_NEAR(at(quarter, 45, 330), 148.0, 1e-9);
  const LuminaireFile half = read(ies("0 90 180", {0, 90, 180}));
  EXPECT_NEAR(at(half, 45, 150), 160.0, 1e-9);
  EXPECT_NEAR(at(half, 45, 210), 160.0, 1e-9);
  const LuminaireFile other_half = read(ies("90 180 270", {90, 180, 270}));
  EXPECT_NEAR(at(other_half, 45, 200), 165.0, 1e-9);
  EXPECT_NEAR(at(other_half, 45, 340), 165.0, 1e-9);
  EXPECT_NEAR(at(other_half, 45, 30), 145.0 + 15.0, 1e-9);
  const LuminaireFile whole = read(ies("0 120 240 360", {0, 120, 240, 0}));
  EXPECT_NEAR(at(whole, 45, 120), 157.0, 1e-9);
  EXPECT_NEAR(at(whole, 45, 300), 0.5 * (169.0 + 145.0), 1e-9);
  EXPECT_NEAR(at(read(ies("0", {0})), 45, 77), 145.0, 1e-9);
}

TEST_F(WrittenFiles, BeyondTheTableThereIsNoLight) {
  EXPECT_EQ(at(read(ies("0", {0})), 91.0, 0), 0.0);
  EXPECT_NEAR(at(read(ies("0", {0})), 90.0, 0), 190.0, 1e-6);
}

TEST_F(WrittenFiles, TiltFactorsOfALevelLuminaireCount) {
  const LuminaireFile tilted =
      read(ies("0", {0}, "IESNA91\n", "INCLUDE\n1\n3\n0 45 90\n0.8 0.9 1"));
  EXPECT_NEAR(at(tilted, 0, 0), 80.0, 1e-9);
  EXPECT_TRUE(has_note(tilted, "hangs level"));
  EXPECT_TRUE(has_note(read(ies("0", {0}, "IESNA91\n", "lamp.tlt")), "'lamp.tlt'"));
}

TEST_F(WrittenFiles, HeadersOfAllAgesAreRead) {
  EXPECT_EQ(read(ies("0", {0}, "")).web->planes().size(), 1u);
  EXPECT_EQ(read(ies("0", {0}, "\xef\xbb\xbfIES:LM-63-2019\r\n[LUMINAIRE] A lamp\r\n")).name,
            "A lamp");
  // Bytes that are not UTF-8 are read as Latin-1.
  EXPECT_EQ(read(ies("0", {0}, "IESNA91\n[LUMINAIRE] 70\xb0\n")).name, "70\xc2\xb0");
}

TEST_F(WrittenFiles, MistakesAreToldWithTheirLine) {
  expect_error("a\nb\n", {"it.ies:1:", "TILT="});
  const std::string good = ies("0", {0});
  expect_error(good.substr(0, good.rfind("145")), {"it.ies:7:", "cut short", "vertical angle 45"});
  expect_error("TILT=NONE\n1 1000 x", {"it.ies:2:", "'x' is no number", "multiplier"});
  expect_error("TILT=NONE\n1 1000 1 3 1 2 2 0 0 0", {"type B", "type C"});
  expect_error("TILT=NONE\n1 1000 1 1e9 1 1 2 0 0 0", {"number of vertical angles is 1e+09"});
  expect_error("TILT=NONE\n1 1000 1 3 1 1 2 0 0 0 1 1 9\n0 90 45 0 1 1 1",
               {"it.ies:3:", "vertical angle 3 is 45, after 90"});
  expect_error("TILT=NONE\n1 1000 1 2 1 1 2 0 0 0 1 1 9\n0 90 0 1 -1",
               {"the intensity is -1", "below 0"});
  expect_error("TILT=NONE\n1 1000 1 2 2 1 2 0 0 0 1 1 9\n0 90 0 100 1 1 1 1",
               {"0 to 100", "from 0"});
  expect_error("TILT=NONE\n1 1000 0 2 1 1 2 0 0 0 1 1 9\n0 90 0 1 1", {"make 0", "above 0"});
  expect_error("TILT=NONE\n1 1000 1 2 2 1 2 0 0 0 1 1 9\n0 90 90 270 1 1 1 1",
               {"from 90 by way of 180 at 270"});
  expect_error("TILT=NONE\n1 1000 10 2 1 1 2 0 0 0 1 1 9\n0 90 0\n1e308 1",
               {"it.ies:4:", "1e+308, by a factor of 10", "not be above 1e+18"});
  expect_error("maker\n1\n7\n", {"it.ldt:3:", "symmetry is 7"}, "it.ldt");
  expect_error("maker\n1\n", {"it.ldt:2:", "cut short"}, "it.ldt");
  expect_error("", {"it.txt", "'.txt' is of no known photometric format"}, "it.txt");
}

}  // namespace
}  // namespace lightwell::luminaire_file_test
