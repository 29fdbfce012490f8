// Skies and suns of RADIANCE scenes: sources, gensky, gendaylit, functions of direction.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/sky.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::radiance_sky_test {
namespace {

using test::has_loss;
using test::has_note;

constexpr double pi = std::numbers::pi;

// A blueish sky and a ground that multiply "skyfunc".
const std::string sky_and_ground =
    "\nskyfunc glow skyglow 0 0 4 .9 .95 1.1 0\nskyglow source sky 0 0 4 0 0 1 180\n"
    "skyfunc glow groundglow 0 0 4 1 .9 .7 0\ngroundglow source ground 0 0 4 0 0 -1 180\n";

class RadianceSkies : public test::SceneFileTest {
 protected:
  // A scene of these sources and one black square.
  Scene read(const std::string& content) const {
    return read_file("scene.rad", content +
                                      "\nvoid plastic black 0 0 5 0 0 0 0 0\n"
                                      "black polygon square 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n");
  }
};

// Irradiance without obstacles of a surface with this normal: the midpoint rule over 400 x 800
// directions, whose error is below 1e-4 for these skies, and the sun's cosine.
Spectrum irradiance(const Sky& sky, const Eigen::Vector3d& normal) {
  constexpr int rings = 400, sectors = 800;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double z = 2.0 * (i + 0.5) / rings - 1.0, turn = 2.0 * pi * (j + 0.5) / sectors;
      const double out = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d direction(out * std::cos(turn), out * std::sin(turn), z);
      const double cosine = direction.dot(normal);
      if (cosine > 0.0) sum += cosine * sky_radiance(sky, direction).cast<double>();
    }
  }
  Spectrum result = (sum * 4.0 * pi / (rings * sectors)).cast<float>();
  if (sky.sun) {
    result +=
        sky.sun->irradiance * static_cast<float>(std::max(0.0, sky.sun->direction.dot(normal)));
  }
  return result;
}

// A sky by a command, and irradiances that RADIANCE 6.0a (2025) computes: rtrace -ab 1 -ad 65536
// with the programs' own skies.
struct Reference {
  const char* command;
  std::array<double, 3> up, east, south, down;  // r, g, b
};

void expect_irradiance(const Sky& sky, const Reference& r, double tolerance) {
  const auto check = [&](const Eigen::Vector3d& normal, const std::array<double, 3>& expected) {
    const Spectrum found = irradiance(sky, normal);
    for (int k = 0; k < 3; ++k) {
      const double e = expected[static_cast<std::size_t>(k)];
      EXPECT_NEAR(found[k], e, tolerance * e)
          << r.command << ", towards " << normal.transpose() << ", band " << k;
    }
  };
  check(Eigen::Vector3d::UnitZ(), r.up);
  check(Eigen::Vector3d::UnitX(), r.east);
  check(-Eigen::Vector3d::UnitY(), r.south);
  check(-Eigen::Vector3d::UnitZ(), r.down);
}

TEST_F(RadianceSkies, GenskysSkiesAreThoseOfGensky) {
  const std::array<Reference, 3> references = {{{"gensky 3 21 12 +s",
                                                 {367.1319, 369.5070, 376.6331},
                                                 {87.32673, 84.86902, 81.22195},
                                                 {329.2591, 327.5503, 326.2243},
                                                 {74.48804, 67.01159, 52.19283}},
                                                {"gensky -ang 40 30 +i",
                                                 {101.3454, 104.8542, 115.3796},
                                                 {31.54155, 31.55290, 32.69111},
                                                 {98.99516, 100.3914, 105.8513},
                                                 {21.86625, 19.68028, 15.31452}},
                                                {"gensky 7 12 17 -c",
                                                 {44.13994, 46.59211, 53.94842},
                                                 {22.38643, 22.82992, 24.68011},
                                                 {22.40082, 22.84039, 24.67764},
                                                 {9.848190, 8.868168, 6.896347}}}};
  // rtrace's 65536 rays of a hemisphere leave a noise of 0.15 % (the spread of its walls under the
  // overcast sky, which all have the same light, is 0.06 %), gensky writes three or four digits
  // (0.05 %), and the sun's light over a wall changes by 0.3 % with its angle's last digit.
  constexpr double tolerance = 0.005;
  for (const Reference& r : references) {
    const Scene scene = read(std::string("!") + r.command + sky_and_ground);
    ASSERT_TRUE(scene.sky) << r.command;
    expect_irradiance(*scene.sky, r, tolerance);
  }
}

