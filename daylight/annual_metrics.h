#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daylight/year.h"

namespace lightwell {

/// Hours of every day, in standard time, that count as occupied (IES LM-83-12: 8 to 18).
struct Occupancy {
  int from = 8, to = 18;  ///< 0 <= from < to <= 24

  /// True for an hour of the year, counted from 0, that is occupied.
  bool holds(int hour_of_year) const;
};

/// Reads "8-18". Throws InputError for other text, and for hours out of range.
Occupancy read_occupancy(const std::string& text);

/// Measures of a year, one value for each sensor.
struct SensorMetrics {
  // Shares of the occupied hours, %.
  Eigen::ArrayXd autonomy{};             ///< DA300: 300 lx or more (Reinhart & Walkenhorst 2001)
  Eigen::ArrayXd continuous_autonomy{};  ///< cDA300: mean of min(E / 300 lx, 1) (Rogers 2006)
  /// Useful daylight illuminance, %: below 100 lx, from 100 to below 300, 300 to 3000, above 3000
  /// (Mardaljevic, Andersen, Roy & Christoffersen 2012).
  Eigen::ArrayXd below_100{}, from_100_to_300{}, from_300_to_3000{}, above_3000{};
  Eigen::ArrayXd sun_hours{};  ///< occupied hours with 1000 lx or more straight from the sun
  Eigen::ArrayXd mean_lux{};   ///< over all hours of the year, nights included
  // EN 17037:2018, annex A, method 2: over half of the hours of the year, those with most light of
  // the dome.
  Eigen::ArrayXd en_above_100{}, en_above_300{}, en_above_500{}, en_above_750{};  ///< % of them
  Eigen::ArrayXd en_median_lux{};  ///< what half of them reach, to 1.6 %
};

/// Measures of a room, whose sensors have equal weight.
struct RoomMetrics {
  double spatial_autonomy = 0.0;  ///< sDA300/50%: % of sensors with a DA300 of 50 % or more
  double sun_exposure = 0.0;      ///< ASE1000,250h: % of sensors with more than 250 sun hours
  double mean_autonomy = 0.0, mean_continuous_autonomy = 0.0;
  double mean_lux = 0.0;
  double mean_daylight_factor = 0.0, median_daylight_factor = 0.0;  ///< %
  std::string en_level{};  ///< EN 17037: "none", "minimum", "medium" or "high"
};

/// Counts hours of a year at sensors.
class AnnualMetrics {
 public:
  /// `hours` are all hours with light, `year_hours` all hours of the year.
  AnnualMetrics(int sensors, std::span<const SkyHour> hours, int year_hours,
                const Occupancy& occupancy);

  /// Counts the hours of a block. `factors`, if not empty, has one for the light of each hour, to
  /// see what an error of light does to the measures; direct sunlight is taken as it is.
  void add(const HourBlock& block, std::span<const float> factors = {});
  SensorMetrics sensors() const;
  int occupied_hours() const { return occupied_hours_; }

 private:
  static constexpr int bins = 1024;  // of illuminance, for medians
  double median(Eigen::Index sensor) const;

  void add(const HourBlock& block, std::span<const float> factors, Eigen::Index sensor);

  Occupancy occupancy_;
  int year_hours_ = 0, occupied_hours_ = 0, bright_hours_ = 0;
  std::vector<char> is_bright_{};  // per hour of the year
  Eigen::ArrayXXd count_;          // sensors x counters
  Eigen::Array<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> histogram_;
};

/// Measures of the sensors from `first` on, of one room. `daylight_factor` is [0, 1] per sensor.
RoomMetrics room_metrics(const SensorMetrics& sensors, const Eigen::ArrayXf& daylight_factor,
                         Eigen::Index first, Eigen::Index count);

}  // namespace lightwell
