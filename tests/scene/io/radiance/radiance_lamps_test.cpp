// Lamps of RADIANCE scenes: luminous surfaces whose light depends on direction.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/lamp.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::radiance_lamps_test {
namespace {

using test::has_loss;
using test::has_note;

constexpr double pi = std::numbers::pi;
// Factors of patterns are floats; values here are below 3.
constexpr double rounding = 3.0 * 0x1p-24;

class RadianceLamps : public test::SceneFileTest {
 protected:
  RadianceLamps() {
    // Intensity per area that falls linearly to half at 90 degrees, as ies2rad writes it.
    folder.write("half.dat", "1\n0 90 2\n2 1\n");
    folder.write("lamp.rad",
                 "void brightdata dist 4 flatcorr half.dat source.cal src_theta 0 1 5\n"
                 "dist light shine 0 0 3 1 2 3\n"
                 "shine polygon face 0 0 12 -.1 -.2 0 -.1 .2 0 .1 .2 0 .1 -.2 0\n");
  }
  Scene read(const std::string& content) const {
    return read_file("scene.rad", content +
                                      "\nvoid plastic black 0 0 5 0 0 0 0 0\n"
                                      "black polygon square 0 0 12 0 0 -9 1 0 -9 1 1 -9 0 1 -9\n");
  }
};

double green(const Lamp& lamp, const Eigen::Vector3d& direction) {
  return static_cast<double>(lamp.intensity[1]) * relative_intensity(lamp, direction.normalized());
}

TEST_F(RadianceLamps, BrightdataIsTheDistributionOfALamp) {
  const Scene scene = read("!xform -t 1 2 3 lamp.rad");
  ASSERT_EQ(scene.lamps.size(), 1u);
  EXPECT_EQ(scene.surfaces.size(), 1u);
  EXPECT_TRUE(has_note(scene, "became lamps"));
  const Lamp& lamp = scene.lamps[0];
  EXPECT_LT((lamp.position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_NEAR(lamp.opening.along_c0, 0.4, 1e-12);
  EXPECT_NEAR(lamp.opening.along_c90, 0.2, 1e-12);
  // I = color multiplier table area: the cosine of the area cancels that of flatcorr.
  for (const double degrees : {0.0, 30.0, 77.0}) {
    const double gamma = degrees * pi / 180.0;
    EXPECT_NEAR(green(lamp, {std::sin(gamma), 0.0, -std::cos(gamma)}),
                2.0 * 5.0 * (2.0 - degrees / 90.0) * 0.08, rounding)
        << degrees;
  }
  EXPECT_EQ(green(lamp, {0.1, 0.0, 1.0}), 0.0);
}

// ies2rad scales the colour of a lamp to the luminance of white, so that candela are those of the
// photometric file in any colour.
TEST_F(RadianceLamps, ColoursOfIes2radKeepTheCandela) {
  const Scene scene = read(
      "void brightdata dist 4 flatcorr half.dat source.cal src_theta 0 1 5\n"
      "dist light shine 0 0 3 1.38244 .911576 .34969\n"
      "shine polygon face 0 0 12 -.1 -.2 0 -.1 .2 0 .1 .2 0 .1 -.2 0\n");
  ASSERT_EQ(scene.lamps.size(), 1u);
  const Lamp& lamp = scene.lamps[0];
  const double candela =
      luminous(scene.bands, lamp.intensity) * relative_intensity(lamp, -Eigen::Vector3d::UnitZ());
  // Below the lamp: multiplier table area, 179 lm/W. The luminance of the colour is grey() of
  // rayinit.cal. Floats are the table's factor, the colour, their product, the weight and its
  // product.
  const double of_white = 0.265074126 * 1.38244 + 0.670114631 * 0.911576 + 0.064811243 * 0.34969;
  const double expected = 179.0 * 5.0 * 2.0 * 0.08 * of_white;
  EXPECT_NEAR(candela, expected, 5 * 0x1p-24 * expected);
}

TEST_F(RadianceLamps, EachLampOfATurnedArrayHasItsOwnDistribution) {
  // Without the turn of the pattern, theta would still be measured from -z.
  const Scene scene = read("!xform -rx 90 -t 0 3 0 -a 4 -rz 90 lamp.rad");
  ASSERT_EQ(scene.lamps.size(), 4u);
  for (const Lamp& lamp : scene.lamps) {
    // -z becomes +y, away from the axis of the array.
    const Eigen::Vector3d out = lamp.position.normalized();
    EXPECT_LT((lamp.aim() - out).norm(), 1e-9) << lamp.name;
    EXPECT_NEAR(green(lamp, out), 2.0 * 5.0 * 2.0 * 0.08, rounding) << lamp.name;
  }
  const auto web = [&](std::size_t i) { return std::get<SharedWeb>(scene.lamps[i].shape); };
  EXPECT_EQ(web(0), web(2)) << "lamps of one kind share a table";
}

TEST_F(RadianceLamps, TablesContinueAndFallOffBeyondTheirGrid) {
  // Table over src_theta from 0 to 20, two values: 2 at 0, 1 at 20. One interval further it is
  // linear: 0.5 at 30. At 60 degrees, t = 3: (2 y1 - y0) / (t - 1) = 0.
  folder.write("narrow.dat", "1 0 20 2 2 1");
  folder.write("uneven.dat", "2  0 0 3 90 45 0  0 1 2  1 1  2 2  3 3 ");
  const Scene scene = read(
      "void brightdata n 4 corr narrow.dat source.cal src_theta 0 0\nn light l 0 0 3 1 1 1\n"
      "l sphere a 0 0 4 0 0 0 1\n"
      "void brightdata u 5 corr uneven.dat source.cal src_theta if(Dx,1,0) 0 0\n"
      "u light k 0 0 3 1 1 1\nk sphere b 0 0 4 5 0 0 1\n");
  ASSERT_EQ(scene.lamps.size(), 2u);
  const auto at = [&](std::size_t lamp, double degrees) {
    const double gamma = degrees * pi / 180.0;
    return green(scene.lamps[lamp], {std::sin(gamma), 0.0, -std::cos(gamma)}) / pi;
  };
  EXPECT_NEAR(at(0, 10.0), 1.5, rounding);
  EXPECT_NEAR(at(0, 30.0), 0.5, rounding);
  EXPECT_NEAR(at(0, 60.0), 0.0, rounding);
  // Points that fall: 1 at 90 degrees, 2 at 45, 3 at 0.
  EXPECT_NEAR(at(1, 90.0), 1.0, rounding);
  EXPECT_NEAR(at(1, 22.0), 3.0 - 22.0 / 45.0, rounding);
}

TEST_F(RadianceLamps, ShapesThatLookAlikeFromAllSidesKeepTheirPower) {
  // Patterns of 1 by direction: power is pi L A for a plane, a sphere and a cylinder.
  const std::string light =
      "void brightfunc one 2 if(Dx,1,1) . 0 0\none light l 0 0 3 10 10 10\nl ";
  const auto power = [&](const std::string& shape) {
    const Scene scene = read(light + shape);
    EXPECT_EQ(scene.lamps.size(), 1u) << shape;
    return static_cast<double>(lamp_flux(scene.lamps.at(0))[1]) / (10.0 * pi);
  };
  // Intensities are linear between steps of a degree: chords of a cosine lie 2.5e-5 below it.
  constexpr double chords = 1e-4;
  EXPECT_NEAR(power("ring r 0 0 8 0 0 0 0 0 1 .2 .5"), pi * 0.21, chords * pi * 0.21);
  EXPECT_NEAR(power("sphere s 0 0 4 0 0 0 .5"), pi, chords * pi);
  EXPECT_NEAR(power("cylinder c 0 0 7 0 0 0 0 0 2 .1"), 0.4 * pi, chords * 0.4 * pi);
  EXPECT_NEAR(power("polygon p 0 0 9 0 0 0 1 0 0 0 1 0"), 0.5, chords * 0.5);
}

TEST_F(RadianceLamps, ASpotlightShinesWithinItsBeam) {
  const Scene scene = read(
      "void spotlight beam 0 0 7 100 80 60 40 0 0 -2\nbeam ring disc 0 0 8 0 0 0 0 0 -1 0 .1\n");
  ASSERT_EQ(scene.lamps.size(), 1u);
  const Lamp& lamp = scene.lamps[0];
  const double area = pi * 0.01;
  const auto towards = [](double degrees) {
    const double gamma = degrees * pi / 180.0;
    return Eigen::Vector3d(0.0, std::sin(gamma), -std::cos(gamma));
  };
  EXPECT_NEAR(green(lamp, towards(0.0)), 80.0 * area, rounding);
  EXPECT_NEAR(green(lamp, towards(19.0)), 80.0 * area * std::cos(19.0 * pi / 180.0), rounding);
  EXPECT_EQ(green(lamp, towards(20.1)), 0.0);
  EXPECT_TRUE(has_loss(scene, "not from the focus f behind it"));
  const Scene turned =
      read("void spotlight beam 0 0 7 1 1 1 40 0 0 -2\nbeam sphere s 0 0 4 0 0 0 1\n");
  EXPECT_NEAR(turned.lamps.at(0).aim().z(), -1.0, 1e-12);
}

TEST_F(RadianceLamps, AnIllumIsALampUntilThereIsASky) {
  const std::string window =
      "void brightfunc up 2 Dz+2 . 0 0\nvoid glass pane 0 0 3 .9 .9 .9\n"
      "up illum bright 1 pane 0 3 1 1 1\nbright polygon w 0 0 12 0 0 0 1 0 0 1 0 1 0 0 1\n";
  const Scene alone = read(window);
  ASSERT_EQ(alone.lamps.size(), 1u);
  ASSERT_EQ(alone.surfaces.size(), 2u);
  EXPECT_TRUE(alone.materials[static_cast<std::size_t>(alone.surfaces[0].material)].dielectric);
  // From the front (-y) light comes down at 45 degrees from the window: the ray up to it has
  // Dz = sqrt(1/2).
  EXPECT_NEAR(green(alone.lamps[0], {0, -1, -1}), std::sqrt(0.5) * (2.0 + std::sqrt(0.5)),
              rounding);
  const Scene with_sky = read(window + "void glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 180\n");
  EXPECT_TRUE(with_sky.lamps.empty());
  EXPECT_EQ(with_sky.surfaces.size(), 2u);
  const Scene even = read(
      "void glass pane 0 0 3 .9 .9 .9\nvoid illum bright 1 pane 0 3 1 1 1\n"
      "bright polygon w 0 0 12 0 0 0 1 0 0 1 0 1 0 0 1\n"
      "void glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 180\n");
  EXPECT_TRUE(even.materials[static_cast<std::size_t>(even.surfaces[0].material)].dielectric);
}

TEST_F(RadianceLamps, DamagedTablesAreNamed) {
  const auto lost = [&](const std::string& table) {
    folder.write("half.dat", table);
    const Scene scene = read("!cat lamp.rad");
    return scene.lamps.empty() && has_loss(scene, "shine as without it");
  };
  EXPECT_TRUE(lost(""));
  EXPECT_TRUE(lost("1 0 90 2 1"));
  EXPECT_TRUE(lost("1 0 90 1 1"));
  EXPECT_TRUE(lost("1 0 90 2000000000 1"));
  EXPECT_TRUE(lost("99 0 90 2 1 1"));
  EXPECT_TRUE(lost("1 0 0 3 0 2 1 1 1 1"));
  EXPECT_TRUE(lost("1 0 90 2 x 1"));
}

}  // namespace
}  // namespace lightwell::radiance_lamps_test
