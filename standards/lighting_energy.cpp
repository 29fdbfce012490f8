#include "standards/lighting_energy.h"

#include <algorithm>

namespace lightwell {

double energy_indicator(const EnergyUse& use) {
  constexpr double hours_of_a_year = 8760.0, watt_hours_of_kwh = 1000.0;
  const double lit = use.watts * use.constant_illuminance * use.occupancy *
                     (use.daylight_hours * use.daylight + use.night_hours);
  const double rest = std::max(0.0, hours_of_a_year - use.daylight_hours - use.night_hours);
  const double parasitic = use.standby_watts * rest + use.charging_watts * use.charging_hours;
  return (lit + parasitic) / (watt_hours_of_kwh * use.area);
}

double constant_illuminance_factor(double maintenance_factor) {
  return 0.5 * (1.0 + maintenance_factor);
}

}  // namespace lightwell
