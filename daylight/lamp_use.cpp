#include "daylight/lamp_use.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightwell {
namespace {

// Share of the lamps' full output.
double output_share(const RoomLighting& lighting, double lack) {
  switch (lighting.control) {
    case LampControl::on_off:
      return lack > 0.0 ? 1.0 : 0.0;
    case LampControl::stepped:
      return std::ceil(lighting.steps * lack) / lighting.steps;
    case LampControl::dimmed:
      break;
  }
  return lack;
}

}  // namespace

double power_share(const RoomLighting& lighting, double daylight) {
  const double lack = std::clamp(1.0 - daylight / lighting.lux, 0.0, 1.0);
  return lighting.standby + (1.0 - lighting.standby) * output_share(lighting, lack);
}

LampUse::LampUse(const SensorRange& room, const RoomLighting& lighting, const Occupancy& occupancy)
    : room_(room), lighting_(lighting), occupancy_(occupancy) {}

void LampUse::add(const HourBlock& block, std::span<const float> factors) {
  for (std::size_t h = 0; h < block.hours.size(); ++h) {
    if (!occupancy_.holds(block.hours[h].number)) continue;
    const float factor = factors.empty() ? 1.0f : factors[h];
    double sum = 0.0, darkest = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = room_.first; i < room_.first + room_.count; ++i) {
      const double E = block.light(i, static_cast<Eigen::Index>(h), factor);
      sum += power_share(lighting_, E);
      darkest = std::min(darkest, E);
    }
    ++daylight_hours_;
    full_power_hours_ += lighting_.is_one_zone ? power_share(lighting_, darkest)
                                               : sum / static_cast<double>(room_.count);
  }
}

double LampUse::daylight_dependency() const {
  return daylight_hours_ > 0 ? full_power_hours_ / daylight_hours_ : 1.0;
}

}  // namespace lightwell
