#include "scene/sky.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/perez_sky.h"
#include "scene/sun_position.h"

namespace lightwell::sky_test {
namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180.0;

Sky grey_sky(const SkyGradation& gradation = {}) {
  const Bands bands = rgb_bands();
  return {.gradation = gradation,
          .scale = constant_spectrum(bands, 1.0f),
          .ground = constant_spectrum(bands, 0.0f)};
}

Sky overcast_sky() {
  Sky sky = grey_sky();
  sky.kind = SkyKind::overcast;
  return sky;
}

// E of a surface with this normal, by a fine midpoint rule around the zenith.
double irradiance(const Sky& sky, const Eigen::Vector3d& normal) {
  constexpr int rings = 600, around = 1200;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double cosine = (i + 0.5) / rings;
    for (int j = 0; j < around; ++j) {
      const double phi = 2.0 * pi * (j + 0.5) / around;
      const Eigen::Vector3d w = sky_direction(sky, phi / degree, std::asin(cosine) / degree);
      sum += std::max(0.0, w.dot(normal)) * static_cast<double>(sky_radiance(sky, w)[0]);
    }
  }
  return sum * 2.0 * pi / rings / around;
}

TEST(Sky, UniformGivesPiTimesItsRadiance) {
  EXPECT_NEAR(diffuse_horizontal_irradiance(grey_sky())[1], pi, 1e-6 * pi);
}

// Moon & Spencer 1942: E_h = 7/9 pi L_zenith; on a wall 0.396 of that.
TEST(Sky, OvercastIrradiancesAreThoseOfMoonAndSpencer) {
  const Sky sky = overcast_sky();
  const double horizontal = diffuse_horizontal_irradiance(sky)[0];
  EXPECT_NEAR(horizontal, 7.0 / 9.0 * pi, 1e-5);
  // The integral of (1 + 2 sin)/3 over half the dome gives L (pi/6 + 4/9).
  const double wall = irradiance(sky, sky.north);
  EXPECT_NEAR(wall, pi / 6.0 + 4.0 / 9.0, 1e-4);
  EXPECT_NEAR(wall / horizontal, 0.396, 5e-4);
}

TEST(Sky, OvercastIsThreeTimesBrighterAtTheZenith) {
  const Sky sky = overcast_sky();
  EXPECT_FLOAT_EQ(sky_radiance(sky, sky.up)[0], 1.0f);
  EXPECT_NEAR(sky_radiance(sky, sky.north)[0], 1.0 / 3.0, 1e-6);
}

// The clear sky of CIE 1973, type 12 of ISO 15469, with the sun at 45 degrees:
// L(Z, chi) = (1 - exp(-0.32 / cos Z)) (0.91 + 10 exp(-3 chi) + 0.45 cos^2 chi).
TEST(Sky, StandardClearSkyIsThatOfKittler) {
  Sky sky = grey_sky(standard_sky(12));
  sky.bright = sky_direction(sky, 180.0, 45.0);
  const Eigen::Vector3d w = sky_direction(sky, 90.0, 30.0);
  const double chi = std::acos(w.dot(sky.bright));
  const double expected = (1.0 - std::exp(-0.32 / 0.5)) *
                          (0.91 + 10.0 * std::exp(-3.0 * chi) + 0.45 * std::pow(std::cos(chi), 2));
  EXPECT_NEAR(sky_radiance(sky, w)[0], expected, 2e-4 * expected);
}

TEST(Sky, FifthStandardSkyIsUniformAndFirstIsSteeperThanMoonAndSpencer) {
  const Sky uniform = grey_sky(standard_sky(5));
  EXPECT_FLOAT_EQ(sky_radiance(uniform, sky_direction(uniform, 10, 5))[0], 1.0f);
  const Sky overcast = grey_sky(standard_sky(1));
  const double zenith = sky_radiance(overcast, overcast.up)[0];
  EXPECT_NEAR(sky_radiance(overcast, sky_direction(overcast, 0, 0))[0] / zenith,
              1.0 / (1.0 + 4.0 * std::exp(-0.7)), 1e-5);
  EXPECT_THROW(standard_sky(0), std::invalid_argument);
  EXPECT_THROW(standard_sky(16), std::invalid_argument);
}

