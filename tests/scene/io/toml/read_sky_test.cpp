// Skies in scene files: native, Mitsuba, environment maps.
#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "scene/cie_daylight.h"
#include "scene/clear_sky.h"
#include "scene/errors.h"
#include "scene/io/pictures/environment_file.h"
#include "scene/io/read_scene.h"
#include "scene/perez_sky.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_sky_test {
namespace {

constexpr double pi = std::numbers::pi;

const std::string ground = R"(
[materials.grey]
reflectance = 0.5
[[surfaces]]
name = "ground"
material = "grey"
polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
)";

class NativeSky : public testing::Test {
 protected:
  Scene read(const std::string& sky) const {
    std::ofstream(folder_ / "s.toml") << ground << sky;
    return read_toml(folder_ / "s.toml");
  }
  std::string refusal(const std::string& sky) const {
    try {
      read(sky);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  double lux(const Scene& scene) const {
    return luminous(scene.bands, diffuse_horizontal_irradiance(*scene.sky));
  }
  TemporaryFolder folder_;
};

TEST_F(NativeSky, OvercastSkyComesToItsIlluminance) {
  const Scene scene = read("[sky]\nkind = 'cie-overcast'\nilluminance = 10000\nup = [0, 0, 1]\n");
  ASSERT_TRUE(scene.sky);
  EXPECT_EQ(scene.sky->kind, SkyKind::overcast);
  EXPECT_NEAR(lux(scene), 10000.0, 2e-6 * 10000.0);  // summed in floats
  // The default reflectance of the ground is 0.2.
  EXPECT_NEAR(luminous(scene.bands, scene.sky->ground), 0.2 * 10000.0 / pi,
              2e-6 * 0.2 * 10000.0 / pi);
  EXPECT_TRUE(scene.sky->up.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(gives_light(scene));
  EXPECT_EQ(free_source_count(scene), 1);
  EXPECT_EQ(free_source_name(scene, 0), "sky");
}

const std::string wavelengths = "[bands]\nkind = 'spectral'\nfrom = 380\nto = 780\nstep = 5\n";

Eigen::Array3d xyz_of(const Bands& bands, const Spectrum& values) {
  return (bands.xyz.matrix() * values.matrix()).array().cast<double>();
}

/// Dome and sun have the chromaticities of their temperatures, and the lux that the table states.
/// The table of daylight and colour matching over bands of 5 nm leave 2e-4; floats 1e-6.
TEST_F(NativeSky, DaylightHasTheChromaticityOfItsTemperature) {
  const Scene scene = read(wavelengths +
                           "[sky]\nkind = 'cie-clear'\nilluminance = 10000\ncct = 12000\n"
                           "[sky.sun]\naltitude = 40\nazimuth = 90\nilluminance = 50000\n"
                           "spectrum = 'D55'\n");
  EXPECT_NEAR(lux(scene), 10000.0, 2e-6 * 10000.0);
  EXPECT_NEAR(luminous(scene.bands, scene.sky->sun->irradiance), 50000.0, 2e-6 * 50000.0);
  const auto expect_chromaticity = [&](const Spectrum& values, double kelvin) {
    const Eigen::Array3d xyz = xyz_of(scene.bands, values);
    const Eigen::Vector2d xy = daylight_chromaticity(kelvin);
    EXPECT_NEAR(xyz[0] / xyz.sum(), xy.x(), 2e-4) << kelvin;
    EXPECT_NEAR(xyz[1] / xyz.sum(), xy.y(), 2e-4) << kelvin;
  };
  expect_chromaticity(scene.sky->scale, 12000.0);
  expect_chromaticity(scene.sky->sun->irradiance, 5503.0);
}

// Red and blue over green of a chromaticity: sRGB of IEC 61966-2-1, whose matrix has four digits.
Eigen::Array2d red_and_blue(const Eigen::Vector2d& xy) {
  const Eigen::Vector3d xyz(xy.x() / xy.y(), 1.0, (1.0 - xy.x() - xy.y()) / xy.y());
  Eigen::Matrix3d matrix;
  matrix << 3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570;
  const Eigen::Vector3d rgb = matrix * xyz;
  return {rgb[0] / rgb[1], rgb[2] / rgb[1]};
}

/// Red, green and blue are those of the chromaticity of the temperature. The table of daylight and
/// the narrow bands leave 2e-4 of x and y, as above, of which the test takes the worst corner. Half
/// a unit of the matrix's last digit times X + Y + Z, 3.9 at most for Y = 1, is 2e-4 of red, green
/// or blue. Green lies near 1 and blue is 1.82 at most, so a ratio is off by (1 + 1.82) 2e-4, 6e-4,
/// at most. Daylight of a lower temperature is redder.
TEST_F(NativeSky, DaylightOfRedGreenAndBlueHasTheSpectrumsChromaticity) {
  const auto scale = [&](const std::string& spectrum) {
    const Scene scene = read("[sky]\nkind = 'uniform'\nilluminance = 1000\n" + spectrum);
    EXPECT_NEAR(lux(scene), 1000.0, 2e-6 * 1000.0);
    return Spectrum(scene.sky->scale / scene.sky->scale[1]);
  };
  const auto expect_ratios = [&](const std::string& statement, double kelvin) {
    const Spectrum found = scale(statement);
    const Eigen::Vector2d xy = daylight_chromaticity(kelvin);
    const Eigen::Array2d expected = red_and_blue(xy);
    Eigen::Array2d within = Eigen::Array2d::Constant(6e-4);
    constexpr double off = 2e-4;
    for (const auto& corner : {Eigen::Vector2d(off, off), Eigen::Vector2d(off, -off)}) {
      for (const double sign : {1.0, -1.0}) {
        within = within.max(6e-4 + (red_and_blue(xy + sign * corner) - expected).abs());
      }
    }
    EXPECT_NEAR(found[0], expected[0], within[0]) << statement;
    EXPECT_NEAR(found[2], expected[1], within[1]) << statement;
    return expected;
  };
  expect_ratios("spectrum = 'D65'\n", 6500.0 * 1.4388 / 1.4380);
  const Eigen::Array2d warm = expect_ratios("cct = 4500\n", 4500.0);
  const Eigen::Array2d cold = expect_ratios("cct = 20000\n", 20000.0);
  EXPECT_GT(warm[0], cold[0]);
  EXPECT_LT(warm[1], cold[1]);
}

/// A file of two samples with the same power everywhere is the equal-energy spectrum: every band
/// of a scene of wavelengths gets the same.
TEST_F(NativeSky, DaylightTakesMeasuredSpectra) {
  folder_.write("even.csv", "wavelength_nm,power\n300,2\n900,2\n");
  const Scene scene =
      read(wavelengths + "[sky]\nkind = 'uniform'\nilluminance = 1000\nspectrum = 'even.csv'\n");
  EXPECT_LT(scene.sky->scale.maxCoeff() / scene.sky->scale.minCoeff(), 1.000001f);
  folder_.write("short.csv", "wavelength_nm,power\n450,2\n600,2\n");
  const auto refused = [&](const std::string& bands, const std::string& spectrum) {
    return refusal(bands + "[sky]\nkind = 'uniform'\nilluminance = 1000\n" + spectrum);
  };
  EXPECT_TRUE(says(refused(wavelengths, "spectrum = 'short.csv'\n"), "covers 450-600 nm"));
  EXPECT_TRUE(says(refused("", "spectrum = 'short.csv'\n"), "of visible light"));
  EXPECT_TRUE(says(refused("", "spectrum = 'D64'\n"), "\"D65\""));
  EXPECT_TRUE(says(refused("", "spectrum = 'none.csv'\n"), "none.csv"));
  EXPECT_TRUE(says(refused("", "cct = 3000\n"), "4000"));
  EXPECT_TRUE(says(refused("", "cct = 5000\ncolor = 1\n"), "second statement of what 'color'"));
  EXPECT_TRUE(says(refusal("[sky]\nkind = 'uniform'\nradiance = 1\ncct = 5000\n"),
                   "no meaning beside 'radiance'"));
  EXPECT_TRUE(says(refusal("[sky]\nkind = 'turbidity'\nturbidity = 3\ncct = 5000\n"
                           "[sky.sun]\naltitude = 30\nazimuth = 0\n"),
                   "no meaning for a sky of the kind 'turbidity'"));
  // A narrow line lies outside of the triangle of red, green and blue.
  folder_.write("line.csv", "wavelength_nm,power\n300,0\n509,0\n510,1\n511,0\n900,0\n");
  EXPECT_TRUE(says(refused("", "spectrum = 'line.csv'\n"), "no mixture of red, green and blue"));
}

/// A colour that nothing uses is a mistake of the writer.
TEST_F(NativeSky, RefusesColoursWithoutABrightness) {
  const std::string sun = "[sky.sun]\naltitude = 30\nazimuth = 0\n";
  for (const char* colour : {"color = [1, 2, 3]\n", "cct = 5500\n", "spectrum = 'D55'\n"}) {
    EXPECT_TRUE(says(refusal("[sky]\nkind = 'turbidity'\nturbidity = 3\n" + sun + colour),
                     "no meaning without a brightness"));
    EXPECT_TRUE(
        says(refusal("[sky]\nkind = 'none'\n" + std::string(colour) + sun + "illuminance = 1000\n"),
             "no meaning for a sky of the kind 'none'"));
    EXPECT_TRUE(says(refusal("[sky]\nkind = 'none'\n" + sun + "irradiance = 8\n" + colour),
                     "no meaning beside 'irradiance'"));
    EXPECT_TRUE(says(refusal("[sky]\nkind = 'uniform'\nradiance = 1\n" + std::string(colour)),
                     "no meaning beside 'radiance'"));
  }
}

TEST_F(NativeSky, BrightnessOfTheZenithAndRadianceAreTaken) {
  const Scene by_luminance = read("[sky]\nkind = 'uniform'\nzenith_luminance = 1000\n");
  EXPECT_NEAR(lux(by_luminance), 1000.0 * pi, 2e-6 * 1000.0 * pi);
  const Scene by_radiance =
      read("[sky]\nkind = 'cie-overcast'\nradiance = [1, 2, 3]\nground_reflectance = 0\n");
  const Spectrum zenith = sky_radiance(*by_radiance.sky, by_radiance.sky->up);
  EXPECT_NEAR(zenith[2], 3.0f, 1e-5f);
  EXPECT_EQ(by_radiance.sky->ground[0], 0.0f);
}

TEST_F(NativeSky, SunStandsWhereDateAndPlacePutIt) {
  const Scene scene = read(R"(
[sky]
kind = "cie-clear"
illuminance = 15000
up = [0, 0, 1]
north = [0, 1, 0]
[sky.sun]
date = "2003-10-17"
time = "12:30"
time_zone = -7
latitude = 39.742476
longitude = -105.1786
illuminance = 90000
)");
  ASSERT_TRUE(scene.sky->sun);
  const Eigen::Vector3d to_sun = scene.sky->sun->direction;
  EXPECT_NEAR(std::asin(to_sun.z()) * 180.0 / pi, 39.87, 0.1);
  EXPECT_NEAR(std::atan2(to_sun.x(), to_sun.y()) * 180.0 / pi + 360.0, 194.2, 0.2);
  EXPECT_NEAR(luminous(scene.bands, scene.sky->sun->irradiance), 90000.0, 2e-6 * 90000.0);
  EXPECT_NEAR(lux(scene), 15000.0, 2e-6 * 15000.0);
  EXPECT_EQ(free_source_count(scene), 2);
  EXPECT_EQ(free_source_name(scene, 1), "sun");
}

TEST_F(NativeSky, SunAloneIsAllowedAndOneBelowTheHorizonIsNoSun) {
  const Scene day =
      read("[sky]\nkind = 'none'\n[sky.sun]\nazimuth = 180\naltitude = 30\nirradiance = 800\n");
  EXPECT_EQ(free_source_count(day), 2);  // sun, and ground lit by the sun
  const Scene night =
      read("[sky]\nkind = 'none'\n[sky.sun]\nazimuth = 180\naltitude = -3\nirradiance = 800\n");
  EXPECT_FALSE(night.sky->sun);
  EXPECT_FALSE(gives_light(night));
}

TEST_F(NativeSky, PerezTakesWattsOfAllWavelengths) {
  const Scene scene = read(R"(
[sky]
kind = "perez"
diffuse_horizontal = 100
[sky.sun]
azimuth = 180
altitude = 45
direct_normal = 800
)");
  EXPECT_NEAR(lux(scene), 110.0 * 100.0, 2e-6 * 110.0 * 100.0);
  EXPECT_NEAR(luminous(scene.bands, scene.sky->sun->irradiance), 110.0 * 800.0,
              2e-6 * 110.0 * 800.0);
}

TEST_F(NativeSky, PerezTakesItsSunFromAnyStatementOfBrightness) {
  const auto sky = [&](const std::string& brightness) {
    return read(
               "[sky]\nkind = 'perez'\ndiffuse_horizontal = 100\n[sky.sun]\nazimuth = 180\n"
               "altitude = 45\n" +
               brightness + '\n')
        .sky->gradation;
  };
  const SkyGradation expected = perez_sky(800.0, 100.0, 45.0, 172);
  // The default bands are r, g and b with 683 lm/W of grey light: 110 * 800 / 683 W/m2 per band.
  for (const char* brightness :
       {"direct_normal = 800", "illuminance = 88000", "illuminance = 88000\ncolor = [2, 1, 0.5]",
        "irradiance = 128.84333821376281"}) {
    const SkyGradation found = sky(brightness);
    // The irradiance is kept in floats, good to 6e-8 each, and enters the gradation in proportion.
    EXPECT_NEAR(found.a, expected.a, 1e-6) << brightness;
    EXPECT_NEAR(found.b, expected.b, 1e-6) << brightness;
    EXPECT_NEAR(found.c, expected.c, 1e-6 * expected.c) << brightness;
    EXPECT_NEAR(found.d, expected.d, 1e-6 * -expected.d) << brightness;
    EXPECT_NEAR(found.e, expected.e, 1e-6) << brightness;
  }
  const SkyGradation dark = perez_sky(0.0, 100.0, 45.0, 172);
  EXPECT_EQ(sky("illuminance = 0").c, dark.c);
}

// Watts of some wavelengths do not tell the watts of all.
TEST_F(NativeSky, PerezRefusesASunGivenInSpectralBands) {
  const std::string message = refusal(R"(
[bands]
kind = "spectral"
count = 3
[sky]
kind = "perez"
diffuse_horizontal = 100
[sky.sun]
azimuth = 180
altitude = 45
irradiance = 800
)");
  EXPECT_NE(message.find("direct_normal"), std::string::npos) << message;
  EXPECT_NE(message.find("illuminance"), std::string::npos) << message;
}

TEST_F(NativeSky, FaultsAreSentences) {
  EXPECT_NE(refusal("[sky]\nkind = 'cie-overcast'\n").find("how bright"), std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind = 'cie-clear'\nilluminance = 1\n").find("[sky.sun]"),
            std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind = 'cie'\ntype = 16\nilluminance = 1\n").find("16"),
            std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind = 'uniform'\nilluminance = 1\nradiance = 2\n").find("second"),
            std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind = 'uniform'\nilluminance = 1\nup = [0, 0, 0]\n").find("length"),
            std::string::npos);
  EXPECT_NE(
      refusal("[sky]\nkind = 'uniform'\nilluminance = 1\nfile = 'x.exr'\n").find("no meaning"),
      std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind = 'map'\nfile = 'none.exr'\n").find("no such file"),
            std::string::npos);
  EXPECT_NE(refusal("[sky]\nkind='none'\n[sky.sun]\ndate='2024-02-30'\ntime='12:00'\nlatitude=0\n"
                    "longitude=0\nilluminance=1\n")
                .find("no date"),
            std::string::npos);
}

// A picture of 16 x 2 pixels, the upper row run-length encoded, the lower row flat.
std::string rgbe_picture() {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 16\n";
  file += std::string("\x02\x02\x00\x10", 4);
  for (const int value : {128, 64, 32, 130}) {
    file += static_cast<char>(128 + 16);
    file += static_cast<char>(value);
  }
  for (int x = 0; x < 16; ++x) file += std::string("\x80\x80\x80\x81", 4);
  return file;
}

TEST(EnvironmentFile, ReadsPicturesOfRadiance) {
  const TemporaryFolder folder;
  std::ofstream(folder / "sky.hdr", std::ios::binary) << rgbe_picture();
  const auto map = read_environment_map(folder / "sky.hdr");
  EXPECT_EQ(map->width(), 16);
  const Spectrum up = map->at(Eigen::Vector3d::UnitY());
  // A component is (m + 1/2) 2^(e - 136) / exposure.
  EXPECT_NEAR(up[0], 128.5 / 64.0 / 2.0, 1e-5);
  EXPECT_NEAR(up[2], 32.5 / 64.0 / 2.0, 1e-5);
  EXPECT_NEAR(map->at(-Eigen::Vector3d::UnitY())[1], 128.5 / 128.0 / 2.0, 1e-5);
}

TEST(EnvironmentFile, TornAndForeignFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string whole = rgbe_picture();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{8}, std::size_t{40}, std::size_t{60}, whole.size() - 1}) {
    std::ofstream(folder / "torn.hdr", std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(read_environment_map(folder / "torn.hdr"), InputError) << size;
  }
  std::ofstream(folder / "huge.hdr") << "#?RADIANCE\n\n-Y 100000 +X 100000\n";
  EXPECT_THROW(read_environment_map(folder / "huge.hdr"), InputError);
  std::ofstream(folder / "bold.hdr") << "#?RADIANCE\n\n-Y 4096 +X 8192\n" << std::string(99, 'x');
  EXPECT_THROW(read_environment_map(folder / "bold.hdr"), InputError);
  std::ofstream(folder / "text.exr") << "no picture";
  EXPECT_THROW(read_environment_map(folder / "text.exr"), InputError);
  std::ofstream(folder / "sky.png") << "no map";
  EXPECT_THROW(read_environment_map(folder / "sky.png"), InputError);
}

TEST(EnvironmentFile, ReadsOpenExr) {
  const TemporaryFolder folder;
  Imf::Array2D<Imf::Rgba> pixels(2, 4);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) pixels[y][x] = Imf::Rgba(1.0f + y, 2.0f, 3.0f, 1.0f);
  }
  {
    Imf::RgbaOutputFile file((folder / "sky.exr").c_str(), 4, 2, Imf::WRITE_RGB);
    file.setFrameBuffer(&pixels[0][0], 1, 4);
    file.writePixels(2);
  }
  const auto map = read_environment_map(folder / "sky.exr");
  EXPECT_EQ(map->height(), 2);
  EXPECT_NEAR(map->at(-Eigen::Vector3d::UnitY())[0], 2.0f, 1e-3f);
  EXPECT_NEAR(map->at(Eigen::Vector3d::UnitY())[2], 3.0f, 1e-3f);
}

