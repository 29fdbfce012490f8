#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/read_scene.h"
#include "scene/scene.h"
#include "tests/scene/expected_messages.h"
#include "tests/temporary_folder.h"

namespace lightwell::tm33_file_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
const std::vector<double> gammas = {0.0, 45.0, 90.0};

// Every value identifies its direction.
double value_at(double plane, double gamma) {
  return 100.0 + gamma + plane / 10.0;
}

std::string grid(const std::vector<double>& planes, const std::vector<double>& at = gammas,
                 double scale = 1.0) {
  std::string text;
  for (const double h : planes) {
    for (const double v : at) {
      text += "<IntData h=\"" + std::to_string(h) + "\" v=\"" + std::to_string(v) + "\">" +
              std::to_string(scale * value_at(h, v)) + "</IntData>\n";
    }
  }
  return text;
}

std::string luminous_data(const std::string& content) {
  return "<LuminousData><LuminousIntensity>" + content + "</LuminousIntensity></LuminousData>";
}

std::string emitter(const std::string& content, const std::string& name = "board") {
  return "<Emitter><Quantity>1</Quantity><Description>" + name +
         "</Description><InputWattage>10</InputWattage>" + content + "</Emitter>";
}

std::string file_of(const std::string& content, const std::string& root = "IESTM33-22") {
  return "<?xml version=\"1.0\"?>\n<" + root + "><Version>1.1</Version>\n" +
         "<Header><Manufacturer>Maker</Manufacturer><Description> A lamp "
         "</Description></Header>\n" +
         content + "\n</" + root + ">\n";
}

std::string lm63(const std::vector<double>& planes) {
  std::string text = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 3 " + std::to_string(planes.size()) +
                     " 1 2 0 0 0\n1 1 10\n0 45 90\n";
  for (const double h : planes) text += std::to_string(h) + " ";
  for (const double h : planes) {
    for (const double v : gammas) text += "\n" + std::to_string(value_at(h, v));
  }
  return text + "\n";
}

double at(const LuminaireFile& luminaire, double gamma, double plane) {
  return luminaire.web->at({std::sin(gamma * degree) * std::cos(plane * degree),
                            std::sin(gamma * degree) * std::sin(plane * degree),
                            -std::cos(gamma * degree)});
}

class Tm33 : public testing::Test {
 protected:
  LuminaireFile read(const std::string& text) {
    return read_luminaire(folder_.write("it.xml", text));
  }
  void expect_error(const std::string& text, const std::vector<std::string>& parts) {
    test::expect_message([&] { read(text); }, parts);
  }
  testing::AssertionResult notes(const LuminaireFile& luminaire, const std::string& part) {
    std::string all;
    for (const std::string& note : luminaire.notes) all += note + "\n";
    return says(all, part);
  }
  TemporaryFolder folder_{};
};

TEST_F(Tm33, SameNumbersAsInLm63GiveTheSameWeb) {
  const std::pair<const char*, std::vector<double>> ranges[] = {{"Symm_Full", {0}},
                                                                {"Symm_Quad", {0, 45, 90}},
                                                                {"Symm_Bi_0", {0, 90, 180}},
                                                                {"Symm _ Bi _90", {90, 180, 270}},
                                                                {"Symm_None", {0, 120, 240}}};
  for (const auto& [symmetry, planes] : ranges) {
    const LuminaireFile ies = read_luminaire(folder_.write("it.ies", lm63(planes)));
    const std::string stated = "<Symm>" + std::string(symmetry) + "</Symm>" + "<NumberHorz>" +
                               std::to_string(planes.size()) +
                               "</NumberHorz><NumberVert>3</NumberVert>";
    const LuminaireFile newer = read(file_of(emitter(luminous_data(stated + grid(planes)))));
    const LuminaireFile older = read(file_of(emitter(luminous_data(grid(planes))), "IESTM33"));
    for (const LuminaireFile* xml : {&newer, &older}) {
      EXPECT_EQ(xml->web->planes(), ies.web->planes()) << symmetry;
      EXPECT_EQ(xml->web->gammas(), ies.web->gammas()) << symmetry;
      EXPECT_TRUE((xml->web->values() == ies.web->values()).all()) << symmetry;
      EXPECT_EQ(xml->symmetry, ies.symmetry);
      EXPECT_EQ(xml->watts, ies.watts);
    }
    EXPECT_EQ(newer.format, "IES TM-33-23");
    EXPECT_EQ(older.format, "IES TM-33-18");
    EXPECT_EQ(newer.name, "A lamp");
    EXPECT_EQ(newer.maker, "Maker");
  }
}

