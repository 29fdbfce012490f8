#include "daylight/lamp_use.h"

#include <gtest/gtest.h>

#include <vector>

namespace lightwell::lamp_use_test {
namespace {

// Four hours of a day, of which the last three are occupied from 8 on, and the light of two sensors
// in them, lx:
//
//     hour     7     8     9    10
//     first  900   100   500   800
//     second 900     0   300   500
class FourHours {
 public:
  HourBlock block(float sunlight = 0.0f) const {
    HourBlock light{.hours = hours_};
    light.total.resize(2, 4);
    light.total << 900, 100, 500, 800, 900, 0, 300, 500;
    light.sunlight = Eigen::ArrayXXf::Constant(2, 4, sunlight);
    return light;
  }

 private:
  std::vector<SkyHour> hours_ = {{.number = 7}, {.number = 8}, {.number = 9}, {.number = 10}};
};

double dependency(const RoomLighting& lighting, const HourBlock& light,
                  const std::vector<float>& factors = {}) {
  LampUse use({.first = 0, .count = 2}, lighting, {});
  use.add(light, factors);
  EXPECT_EQ(use.daylight_hours(), 3);
  return use.daylight_dependency();
}

// In units of 2^-53: the mean of six terms rounds by 2, four operations of half a unit each; sums
// of an hour's sensors by half a unit, and of the hours and their quotient by 2.5; the expected
// value by 3, in six additions or fewer and a quotient.
constexpr double rounding = 8.0 / (1LL << 53);

}  // namespace

// The sensors lack 0.8, 0, 0 and 1, 0.4, 0 of 500 lx in the occupied hours.
TEST(LampUse, DimmedLampsGiveWhatDaylightLacks) {
  const FourHours day;
  const RoomLighting dimmed{.lux = 500.0, .control = LampControl::dimmed};
  EXPECT_NEAR(dependency(dimmed, day.block()), (0.8 + 1.0 + 0.4) / 6.0, rounding);
  RoomLighting standby = dimmed;
  standby.standby = 0.1;
  EXPECT_NEAR(dependency(standby, day.block()), 0.1 + 0.9 * 2.2 / 6.0, rounding);
}

// Lacks of 0.8 and 1 take two steps of two, and 0.4 takes one; off and on know the full power
// alone.
TEST(LampUse, StepsAndSwitchesTakeMore) {
  const FourHours day;
  EXPECT_NEAR(dependency({.lux = 500.0, .control = LampControl::stepped, .steps = 2}, day.block()),
              (1.0 + 1.0 + 0.5) / 6.0, rounding);
  EXPECT_NEAR(dependency({.lux = 500.0, .control = LampControl::on_off}, day.block()), 3.0 / 6.0,
              rounding);
}

// The second sensor is the darker one in all hours: 1, 0.4 and 0.
TEST(LampUse, OneZoneFollowsTheDarkestSensor) {
  const FourHours day;
  const RoomLighting zone{.lux = 500.0, .control = LampControl::dimmed, .is_one_zone = true};
  EXPECT_NEAR(dependency(zone, day.block()), 1.4 / 3.0, rounding);
}

// Half of the light but the sun's: 50, 250, 400 and 0, 150, 250 lx. Of light that is all the sun's
// a factor changes nothing.
TEST(LampUse, FactorsScaleAllLightButTheSuns) {
  const FourHours day;
  const RoomLighting dimmed{.lux = 500.0, .control = LampControl::dimmed};
  const std::vector<float> half(4, 0.5f);
  EXPECT_NEAR(dependency(dimmed, day.block(), half), (0.9 + 0.5 + 0.2 + 1.0 + 0.7 + 0.5) / 6.0,
              rounding);
  HourBlock sunny = day.block();
  sunny.sunlight = sunny.total;
  EXPECT_EQ(dependency(dimmed, sunny, half), dependency(dimmed, sunny));
}

// A year without light takes full power.
TEST(LampUse, DependsOnNoDaylightWithoutAny) {
  const LampUse use({.first = 0, .count = 1}, {}, {});
  EXPECT_EQ(use.daylight_hours(), 0);
  EXPECT_EQ(use.daylight_dependency(), 1.0);
}

}  // namespace lightwell::lamp_use_test