const std::string clear_day = R"(
[sky]
kind = "turbidity"
turbidity = 3
up = [0, 0, 1]
[sky.sun]
azimuth = 120
altitude = 40
)";

// Lux of the model; the dome's picture sums to its irradiance within 2e-3 (clear_sky_test.cpp).
TEST_F(NativeSky, ClearDayHasTheLightOfItsModel) {
  const Scene scene = read(clear_day);
  const ClearDay day{.turbidity = 3.0,
                     .sun_altitude_degrees = 40.0,
                     .albedo = constant_spectrum(scene.bands, 0.2f)};
  const double per_nm = 683.0 * 106.857;
  const double dome = per_nm * luminous(rgb_bands(1.0), clear_sky_irradiance(day));
  EXPECT_NEAR(lux(scene), dome, 2e-3 * dome);
  const Spectrum sun = clear_sun_irradiance(ClearSunModel::hosek_wilkie, 3.0, 40.0);
  EXPECT_NEAR(luminous(scene.bands, scene.sky->sun->irradiance),
              per_nm * luminous(rgb_bands(1.0), sun), 1.0);  // of 1e5, in floats
  // The ground: rho E / pi.
  const double E = dome + luminous(scene.bands, sun_horizontal_irradiance(*scene.sky));
  const Spectrum below = sky_radiance(*scene.sky, sky_direction(*scene.sky, 10.0, -20.0));
  EXPECT_NEAR(luminous(scene.bands, below), 0.2 * E / pi, 1e-5 * E);
  // The bright side of the dome is the sun's.
  EXPECT_GT(sky_radiance(*scene.sky, sky_direction(*scene.sky, 120.0, 20.0))[1],
            2.0f * sky_radiance(*scene.sky, sky_direction(*scene.sky, 300.0, 20.0))[1]);
}

