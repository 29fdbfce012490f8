#pragma once

#include <Eigen/Core>
#include <span>

#include "daylight/window_operation.h"
#include "daylight/year.h"

namespace lightwell {

/// Illuminances whose hours are counted, lx.
struct CountedLux {
  double mean = 0.0;   ///< of the mean of a room's sensors
  double point = 0.0;  ///< of each sensor
};

/// Counts the hours of a year, nights included, in which a room has an illuminance from daylight.
class RoomHours {
 public:
  RoomHours(const SensorRange& room, const CountedLux& lux);

  /// Counts the hours of a block. `factors` as in AnnualMetrics::add().
  void add(const HourBlock& block, std::span<const float> factors = {});
  /// Hours in which the mean of the sensors has its illuminance or more.
  int mean_hours() const { return mean_hours_; }
  /// Hours in which the sensor that has fewest of them has its illuminance or more.
  int point_hours() const { return point_hours_.minCoeff(); }

 private:
  SensorRange room_;
  CountedLux lux_;
  int mean_hours_ = 0;
  Eigen::ArrayXi point_hours_;
};

}  // namespace lightwell
