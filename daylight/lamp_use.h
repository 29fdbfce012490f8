#pragma once

#include <span>

#include "daylight/annual_metrics.h"
#include "daylight/window_operation.h"
#include "daylight/year.h"
#include "scene/io/room_use.h"

namespace lightwell {

/// Share of their power that lamps take while daylight gives `daylight` lx, [0,1]:
///
///     p = s + (1 - s) f      s: `standby`, f: share of the lamps' full output
///     f = [d > 0], ceil(n d) / n or d      on/off, stepped, dimmed
///     d = max(0, 1 - daylight / E_m)       what daylight lacks of the maintained illuminance E_m
///
/// Lamps give E_m by themselves at full output, so that the power of dimmed ones is taken as a
/// straight line over their output. On/off and stepped lamps change in the hour, without delay.
double power_share(const RoomLighting& lighting, double daylight);

/// Adds up the power of a room's lamps over the occupied hours of a year.
class LampUse {
 public:
  LampUse(const SensorRange& room, const RoomLighting& lighting, const Occupancy& occupancy);

  /// Adds the hours of a block. `factors` as in AnnualMetrics::add().
  void add(const HourBlock& block, std::span<const float> factors = {});
  /// t_D: occupied hours with light outside.
  int daylight_hours() const { return daylight_hours_; }
  /// F_D of EN 15193-1: energy of the lamps in those hours over that at full power; 1 where there
  /// are none.
  double daylight_dependency() const;

 private:
  SensorRange room_;
  RoomLighting lighting_;
  Occupancy occupancy_;
  int daylight_hours_ = 0;
  double full_power_hours_ = 0.0;  // energy over the installed power
};

}  // namespace lightwell