TEST_F(NativeSky, ClearDayTakesStatedLux) {
  std::string stated = clear_day + "illuminance = 50000\n";
  stated.insert(stated.find("up ="), "illuminance = 9000\nground_radiance = [1, 2, 3]\n");
  const Scene scene = read(stated);
  EXPECT_NEAR(lux(scene), 9000.0, 2e-3 * 9000.0);
  EXPECT_NEAR(luminous(scene.bands, scene.sky->sun->irradiance), 50000.0, 0.1);
  EXPECT_FLOAT_EQ(sky_radiance(*scene.sky, sky_direction(*scene.sky, 10.0, -20.0))[2], 3.0f);
}

TEST_F(NativeSky, ClearDaysThatCannotBeAreRefused) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = clear_day;
    return refusal(text.replace(text.find(from), from.size(), to));
  };
  const auto expect = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  };
  expect(changed("turbidity = 3", "turbidity = 30"), "turbidity");
  expect(changed("turbidity = 3\n", ""), "turbidity");
  expect(changed("altitude = 40", "altitude = -1"), "above the horizon");
  expect(refusal("[sky]\nkind = 'turbidity'\nturbidity = 3\n"), "[sky.sun]");
  expect(changed("up =", "zenith_luminance = 3\nup ="), "no meaning");
  expect(changed("\n[sky]", "[bands]\nkind = 'spectral'\ncount = 6\n[sky]"), "RGB bands");
  expect(refusal("[sky]\nkind = 'uniform'\nradiance = 1\nturbidity = 3\n"), "no meaning");
}

