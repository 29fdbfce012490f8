#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/lamp_use.h"
#include "daylight/operated_year.h"
#include "daylight/room_hours.h"
#include "viewer/report/year_report.h"

namespace lightwell {

/// A count of the year's light, and counts of that much less and more light by its bound.
template <class Count>
struct BoundedCount {
  Count value, less, more;

  explicit BoundedCount(const Count& empty) : value(empty), less(empty), more(empty) {}

  /// Adds a block of hours, with factors of each hour's light.
  void add(const HourBlock& block, std::span<const float> fewer, std::span<const float> further) {
    value.add(block);
    less.add(block, fewer);
    more.add(block, further);
  }
};

/// Measures of sensors with less and with more light, by the bound of its error.
struct MetricBounds {
  SensorMetrics least{}, most{};
};

/// Measures of a year and of its rooms, hour by hour.
class YearCount {
 public:
  /// Counts for `made`, whose rooms, ratings and weather are known, and which is kept.
  YearCount(std::span<const SkyHour> hours, int sensors, YearReport& made);

  /// Adds a block of hours, with the bound of each hour's light.
  void add(const HourBlock& block, const std::vector<double>& errors);
  /// Fills in the measures, and returns the ends of their bounds. `open_sun_hours`, if not null,
  /// are those of windows without blinds, which ASE asks for.
  MetricBounds finish(const Eigen::ArrayXd* open_sun_hours);

 private:
  // Counts of one room.
  struct OfRoom {
    std::vector<BoundedCount<RoomHours>> rated{};  // like YearReport::ratings
    std::optional<BoundedCount<LampUse>> lamps{};
  };

  void finish_room(const OfRoom& counted, YearRoom& room) const;

  YearReport& made_;
  BoundedCount<AnnualMetrics> metrics_;
  std::vector<OfRoom> rooms_{};
};

/// The year with windows that change: its measures, and those of each computation.
class OperatedCount {
 public:
  OperatedCount(std::span<const SkyHour> hours, int sensors, const YearReport& made);

  void add(const ComputedYear& year, const HourBlock& block);
  Eigen::ArrayXd open_sun_hours();
  std::vector<YearInStates> years(const OperatedYear& year, const OperatedWindows& windows);

 private:
  AnnualMetrics& count_of(std::size_t number);

  std::span<const SkyHour> hours_;
  int sensors_;
  const YearReport& made_;
  std::map<std::size_t, AnnualMetrics> counts_{};
};

/// Occupied hours of the year.
int occupied_hours_of(const YearReport& made);

}  // namespace lightwell