TEST_F(RadianceSkies, GendaylitsSkiesAreThoseOfGendaylit) {
  const std::array<Reference, 2> references = {
      {{"gendaylit 3 21 12 -W 600 150",
        {370.2101, 376.1069, 393.7955},
        {113.1113, 112.3529, 113.7590},
        {334.2480, 335.3846, 342.5733},
        {70.54709, 63.51616, 49.34291}},
       {"gendaylit 6 21 15 -a 52 -o -13 -m -15 -L 60000 15000 -y 2017",
        {319.0176, 323.1522, 335.5573},
        {59.53441, 57.86627, 56.03901},
        {176.8680, 176.3455, 177.9816},
        {60.82557, 54.74040, 42.55998}}}};
  // gendaylit integrates its sky by 145 patches, which makes the dome 1 % darker than the light it
  // is asked for; walls see mostly dome. Noise as above.
  constexpr double tolerance = 0.012;
  for (const Reference& r : references) {
    const Scene scene = read(std::string("!") + r.command + sky_and_ground);
    ASSERT_TRUE(scene.sky) << r.command;
    expect_irradiance(*scene.sky, r, tolerance);
  }
}

TEST_F(RadianceSkies, GendaylitGivesTheLuxThatItIsAskedFor) {
  const Scene scene = read(
      "!gendaylit -ang 40 0 -L 60000 15000 -g 0\nskyfunc glow skyglow 0 0 4 1 1 1 0\n"
      "skyglow source sky 0 0 4 0 0 1 180");
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  constexpr double lumens_per_watt = 179.0;
  EXPECT_NEAR(scene.sky->sun->irradiance[1] * lumens_per_watt, 60000.0, 1.0);
  Sky dome = *scene.sky;
  dome.sun.reset();
  // perezlum.cal lets the dome pass into the ground, which is black here, with the share
  // 1 / (1 + (z + 1.01)^20) at the height z: 0.42 % of a uniform dome's light. This dome is up to
  // 2.5 times as bright at the horizon as on average.
  const double lux = irradiance(dome, Eigen::Vector3d::UnitZ())[1] * lumens_per_watt;
  EXPECT_LT(lux, 15000.0 * (1.0 - 0.0042));
  EXPECT_GT(lux, 15000.0 * (1.0 - 2.5 * 0.0042));
}

TEST_F(RadianceSkies, AFunctionOfDirectionOfTheScenesOwnFileIsTheSky) {
  folder.write("mine.cal",
               "{ twice the height {above the horizon} }\nhigh = 2 * Dz;\n"
               "bands(k) = select(k, 1, high, east * A1); east = if(Dx, Dx, 0);");
  const Scene scene = read(
      "void colorfunc f 4 bands(1) bands(2) bands(3) mine.cal 0 1 3\n"
      "f glow g 0 0 4 1 1 .5 0\ng source s 0 0 4 0 0 1 180");
  ASSERT_TRUE(scene.sky);
  EXPECT_TRUE(has_note(scene, "tabulated by direction"));
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(0.6, 0.0, 0.8), Eigen::Vector3d(0.48, -0.6, 0.64),
        Eigen::Vector3d(-0.36, 0.48, 0.8)}) {
    const Spectrum radiance = sky_radiance(*scene.sky, d);
    // Bilinear between pixels h = 0.35 degrees apart: off by h^2 / 8 of the second derivative in
    // either direction, which is at most the radiance's largest value here.
    constexpr double h = 2.0 * pi / 1024.0, floats = 4 * 0x1p-24;
    EXPECT_NEAR(radiance[0], 1.0, floats);
    EXPECT_NEAR(radiance[1], 2.0 * d.z(), 2.0 * h * h / 4.0 + floats);
    EXPECT_NEAR(radiance[2], 1.5 * std::max(0.0, d.x()), 1.5 * h * h / 4.0 + floats);
  }
  EXPECT_EQ(sky_radiance(*scene.sky, -Eigen::Vector3d::UnitZ()).sum(), 0.0f);
}

TEST_F(RadianceSkies, TheSunIsADiscOfItsSourcesRadiance) {
  const Scene scene = read("void light solar 0 0 3 1e6 2e6 3e6\nsolar source sun 0 0 4 3 0 4 .5");
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  const Sun& sun = *scene.sky->sun;
  EXPECT_LT((sun.direction - Eigen::Vector3d(0.6, 0.0, 0.8)).norm(), 1e-12);
  EXPECT_EQ(sun.angle_degrees, 0.5);
  EXPECT_NEAR(sun.irradiance[1], 2e6 * 2.0 * pi * (1.0 - std::cos(0.25 * pi / 180.0)), 1e-3);
  EXPECT_FALSE(has_dome(*scene.sky));
}

TEST_F(RadianceSkies, FurtherSunsKeepTheirLightInTheSky) {
  const Scene scene = read(
      "void light solar 0 0 3 1e6 1e6 1e6\nsolar source sun 0 0 4 0 0 1 .5\n"
      "void light moon 0 0 3 1e5 1e5 1e5\nmoon source full 0 0 4 1 0 0 .5");
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  EXPECT_EQ(scene.sky->sun->direction, Eigen::Vector3d(0, 0, 1));
  const double across = 1e5 * 2.0 * pi * (1.0 - std::cos(0.25 * pi / 180.0));
  // The light within 2 degrees of the moon, by squares of 0.02 degrees: 1/17 of a pixel, over which
  // the picture is bilinear.
  constexpr double step = 0.02 * pi / 180.0;
  double sum = 0.0;
  for (int i = -100; i < 100; ++i) {
    for (int j = -100; j < 100; ++j) {
      const Eigen::Vector3d d(1.0, (i + 0.5) * step, (j + 0.5) * step);
      sum += step * step * sky_radiance(*scene.sky, d.normalized())[0];
    }
  }
  EXPECT_NEAR(sum, across, 0.01 * across);
}