class MitsubaSky : public testing::Test {
 protected:
  Scene read(const std::string& emitters) const {
    std::ofstream(folder_ / "s.xml")
        << "<scene version=\"3.0.0\"><shape type=\"rectangle\"/>" << emitters << "</scene>";
    return read_mitsuba(folder_ / "s.xml");
  }
  TemporaryFolder folder_;
};

TEST_F(MitsubaSky, ConstantIsTheSameAllAround) {
  const Scene scene =
      read("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1, 2, 3\"/></emitter>");
  ASSERT_TRUE(scene.sky);
  EXPECT_FLOAT_EQ(sky_radiance(*scene.sky, Eigen::Vector3d::UnitY())[1], 2.0f);
  EXPECT_FLOAT_EQ(sky_radiance(*scene.sky, -Eigen::Vector3d::UnitY())[2], 3.0f);
}

TEST_F(MitsubaSky, DirectionalIsASun) {
  const Scene scene = read(
      "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-2\" z=\"0\"/>"
      "<rgb name=\"irradiance\" value=\"5, 5, 5\"/></emitter>");
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  EXPECT_TRUE(scene.sky->sun->direction.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_FLOAT_EQ(scene.sky->sun->irradiance[0], 5.0f);
  EXPECT_EQ(free_source_count(scene), 1);
}

TEST_F(MitsubaSky, MapIsTurnedByItsTransform) {
  std::ofstream(folder_ / "sky.hdr", std::ios::binary) << "#?RADIANCE\n\n-Y 1 +X 4\n"
                                                       << std::string(
                                                              "\x80\x80\x80\x81\x40\x40\x40\x81"
                                                              "\x20\x20\x20\x81\x10\x10\x10\x81",
                                                              16);
  // Pixel centres are an eighth of a turn beyond the longitudes of -z, +x, +z and -x.
  const std::string file = "<string name=\"filename\" value=\"sky.hdr\"/>";
  const Scene plain = read("<emitter type=\"envmap\">" + file + "</emitter>");
  const Eigen::Vector3d place = Eigen::Vector3d(1, 0, -1).normalized();
  EXPECT_NEAR(sky_radiance(*plain.sky, place)[0], 128.5 / 128.0, 1e-4);
  const Scene turned = read("<emitter type=\"envmap\">" + file +
                            "<float name=\"scale\" value=\"2\"/><transform name=\"to_world\">"
                            "<rotate y=\"1\" angle=\"90\"/></transform></emitter>");
  const Eigen::Vector3d moved = Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitY()) * place;
  EXPECT_NEAR(sky_radiance(*turned.sky, moved)[0], 2.0 * 128.5 / 128.0, 1e-4);
}

TEST_F(MitsubaSky, SecondSkyIsNamed) {
  const Scene scene =
      read("<emitter type=\"constant\" id=\"a\"/><emitter type=\"constant\" id=\"b\"/>");
  bool is_noted = false;
  for (const std::string& note : scene.notes) is_noted = is_noted || note.find("'b'") < note.size();
  EXPECT_TRUE(is_noted);
}

}  // namespace
}  // namespace lightwell::read_sky_test