TEST_F(Tm33, IntensitiesStandInAnyOrder) {
  const std::string turned =
      "<IntData v=\"90\" h=\"0\">3</IntData><IntData h=\"0\" v=\"0\">\n 1 "
      "</IntData><IntData h=\"0\" v=\"45\">+2e0</IntData>";
  const LuminaireFile luminaire = read(file_of(emitter(luminous_data(turned))));
  EXPECT_EQ(luminaire.web->values()(0, 1), 2.0);
  EXPECT_EQ(luminaire.web->values()(0, 2), 3.0);
}

TEST_F(Tm33, FactorsMultiplyTheIntensities) {
  const std::string factors =
      "<BallastFactor>0.5</BallastFactor><TiltAngles><Tilt angle=\"0\">0.8</Tilt>"
      "<Tilt angle=\"90\">0.1</Tilt></TiltAngles>";
  const LuminaireFile luminaire =
      read(file_of(emitter(factors + luminous_data("<Multiplier>10</Multiplier>" + grid({0})))));
  EXPECT_NEAR(luminaire.web->values()(0, 1), 4.0 * 145.0, 1e-9);
  EXPECT_TRUE(notes(luminaire, "hangs level"));
  EXPECT_EQ(luminaire.lamp_lumens, 0.0);
  const LuminaireFile relative = read(file_of(
      emitter("<RatedLumens>900</RatedLumens>" +
              luminous_data("<AbsolutePhotometry>False</AbsolutePhotometry>" + grid({0})))));
  EXPECT_EQ(relative.lamp_lumens, 900.0);
}

// Emitters end at different angles gamma: the sum has the step of the one that ends first.
TEST_F(Tm33, EmittersAddUp) {
  const LuminaireFile both =
      read(file_of(emitter(luminous_data(grid({0, 90}))) +
                   emitter(luminous_data(grid({0}, {90, 120, 180}, 10.0)), "uplight")));
  const auto single = [&](const std::string& text) { return read(file_of(emitter(text))); };
  const LuminaireFile down = single(luminous_data(grid({0, 90})));
  const LuminaireFile up = single(luminous_data(grid({0}, {90, 120, 180}, 10.0)));
  for (const double plane : {0.0, 30.0, 200.0}) {
    // A table is linear in each cell; interpolating and adding round by some 1e-16 of 3000 cd.
    for (const double gamma : {0.0, 20.0, 89.0, 91.0, 130.0, 179.0}) {
      EXPECT_NEAR(at(both, gamma, plane), at(down, gamma, plane) + at(up, gamma, plane), 1e-9);
    }
  }
  // The step takes 1e-6 degrees = 1.7e-8 rad of a ring of 2 pi around 90 degrees, where at most
  // 2000 cd are missing or too many: 2 pi 1.7e-8 2000 = 2e-4 lm.
  EXPECT_NEAR(both.flux(), down.flux() + up.flux(), 3e-4);
  EXPECT_EQ(both.watts, 20.0);
  EXPECT_TRUE(notes(both, "2 emitters shine as one"));
}

TEST_F(Tm33, RadiantDataAreWattsWhereThereAreNoCandela) {
  const std::string radiant = "<RadiantData><MinWavelength>315</MinWavelength><RadiantIntensity>" +
                              grid({0}) + "</RadiantIntensity></RadiantData>";
  EXPECT_TRUE(read(file_of(emitter(radiant))).is_radiometric);
  const LuminaireFile both = read(file_of(emitter(luminous_data(grid({0})) + radiant)));
  EXPECT_FALSE(both.is_radiometric);
  expect_error(file_of(emitter(radiant) + emitter(luminous_data(grid({0})))), {"do not add up"});
}

