#include "standards/lighting_energy.h"

#include <gtest/gtest.h>

namespace lightwell::lighting_energy_test {
namespace {

/// An office of 30 m^2 with 240 W, 2250 h by day and 250 h by night (the standard's hours of
/// offices), half of the power by day saved, presence in 0.9 of the time, dimmed new lamps at a
/// maintenance factor of 0.8, and 5 W of controls:
///
///     W_L = 240 * 0.9 * 0.9 * (2250 * 0.5 + 250) = 267 300 Wh
///     W_P = 5 * (8760 - 2500) = 31 300 Wh
///     LENI = 298.6 kWh / 30 m^2 = 9.953333 kWh/m^2
///
/// The tolerance is the last digit of that number.
TEST(LightingEnergy, OfAnOfficeIsThatOfTheFormula) {
  EnergyUse use{.watts = 240.0,
                .area = 30.0,
                .daylight_hours = 2250.0,
                .night_hours = 250.0,
                .daylight = 0.5,
                .occupancy = 0.9,
                .constant_illuminance = constant_illuminance_factor(0.8),
                .standby_watts = 5.0};
  EXPECT_NEAR(energy_indicator(use), 9.953333, 1e-6);
  // Batteries that charge at 2 W all year take 17.52 kWh, 0.584 kWh/m^2.
  use.charging_watts = 2.0;
  use.charging_hours = 8760.0;
  EXPECT_NEAR(energy_indicator(use), 9.953333 + 0.584, 1e-6);
}

}  // namespace
}  // namespace lightwell::lighting_energy_test