TEST(Sky, PerezIsBrightAboutTheSunWhenClearAndEvenWhenOvercast) {
  Sky clear = grey_sky(perez_sky(850.0, 100.0, 45.0, 172));
  clear.bright = sky_direction(clear, 180.0, 45.0);
  const double near = sky_radiance(clear, sky_direction(clear, 180.0, 40.0))[0];
  const double far = sky_radiance(clear, sky_direction(clear, 0.0, 45.0))[0];
  EXPECT_GT(near, 5.0 * far);
  EXPECT_GT(far, 0.0);
  Sky overcast = grey_sky(perez_sky(0.0, 150.0, 45.0, 172));
  overcast.bright = clear.bright;
  const double zenith = sky_radiance(overcast, overcast.up)[0];
  const double horizon = sky_radiance(overcast, sky_direction(overcast, 0.0, 2.0))[0];
  EXPECT_GT(zenith, 1.5 * horizon);  // near the standard overcast sky's 1 : 3
  EXPECT_LT(zenith, 5.0 * horizon);
  EXPECT_THROW(perez_sky(100.0, 0.0, 45.0, 1), std::invalid_argument);
  EXPECT_THROW(perez_sky(100.0, 100.0, -1.0, 1), std::invalid_argument);
}

TEST(Sky, SunFillsItsDisc) {
  Sky sky = grey_sky();
  const Eigen::Vector3d to_sun = sky_direction(sky, 120.0, 30.0);
  sky.sun = Sun{.direction = to_sun, .irradiance = constant_spectrum(rgb_bands(), 800.0f)};
  EXPECT_NEAR(sky.sun->solid_angle(), 6.796e-5, 1e-8);  // pi (0.533 / 2 degrees)^2
  EXPECT_NEAR(radiance_outside(sky, to_sun)[0] * sky.sun->solid_angle(), 800.0, 0.1);
  EXPECT_FLOAT_EQ(radiance_outside(sky, sky_direction(sky, 121.0, 30.0))[0], 1.0f);
  EXPECT_NEAR(sun_horizontal_irradiance(sky)[0], 400.0, 1e-3);
}