TEST_F(Tm33, SizesAreMetresWithC0AcrossTheLength) {
  const auto with = [&](const std::string& areas, const std::string& sizes) {
    return read(file_of(
        "<Luminaire>" + sizes + "</Luminaire>" +
        emitter(luminous_data(grid({0})) + "<EmissionAreas>" + areas + "</EmissionAreas>")));
  };
  const std::string area =
      "<BottomArea><Length>1.2</Length><Width>0.3</Width><LengthOffset>0</LengthOffset>"
      "<WidthOffset>0.1</WidthOffset></BottomArea>";
  const std::string body =
      "<Dimensions><Length>1.3</Length><Width>0.4</Width><Height>0.1</Height></Dimensions>";
  const LuminaireFile panel = with("<BottomFace>" + area + "</BottomFace>", body);
  EXPECT_NEAR(panel.opening.along_c90, 1.2, 1e-12);
  EXPECT_NEAR(panel.opening.along_c0, 0.3, 1e-12);
  EXPECT_FALSE(panel.opening.is_round);
  EXPECT_NEAR(panel.body.along_c90, 1.3, 1e-12);
  EXPECT_NEAR(panel.body.along_c0, 0.4, 1e-12);
  EXPECT_TRUE(notes(panel, "off the middle"));
  const LuminaireFile disc = with(
      "<TopFace><TopArea><Length>0.2</Length><Width>0.2</Width><Circular>true</Circular>"
      "</TopArea></TopFace><C0Face><C0Area><Height>0.05</Height></C0Area></C0Face>",
      "<Dimensions><Length>600</Length><Width>600</Width><Height>50</Height></Dimensions>");
  EXPECT_TRUE(disc.opening.is_round);
  EXPECT_EQ(disc.opening_height, 0.05);
  EXPECT_FALSE(disc.body.is_known());
  EXPECT_TRUE(notes(disc, "as if in millimetres"));
  EXPECT_TRUE(notes(disc, "height of 0.05 m"));
  EXPECT_TRUE(read(file_of(emitter(luminous_data(grid({0}))))).opening.is_point());
}

TEST_F(Tm33, WhatIsTakenForGrantedIsNoted) {
  const LuminaireFile luminaire = read(file_of(
      "<Emitter><Quantity>4</Quantity><Description>board</Description>" + luminous_data(grid({0})) +
      "<Channels><NumChannels>2</NumChannels></Channels></Emitter>"));
  EXPECT_TRUE(notes(luminaire, "stands for 4 alike"));
  EXPECT_TRUE(notes(luminaire, "channels to dim"));
}

// A file is that of a luminaire by its root, whatever stands before the root.
TEST_F(Tm33, RootElementsTellLuminairesFromScenes) {
  const auto is_one = [&](const std::string& text) {
    return is_luminaire_file(folder_.write("it.xml", text));
  };
  EXPECT_TRUE(is_one(file_of("")));
  EXPECT_TRUE(
      is_one("\xef\xbb\xbf<?xml version='1.0'?>\r\n<!-- <scene> -->\n<!DOCTYPE x>\n<IESTM33/>"));
  EXPECT_TRUE(is_one("<IESTM33-18 version='1.0'>"));
  const std::string wide("\xff\xfe<\0I\0E\0S\0T\0M\0003\0003\0>\0", 20);
  EXPECT_TRUE(is_one(wide));
  EXPECT_FALSE(is_one("<scene version='3.0.0'><IESTM33/></scene>"));
  EXPECT_FALSE(is_one("<!-- <IESTM33/>"));
  EXPECT_FALSE(is_one(""));
  EXPECT_FALSE(is_luminaire_file(folder_ / "none.xml"));
}

