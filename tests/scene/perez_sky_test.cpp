#include "scene/perez_sky.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightwell::perez_sky_test {

// Hour 9 of the reference in Oakland: 573 and 81 W/m^2, the sun 18.3068 degrees high on 1 January.
TEST(PerezSky, StateOfAWinterMorning) {
  const SkyState state = within_data(sky_state(573.0, 81.0, 18.3068, 1));
  // gendaymtx has 3.32741 and 0.18048, by Kasten's air mass of 1966 and another series for the
  // sun's distance, which differ by 0.3 % here.
  EXPECT_NEAR(state.clearness, 3.32741, 5e-6);
  EXPECT_NEAR(state.brightness, 0.18048, 4e-3 * 0.18048);
}

TEST(PerezSky, EfficaciesOfTheSameMorning) {
  const SkyState state{.clearness = 3.32741, .brightness = 0.18048};
  const DaylightEfficacy lm = perez_efficacy(state, 18.3068, precipitable_water_cm(11.0));
  // 49643.64 lx of the sun and 12320.08 lx of the dome by an independent program. The brightness is
  // rounded to 5e-6, times slopes of 26.7 and 13 / 0.18 lm/W.
  EXPECT_NEAR(573.0 * lm.direct, 49643.64, 0.2);
  EXPECT_NEAR(81.0 * lm.diffuse, 12320.08, 0.2);
}

TEST(PerezSky, StatesBeyondTheDataAreTakenToItsLimits) {
  const SkyState state = within_data({.clearness = 50.0, .brightness = 2.0});
  EXPECT_EQ(state.clearness, 11.9);
  EXPECT_EQ(state.brightness, 0.6);
  EXPECT_EQ(within_data({.clearness = 0.5, .brightness = 0.0}).clearness, 1.0);
  EXPECT_EQ(within_data({.clearness = 0.5, .brightness = 0.0}).brightness, 0.01);
}

TEST(PerezSky, WaterInTheAirByTheDewPoint) {
  EXPECT_NEAR(precipitable_water_cm(11.0), 2.0, 0.01);  // what gendaymtx has for 11 degrees
  EXPECT_LT(precipitable_water_cm(-20.0), precipitable_water_cm(20.0));
}

}  // namespace lightwell::perez_sky_test