TEST(Sky, DirectionsAreByCompass) {
  const Sky sky;  // up +y, north -z
  EXPECT_TRUE(sky_direction(sky, 90.0, 0.0).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(sky_direction(sky, 180.0, 0.0).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(sky_direction(sky, 77.0, 90.0).isApprox(sky.up));
}

TEST(Sky, MapIsLaidOutByLongitudeAndLatitude) {
  constexpr int width = 64, height = 32;
  BandArray pixels = BandArray::Zero(width * height, 3);
  pixels.row(16 * width + 32).setConstant(5.0f);  // a little right of the middle: +z
  pixels.row(16 * width + 48).setConstant(7.0f);  // -x
  pixels.topRows(width).setConstant(9.0f);        // up
  const EnvironmentMap map(width, height, pixels);
  const double half = pi / width, down = -0.5 * pi / height;
  const auto at = [&](double longitude) {
    return Eigen::Vector3d(-std::cos(down) * std::sin(longitude), std::sin(down),
                           std::cos(down) * std::cos(longitude));
  };
  EXPECT_NEAR(map.at(at(half))[0], 5.0f, 1e-4f);
  EXPECT_NEAR(map.at(at(0.5 * pi + half))[0], 7.0f, 1e-4f);
  EXPECT_FLOAT_EQ(map.at(Eigen::Vector3d::UnitY())[0], 9.0f);
  EXPECT_FLOAT_EQ(map.at(-Eigen::Vector3d::UnitY())[0], 0.0f);
  EXPECT_THROW(EnvironmentMap(2, 2, BandArray::Zero(3, 3)), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap(1, 1, BandArray::Constant(1, 3, -1.0f)), std::invalid_argument);
}

TEST(Sky, EvenMapIsTheUniformSky) {
  Sky sky = grey_sky();
  sky.kind = SkyKind::map;
  sky.map = std::make_shared<EnvironmentMap>(8, 4, BandArray::Constant(32, 3, 2.0f));
  EXPECT_NEAR(diffuse_horizontal_irradiance(sky)[2], 2.0 * pi, 1e-5);
}

TEST(Sky, HashFollowsWhatDecidesTheLight) {
  Sky sky = grey_sky();
  const auto hash = sky_hash(sky);
  sky.name = "another name";
  EXPECT_EQ(sky_hash(sky), hash);
  sky.scale *= 2.0f;
  EXPECT_NE(sky_hash(sky), hash);
  sky.scale *= 0.5f;
  sky.sun = Sun{.irradiance = constant_spectrum(rgb_bands(), 1.0f)};
  EXPECT_NE(sky_hash(sky), hash);
}

TEST(Sky, WrongValuesAreRefused) {
  const Bands bands = rgb_bands();
  Sky sky = grey_sky();
  EXPECT_NO_THROW(validate(sky, bands));
  sky.up *= 2.0;
  EXPECT_THROW(validate(sky, bands), std::invalid_argument);
  sky = grey_sky();
  sky.scale[1] = -1.0f;
  EXPECT_THROW(validate(sky, bands), std::invalid_argument);
  sky = grey_sky();
  sky.ground.resize(2);
  EXPECT_THROW(validate(sky, bands), std::invalid_argument);
  sky = grey_sky();
  sky.sun = Sun{.irradiance = constant_spectrum(bands, 1.0f), .angle_degrees = 0.0};
  EXPECT_THROW(validate(sky, bands), std::invalid_argument);
  sky = grey_sky();
  sky.kind = SkyKind::map;
  EXPECT_THROW(validate(sky, bands), std::invalid_argument);
}

// Reda & Andreas 2003, "Solar position algorithm for solar radiation applications", example of
// appendix A.5: Golden, Colorado; elevation without refraction.
TEST(SunPosition, AgreesWithThePublishedExample) {
  const SunPosition sun = sun_position({.year = 2003,
                                        .month = 10,
                                        .day = 17,
                                        .hour = 12.0 + 30.0 / 60.0 + 30.0 / 3600.0,
                                        .hours_east = -7.0},
                                       39.742476, -105.1786);
  EXPECT_NEAR(sun.altitude_degrees, 39.872, 0.02);
  EXPECT_NEAR(sun.azimuth_degrees, 194.340, 0.02);
}

// Meeus 1998, "Astronomical Algorithms", example 25.b: declination -7.785 degrees on 1992-10-13 at
// 0 h. At the pole the altitude is the declination.
TEST(SunPosition, DeclinationIsThatOfMeeus) {
  const SunPosition sun =
      sun_position({.year = 1992, .month = 10, .day = 13, .hour = 0.0}, 90.0, 0.0);
  EXPECT_NEAR(sun.altitude_degrees, -7.785, 0.02);
}

TEST(SunPosition, SolsticesReachTheTropics) {
  // Solstice of 2024: 20 June, 20:51 UTC.
  EXPECT_NEAR(sun_position({.year = 2024, .month = 6, .day = 20, .hour = 20.85}, 90.0, 0.0)
                  .altitude_degrees,
              23.44, 0.01);
  // Equinox of March 2024: 20 March, 3:06 UTC.
  EXPECT_NEAR(
      sun_position({.year = 2024, .month = 3, .day = 20, .hour = 3.1}, 90.0, 0.0).altitude_degrees,
      0.0, 0.01);
}

TEST(SunPosition, StandsInTheSouthAtNoonAndInTheEastInTheMorning) {
  const SunPosition noon =
      sun_position({.year = 2024, .month = 4, .day = 15, .hour = 12.0}, 52.0, 0.0);
  EXPECT_NEAR(noon.azimuth_degrees, 180.0, 0.5);  // the equation of time is 0 then
  const SunPosition morning =
      sun_position({.year = 2024, .month = 3, .day = 20, .hour = 8.0}, 52.0, 0.0);
  EXPECT_GT(morning.azimuth_degrees, 90.0);
  EXPECT_LT(morning.azimuth_degrees, 135.0);
}

TEST(SunPosition, WrongDatesAndPlacesAreRefused) {
  EXPECT_THROW(sun_position({.year = 2023, .month = 2, .day = 29}, 0.0, 0.0),
               std::invalid_argument);
  EXPECT_THROW(sun_position({.hour = 24.0}, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(sun_position({}, 91.0, 0.0), std::invalid_argument);
  EXPECT_EQ(day_of_year(2024, 12, 31), 366);
  EXPECT_EQ(day_of_year(2023, 3, 1), 60);
}

}  // namespace
}  // namespace lightwell::sky_test