TEST_F(Tm33, MistakesAreToldWithTheirLine) {
  const auto intensities = [](const std::string& text) {
    return file_of(emitter(luminous_data("\n" + text)));
  };
  const std::string two = "<IntData h='0' v='0'>1</IntData><IntData h='0' v='90'>1</IntData>";
  expect_error("<scene/>", {"it.xml:1:", "root element is <scene>", "<IESTM33-22>"});
  expect_error("", {"it.xml:1:", "this is not XML"});
  const std::string good = intensities(grid({0}));
  expect_error(good.substr(0, good.size() / 2), {"this is not XML", "TM-33 files are"});
  expect_error(file_of(""), {"it.xml:2:", "there is no <Emitter>"});
  expect_error(file_of(emitter("")), {"'board' has neither <LuminousIntensity>", "give one"});
  expect_error(file_of(emitter("<PhotonData/>")), {"photon intensities are not read"});
  expect_error(intensities(""), {"there is no <IntData>"});
  expect_error(intensities("<IntData h='0' v='0'>-1</IntData>"), {"it.xml:5:", "is -1", "below 0"});
  for (const char* text : {"NaN", "INF", "1e400", "", "1,5", "bright"}) {
    expect_error(intensities("<IntData h='0' v='0'>" + std::string(text) + "</IntData>"),
                 {"it.xml:5:", "the intensity '" + std::string(text) + "' is not a finite number"});
  }
  expect_error(intensities("<IntData h='0' v='0'>1e300</IntData>"), {"not be above 1e+18"});
  expect_error(intensities("<IntData h='0'>1</IntData>"), {"no angle 'v'", "'h' and 'v'"});
  expect_error(intensities("<IntData h='0' v='up'>1</IntData>"), {"angle v 'up' is not a finite"});
  expect_error(intensities("<IntData h='-90' v='0'>1</IntData>"), {"angle h is -90", "0 and 360"});
  expect_error(intensities("<IntData h='0' v='181'>1</IntData>"), {"angle v is 181", "0 and 180"});
  expect_error(intensities("<IntData h='0' v='0'>1</IntData>"), {"one vertical angle"});
  expect_error(intensities(two + "<IntData h='90' v='0'>1</IntData>"),
               {"3 intensities at 2 horizontal and 2 vertical", "each pair"});
  expect_error(
      intensities(two + "<IntData h='90' v='0'>1</IntData><IntData h='0' v='0'>1</IntData>"),
      {"h 0, v 0 is given twice"});
  expect_error(intensities("<NumberVert>3</NumberVert>" + two),
               {"NumberVert is 3", "at 2 vertical angles"});
  expect_error(intensities("<NumberHorz>1e99</NumberHorz>" + two), {"NumberHorz is 1e+99"});
  expect_error(intensities(grid({0, 100})), {"from 0 to 100", "from 0 they end at"});
  expect_error(intensities(grid({90, 270})), {"from 90 to 270", "by way of 180"});
  expect_error(intensities("<Symm>Symm_Quad</Symm>" + grid({0, 180})), {"symm_quad", "halves"});
  expect_error(intensities("<Symm>Symm_None</Symm>" + grid({0})), {"symm_none", "all around"});
  expect_error(intensities("<Symm>threefold</Symm>" + two), {"'threefold' is unknown"});
  expect_error(intensities("<Multiplier>0</Multiplier>" + two), {"make 0", "above 0"});
  expect_error(intensities("<Multiplier>-2</Multiplier>" + two), {"make -2", "above 0"});
  expect_error(file_of("<Equipment><Gonioradiometer>\n<Type>CIE_A</Type></Gonioradiometer>"
                       "</Equipment>" +
                       emitter(luminous_data(two))),
               {"it.xml:5:", "type 'CIE_A'", "only type C"});
  expect_error(file_of("<Luminaire><Dimensions><Length>-1</Length></Dimensions></Luminaire>" +
                       emitter(luminous_data(two))),
               {"Length is -1 m"});
  expect_error(
      file_of("<Emitter><InputWattage>-5</InputWattage>" + luminous_data(two) + "</Emitter>"),
      {"input wattage is -5"});
  folder_.write("it.xml", intensities(two));
  test::expect_message([&] { read_luminaire(folder_ / "it.xml", 2); }, {"set 2 is asked for"});
}