TEST_F(RadianceSkies, TheNarrowerOfTwoSourcesIsSeen) {
  const Scene scene = read(
      "void glow blue 0 0 4 0 0 1 0\nblue source all 0 0 4 0 0 1 360\n"
      "void glow red 0 0 4 1 0 0 0\nred source spot 0 0 4 0 1 0 60");
  ASSERT_TRUE(scene.sky);
  EXPECT_EQ(sky_radiance(*scene.sky, {0, 1, 0})[0], 1.0f);
  EXPECT_EQ(sky_radiance(*scene.sky, {0, 1, 0})[2], 0.0f);
  EXPECT_EQ(sky_radiance(*scene.sky, {0, -1, 0})[2], 1.0f);
  EXPECT_EQ(sky_radiance(*scene.sky, {0, std::cos(0.55), std::sin(0.55)})[2], 1.0f);
}

TEST_F(RadianceSkies, XformTurnsSkyAndSun) {
  // The turn of an office whose up is y: z becomes y, then y stays and z becomes x.
  const std::string command = "!gensky 7 12 17 +s";
  const Scene plain = read(command + sky_and_ground);
  const Scene turned = read(command + " | xform -rx -90 -ry 90" +
                            "\nskyfunc glow skyglow 0 0 4 .9 .95 1.1 0\n"
                            "skyglow source sky 0 0 4 0 1 0 180\n"
                            "skyfunc glow groundglow 0 0 4 1 .9 .7 0\n"
                            "groundglow source ground 0 0 4 0 -1 0 180\n");
  ASSERT_TRUE(plain.sky && turned.sky && turned.sky->sun);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-0.5 * pi, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  EXPECT_LT((turned.sky->up - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((turned.sky->sun->direction - turn * plain.sky->sun->direction).norm(), 1e-12);
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(0.6, 0.0, 0.8), Eigen::Vector3d(-0.8, 0.36, 0.48),
        Eigen::Vector3d(0.0, 0.96, -0.28)}) {
    const Spectrum a = sky_radiance(*plain.sky, d), b = sky_radiance(*turned.sky, turn * d);
    // The same picture, but for the rounding of its directions and of floats.
    EXPECT_LT((a / b - 1.0f).abs().maxCoeff(), 8 * 0x1p-24) << d.transpose();
  }
}

TEST_F(RadianceSkies, FilesOfTheManualsProgramsMayBePasted) {
  const Scene command = read("!gensky -ang 40 30 -i" + sky_and_ground);
  const Scene pasted = read(
      "void brightfunc skyfunc 2 skybr skybright.cal 0 7 4 1.808e+01 6.922e+00 9.860e-01 -0.383022 "
      "-0.663414 0.642788" +
      sky_and_ground);
  ASSERT_TRUE(command.sky && pasted.sky);
  const Eigen::Vector3d d(0.0, -0.6, 0.8);
  // The numbers above have four digits.
  EXPECT_NEAR(sky_radiance(*command.sky, d)[1] / sky_radiance(*pasted.sky, d)[1], 1.0f, 1e-3f);
}

TEST_F(RadianceSkies, WhatCannotBeUnderstoodIsLeftOutInAWord) {
  const auto loss = [&](const std::string& content, const char* words) {
    const Scene scene = read(content);
    EXPECT_FALSE(scene.sky) << content;
    EXPECT_TRUE(has_loss(scene, words)) << content;
  };
  const std::string glow = "f glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 180";
  const char* sources = "Distant sources whose light is not understood";
  loss("void brightfunc f 2 Px+1 . 0 0\n" + glow, sources);
  loss("void brightfunc f 2 missing missing.cal 0 0\n" + glow, sources);
  loss("void plastic f 0 0 5 1 1 1 0 0\nf source s 0 0 4 0 0 1 180", sources);
  loss("void glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 0 180", "a direction without length");
  loss("void glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 0", "give more than 0");
  loss("!gendaylit -ang -5 0 -W 0 10", "below the horizon");
  loss("!gendaylit -ang 30 0", "lacks the light of the sky");
  loss("!gensky 13 1 12", "give 1 to 12");
  loss("!gensky 2 1 25", "24 hours");
  loss("!gensky 2 1 12:30XYZ", "give its meridian with -m");
  loss("!gensky 2 1 12 -a", "lacks a latitude");
  loss("!gensky 2 1 12 -z", "not known");
  loss("!gensky 2 30 12 -y 2023", "date or place that cannot be");
}

}  // namespace
}  // namespace lightwell::radiance_sky_test
