// Clear days of Mitsuba: the emitters `sunsky`, `sky` and `sun`.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "scene/clear_sky.h"
#include "scene/degree.h"
#include "scene/sky.h"
#include "tests/scene/io/mitsuba/mitsuba_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::mitsuba_sunsky_test {
namespace {

using test::has_loss;
using test::has_note;

class MitsubaSunSky : public test::SceneFileTest {
 protected:
  Scene read(const std::string& version, const std::string& emitters) const {
    return read_file("s.xml", "<scene version='" + version + "'><shape type='rectangle'/>" +
                                  emitters + "</scene>");
  }
  // A sunsky of Mitsuba 3 with these properties.
  Scene recent(const std::string& properties) const {
    return read("3.0.0", "<emitter type='sunsky'>" + properties + "</emitter>");
  }
  Scene old(const std::string& properties) const {
    return read("0.6.0", "<emitter type='sunsky'>" + properties + "</emitter>");
  }
};

const std::string up_z = "<vector name='sun_direction' x='1' y='0' z='1'/>";

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / degree;
}

// Directions of the sun as Mitsuba 3.9 has them for its default place and date, to three digits:
// 0.1 degrees.
TEST_F(MitsubaSunSky, SunStandsWhereMitsubaPutsIt) {
  const auto to_sun = [&](const char* hour) {
    return recent(std::string("<float name='hour' value='") + hour + "'/>").sky->sun->direction;
  };
  EXPECT_LT(degrees_between(to_sun("8"), {-0.010, -0.773, 0.634}), 0.1);
  EXPECT_LT(degrees_between(to_sun("12"), {0.232, 0.054, 0.971}), 0.1);
  EXPECT_LT(degrees_between(to_sun("17"), {-0.197, 0.906, 0.373}), 0.1);
  // Mitsuba 0.6: +X is east, -Z north; at eight the sun stands in the east.
  const Eigen::Vector3d morning = old("<float name='hour' value='8'/>").sky->sun->direction;
  EXPECT_LT(degrees_between(morning, {0.773, 0.634, -0.010}), 0.1);
}

TEST_F(MitsubaSunSky, DomeAndSunAreThoseOfTheModel) {
  const Scene scene = recent(up_z +
                             "<float name='turbidity' value='4'/>"
                             "<float name='sky_scale' value='2'/>"
                             "<float name='sun_scale' value='0.5'/>"
                             "<float name='sun_aperture' value='2'/>");
  const ClearDay day{.turbidity = 4.0,
                     .sun_altitude_degrees = 45.0,
                     .albedo = constant_spectrum(scene.bands, 0.3f)};
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  const Spectrum dome = diffuse_horizontal_irradiance(*scene.sky) / clear_sky_irradiance(day);
  const Spectrum sun =
      scene.sky->sun->irradiance / clear_sun_irradiance(ClearSunModel::hosek_wilkie, 4.0, 45.0);
  // The sum over the picture's pixels: see clear_sky_test.cpp.
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(dome[k], 2.0f, 4e-3f);
    EXPECT_NEAR(sun[k], 0.5f, 1e-6f);
  }
  EXPECT_DOUBLE_EQ(scene.sky->sun->angle_degrees, 2.0);
  EXPECT_TRUE(has_loss(scene, "Skies by Hosek & Wilkie became fits"));
  // Below the horizon Mitsuba has no light.
  EXPECT_EQ(sky_radiance(*scene.sky, Eigen::Vector3d(0, 0.8, -0.6))[1], 0.0f);
}

TEST_F(MitsubaSunSky, OldFilesHaveTheSunOfPreetham) {
  const Scene scene =
      old("<vector name='sunDirection' x='0' y='1' z='1'/>"
          "<float name='sunScale' value='3'/><float name='sunRadiusScale' value='2'/>"
          "<float name='skyScale' value='0'/>");
  ASSERT_TRUE(scene.sky && scene.sky->sun);
  const Spectrum sun = clear_sun_irradiance(ClearSunModel::preetham, 3.0, 45.0);
  EXPECT_NEAR(scene.sky->sun->irradiance[1], 3.0f * sun[1], 1e-5f);
  EXPECT_NEAR(scene.sky->sun->angle_degrees, 2.0 * 0.5358, 1e-12);
  EXPECT_FALSE(has_dome(*scene.sky));
}

TEST_F(MitsubaSunSky, SkyAndSunAddUpToSunSky) {
  const std::string direction = "<vector name='sunDirection' x='0' y='1' z='1'/>";
  const Scene apart =
      read("0.6.0", "<emitter type='sun'>" + direction + "</emitter><emitter type='sky'>" +
                        direction + "</emitter>");
  EXPECT_EQ(sky_hash(*apart.sky), sky_hash(*old(direction).sky));
  const Scene twice = read("0.6.0", "<emitter type='sky'/><emitter type='sunsky' id='b'/>");
  EXPECT_TRUE(twice.sky->sun);  // the second emitter's, without its dome
  EXPECT_TRUE(has_note(twice, "one sky"));
}

TEST_F(MitsubaSunSky, TransformationTurnsTheDome) {
  // The zenith goes to +Y; the sun's direction is that of the scene.
  const Scene scene = recent(
      "<vector name='sun_direction' x='1' y='1' z='0'/>"
      "<transform name='to_world'><rotate x='1' angle='-90'/></transform>");
  EXPECT_LT(degrees_between(scene.sky->up, Eigen::Vector3d::UnitY()), 1e-6);
  EXPECT_GT(sky_radiance(*scene.sky, Eigen::Vector3d(0.8, 0.6, 0))[1],
            2.0f * sky_radiance(*scene.sky, Eigen::Vector3d(-0.8, 0.6, 0))[1]);
  EXPECT_EQ(sky_radiance(*scene.sky, Eigen::Vector3d(0.8, -0.6, 0))[1], 0.0f);
}

TEST_F(MitsubaSunSky, WhatIsOutOfRangeLeavesTheSceneWithoutItsSky) {
  const auto refused = [&](const std::string& properties, const char* why) {
    const Scene scene = recent(properties);
    EXPECT_FALSE(scene.sky) << why;
    EXPECT_TRUE(has_loss(scene, why)) << why;
  };
  refused(up_z + "<float name='turbidity' value='12'/>", "turbidity 12; give 1 to 10");
  refused("<vector name='sun_direction' x='1' y='0' z='-0.1'/>", "below the horizon");
  refused("<float name='hour' value='1'/>", "below the horizon");
  refused("<vector name='sun_direction' x='0' y='0' z='0'/>", "without length");
  refused("<integer name='month' value='2'/><integer name='day' value='30'/>", "stands nowhere");
  refused("<float name='year' value='1e30'/>", "year 1e+30");
  refused("<float name='day' value='1.5'/>", "whole number");
  refused("<float name='hour' value='24'/>", "stands nowhere");
  refused(up_z + "<float name='sky_scale' value='-1'/>", "sky_scale -1");
  refused(up_z + "<float name='sun_aperture' value='0'/>", "0 degrees across");
  refused(up_z + "<string name='turbidity' value='3'/>", "is no number");
  refused(up_z + "<transform name='to_world'><scale x='2'/></transform>", "can only be turned");
}

}  // namespace
}  // namespace lightwell::mitsuba_sunsky_test