TEST_F(Tm33, LargeAndDeepFilesAreRefused) {
  std::string emitters;
  for (int i = 0; i < 101; ++i) emitters += emitter("");
  expect_error(file_of(emitters), {"101 emitters", "at most 100"});
  std::string angles;
  for (int i = 0; i <= 4000; ++i) {
    angles += "<IntData h='0' v='" + std::to_string(i * 0.04) + "'>1</IntData>";
  }
  expect_error(file_of(emitter(luminous_data(angles))), {"4001 vertical angles", "at most 4000"});
  std::string turn, arc;
  for (int i = 0; i < 1001; ++i) {
    for (const char* v : {"0", "180"}) {
      turn += "<IntData h='" + std::to_string(i * 0.35) + "' v='" + v + "'>1</IntData>";
    }
    arc += "<IntData h='0' v='" + std::to_string(i * 0.17) + "'>1</IntData>";
  }
  expect_error(file_of(emitter(luminous_data(turn)) + emitter(luminous_data(arc))),
               {"more than 1000000 intensities", "same angles"});
  // The parser takes nested elements without recursion, so that no stack runs out.
  constexpr int deep = 1000000;
  std::string nested;
  for (int i = 0; i < deep; ++i) nested += "<a>";
  for (int i = 0; i < deep; ++i) nested += "</a>";
  EXPECT_EQ(read(file_of(nested + emitter(luminous_data(grid({0}))))).web->peak(), 190.0);
  expect_error(std::string((std::size_t{32} << 20) + 1, ' '), {"33554433 bytes", "not read"});
}

class Tm33Spectra : public Tm33 {
 protected:
  static std::string spectrum(const std::string& data) {
    return "<SpectralData><EmitterSpectral>" + data + "</EmitterSpectral></SpectralData>";
  }
  // Power in proportion to the wavelength's distance from 300 nm.
  static std::string ramp() {
    return spectrum("<PwrData w=\"350\">1</PwrData><PwrData w=\"850\">11</PwrData>");
  }
  Scene scene(const std::string& lamp, const std::string& bands) {
    folder_.write("room.toml", "[bands]\n" + bands + R"(
[materials.white]
reflectance = 0.7
[[surfaces]]
material = "white"
box = { min = [0, 0, 0], max = [4, 3, 2.5], inward = true }
[[lamps]]
position = [2, 1, 2]
aim = [0, 0, -1]
file = "it.xml"
)" + lamp);
    return read_scene(folder_ / "room.toml");
  }
};

TEST_F(Tm33Spectra, BandsGetTheSpectrumOfTheFile) {
  read(file_of(emitter(luminous_data(grid({0})) + ramp())));
  for (const char* bands : {"kind = \"spectral\"\nfrom = 380\nto = 785\ncount = 81",
                            "kind = \"spectral\"\nfrom = 400\nto = 700\ncount = 3"}) {
    const Scene room = scene("", bands);
    const Spectrum& intensity = room.lamps.at(0).intensity;
    const auto& centres = room.bands.wavelengths_nm;
    for (std::size_t k = 0; k < centres.size(); ++k) {
      // The mean of a ramp is its value at the middle of the band.
      const double expected = (centres[k] - 300.0) / (centres[0] - 300.0);
      // Single precision rounds both powers by 6e-8.
      EXPECT_NEAR(intensity[static_cast<Eigen::Index>(k)] / intensity[0], expected,
                  5e-7 * expected);
    }
    // The intensity is the spectrum of 1 cd; up to 81 floats are added, each off by 6e-8.
    EXPECT_NEAR(luminous(room.bands, intensity), 1.0, 5e-6);
  }
}

TEST_F(Tm33Spectra, TheKeyColourGoesFirstAndRgbIsWhite) {
  read(file_of(emitter(luminous_data(grid({0})) + ramp())));
  const std::string three = "kind = \"spectral\"\nfrom = 400\nto = 700\ncount = 3";
  const Scene coloured = scene("colour = [4, 2, 1]", three);
  EXPECT_NEAR(coloured.lamps[0].intensity[0] / coloured.lamps[0].intensity[2], 4.0, 1e-5);
  const Scene rgb = scene("", "kind = \"rgb\"");
  EXPECT_EQ(rgb.lamps[0].intensity[0], rgb.lamps[0].intensity[2]);
  ASSERT_FALSE(rgb.notes.empty());
  EXPECT_TRUE(says(rgb.notes.back(), "it.xml: Its spectra are for scenes of wavelengths"));
  read(file_of(emitter(luminous_data(grid({0})) +
                       spectrum("<PwrData w='400'>1</PwrData><PwrData w='700'>1</PwrData>"))));
  test::expect_message([&] { scene("", "kind = \"spectral\"\nfrom = 380\nto = 780\ncount = 4"); },
                       {"file of lamp 'lamp1' covers 400-700 nm", "380-480nm"});
}

// Emitters of 1:3 candela and of one line each share the light of the bands as their flux.
TEST_F(Tm33Spectra, EmittersShareTheBandsByTheirFlux) {
  const auto line = [](const char* first, const char* second) {
    return spectrum("<PwrData w='400'>" + std::string(first) + "</PwrData><PwrData w='549'>" +
                    first + "</PwrData><PwrData w='551'>" + second + "</PwrData><PwrData w='700'>" +
                    second + "</PwrData>");
  };
  const LuminaireFile both =
      read(file_of(emitter(luminous_data(grid({0})) + line("1", "0"), "blue") +
                   emitter(luminous_data(grid({0}, gammas, 3.0)) + line("0", "1"), "red")));
  ASSERT_EQ(both.spectra.size(), 2u);
  EXPECT_NEAR(both.spectra[1].flux / both.spectra[0].flux, 3.0, 1e-9);
  const Scene room = scene("", "kind = \"spectral\"\nfrom = 400\nto = 700\ncount = 2");
  const Spectrum& intensity = room.lamps.at(0).intensity;
  Spectrum blue = intensity, red = intensity;
  blue[1] = 0.0f;
  red[0] = 0.0f;
  // The slope from 549 to 551 nm puts 0.25 nm of power of each emitter into the band of the other:
  // 0.25 of 149.75 = 0.17 % of each, so the ratio of 3 is known to 0.7 %.
  EXPECT_NEAR(luminous(room.bands, red) / luminous(room.bands, blue), 3.0, 0.007 * 3.0);
}

TEST_F(Tm33Spectra, SpectraThatCannotBeUsed) {
  const auto with = [&](const std::string& text) {
    return file_of(emitter(luminous_data(grid({0})) + "\n" + text));
  };
  const std::string two = "<PwrData w='400'>1</PwrData><PwrData w='700'>1</PwrData>";
  expect_error(with(spectrum("<PwrData w='400'>1</PwrData>")), {"it.xml:8:", "at least two"});
  expect_error(with(spectrum("<PwrData w='400'>1</PwrData><PwrData w='400'>1</PwrData>")),
               {"400 nm follows 400 nm"});
  expect_error(with(spectrum("<PwrData w='400'>NaN</PwrData>")), {"power 'NaN' is not a finite"});
  expect_error(with(spectrum("<PwrData>1</PwrData>")), {"wavelength w '' is not a finite"});
  expect_error(with(spectrum("<NumberWavelength>3</NumberWavelength>" + two)),
               {"NumberWavelength is 3", "2 <PwrData>"});
  const LuminaireFile quanta = read(with(spectrum("<Quantum>1</Quantum>" + two)));
  EXPECT_TRUE(quanta.spectra.empty());
  EXPECT_TRUE(notes(quanta, "spectrum of photons"));
  const LuminaireFile several =
      read(with("<SpectralData><EmitterSpectral/><EmitterSpectral/></SpectralData>"));
  EXPECT_TRUE(notes(several, "2 spectra without their shares"));
  const LuminaireFile one_of_two = read(file_of(emitter(luminous_data(grid({0})) + spectrum(two)) +
                                                emitter(luminous_data(grid({0})))));
  EXPECT_TRUE(one_of_two.spectra.empty());
  EXPECT_TRUE(notes(one_of_two, "a spectrum for every emitter"));
  read(with(spectrum("<PwrData w='300'>-1</PwrData><PwrData w='900'>-1</PwrData>")));
  test::expect_message([&] { scene("", "kind = \"spectral\"\nfrom = 400\nto = 700\ncount = 3"); },
                       {"emitter 'board'", "without visible light", "'colour'"});
}

}  // namespace
}  // namespace lightwell::tm33_file_test
