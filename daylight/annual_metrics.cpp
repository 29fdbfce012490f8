#include "daylight/annual_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/errors.h"
#include "scene/io/dashed_pair.h"
#include "scene/io/weather/weather_file.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Columns of the counters.
enum Counter {
  reached,     // 300 lx
  continuous,  // sum of min(E / 300, 1)
  below_100,
  from_100,
  from_300,
  above_3000,
  sun,
  lux,  // sum
  en_100,
  en_300,
  en_500,
  en_750,
  counter_count
};

// Illuminances of the histogram's first and last bin, lx.
constexpr float least_lux = 0.1f, most_lux = 1e6f;

double bin_edge(int bin, int bins) {
  return least_lux * std::pow(double{most_lux / least_lux}, static_cast<double>(bin) / bins);
}

// Adds 1 to each counter whose condition an illuminance meets.
void count_occupied(float E, float sunlight, Eigen::ArrayXXd& count, Eigen::Index i) {
  constexpr float target = 300.0f, useful = 100.0f, too_much = 3000.0f, direct = 1000.0f;
  count(i, reached) += E >= target;
  count(i, continuous) += double{std::min(E / target, 1.0f)};
  count(i, below_100) += E < useful;
  count(i, from_100) += E >= useful && E < target;
  count(i, from_300) += E >= target && E <= too_much;
  count(i, above_3000) += E > too_much;
  count(i, sun) += sunlight >= direct;
}

// A room's part of the sensors.
struct RoomSensors {
  Eigen::Index first = 0, count = 0;

  auto of(const Eigen::ArrayXd& values) const { return values.segment(first, count); }
  double mean(const Eigen::ArrayXd& values) const { return of(values).mean(); }
  // Share of the sensors, %, whose value is at least `least`.
  double share(const Eigen::ArrayXd& values, double least) const {
    return 100.0 * static_cast<double>((of(values) >= least).count()) / static_cast<double>(count);
  }
};

std::string level_of(const SensorMetrics& sensors, const RoomSensors& room) {
  // EN 17037, table A.1: target on half of the area, minimum on 95 % of it, for half of the hours.
  constexpr double half_of_area = 50.0, most_of_area = 95.0, half_of_hours = 50.0;
  const auto meets = [&](const Eigen::ArrayXd& target, const Eigen::ArrayXd& minimum) {
    return room.share(target, half_of_hours) >= half_of_area &&
           room.share(minimum, half_of_hours) >= most_of_area;
  };
  if (meets(sensors.en_above_750, sensors.en_above_500)) return "high";
  if (meets(sensors.en_above_500, sensors.en_above_300)) return "medium";
  return meets(sensors.en_above_300, sensors.en_above_100) ? "minimum" : "none";
}

double median_of(std::vector<float> values) {
  std::ranges::sort(values);
  const auto n = values.size();
  return n == 0 ? 0.0 : 0.5 * (double{values[(n - 1) / 2]} + double{values[n / 2]});
}

}  // namespace

AnnualMetrics::AnnualMetrics(int sensors, std::span<const SkyHour> hours, int year_hours,
                             const Occupancy& occupancy)
    : occupancy_(occupancy),
      year_hours_(year_hours),
      occupied_hours_(year_hours / hours_a_day * (occupancy.to - occupancy.from)),
      bright_hours_(year_hours / 2),
      is_bright_(static_cast<std::size_t>(year_hours), 0),
      count_(Eigen::ArrayXXd::Zero(sensors, counter_count)) {
  histogram_.setZero(sensors, bins);
  std::vector<int> by_light(hours.size());
  for (std::size_t i = 0; i < hours.size(); ++i) by_light[i] = static_cast<int>(i);
  std::ranges::stable_sort(by_light, std::greater{},
                           [&](int i) { return hours[static_cast<std::size_t>(i)].dome_lux; });
  const auto count = std::min(hours.size(), static_cast<std::size_t>(bright_hours_));
  for (std::size_t i = 0; i < count; ++i) {
    is_bright_[static_cast<std::size_t>(hours[static_cast<std::size_t>(by_light[i])].number)] = 1;
  }
}

Occupancy read_occupancy(const std::string& text) {
  const auto hours = dashed_pair(text);
  if (!hours || hours->first < 0 || hours->first >= hours->second || hours->second > hours_a_day) {
    throw InputError(
        fmt::format("'{}' is no span of hours; write two from 0 to 24, such as 8-18", text));
  }
  return {.from = hours->first, .to = hours->second};
}

bool Occupancy::holds(int hour_of_year) const {
  const int hour = hour_of_year % hours_a_day;
  return hour >= from && hour < to;
}

void AnnualMetrics::add(const HourBlock& block, std::span<const float> factors) {
  constexpr int grain = 16;
  parallel_for(static_cast<int>(count_.rows()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) add(block, factors, i);
  });
}

void AnnualMetrics::add(const HourBlock& block, std::span<const float> factors, Eigen::Index i) {
  const float bins_of_logarithm = static_cast<float>(bins) / std::log(most_lux / least_lux);
  for (std::size_t h = 0; h < block.hours.size(); ++h) {
    const int number = block.hours[h].number;
    const auto column = static_cast<Eigen::Index>(h);
    const float sunlight = block.sunlight(i, column);
    const float factor = factors.empty() ? 1.0f : factors[h];
    const float E = block.light(i, column, factor);
    count_(i, lux) += double{E};
    if (occupancy_.holds(number)) count_occupied(E, sunlight, count_, i);
    if (is_bright_[static_cast<std::size_t>(number)] == 0) continue;
    count_(i, en_100) += E >= 100.0f;
    count_(i, en_300) += E >= 300.0f;
    count_(i, en_500) += E >= 500.0f;
    count_(i, en_750) += E >= 750.0f;
    const float place = std::log(std::max(E, least_lux) / least_lux) * bins_of_logarithm;
    ++histogram_(i, std::min(static_cast<int>(place), bins - 1));
  }
}

// The illuminance that half of the bright hours reach; hours without light are below all bins.
double AnnualMetrics::median(Eigen::Index sensor) const {
  double above = 0.0;
  const double wanted = 0.5 * bright_hours_;
  for (int bin = bins - 1; bin > 0; --bin) {
    const double here = histogram_(sensor, bin);
    if (above + here >= wanted) {
      const double share = (above + here - wanted) / here;
      return bin_edge(bin, bins) * std::pow(bin_edge(1, bins) / bin_edge(0, bins), share);
    }
    above += here;
  }
  return 0.0;
}

SensorMetrics AnnualMetrics::sensors() const {
  const auto share = [&](Counter counter, int hours) -> Eigen::ArrayXd {
    return count_.col(counter) * (100.0 / hours);
  };
  SensorMetrics metrics;
  metrics.autonomy = share(reached, occupied_hours_);
  metrics.continuous_autonomy = share(continuous, occupied_hours_);
  metrics.from_100_to_300 = share(from_100, occupied_hours_);
  metrics.from_300_to_3000 = share(from_300, occupied_hours_);
  metrics.above_3000 = share(above_3000, occupied_hours_);
  // Hours without light are no hours of `hours`, and are below 100 lx.
  metrics.below_100 =
      100.0 - metrics.from_100_to_300 - metrics.from_300_to_3000 - metrics.above_3000;
  metrics.sun_hours = count_.col(sun);
  metrics.mean_lux = count_.col(lux) / year_hours_;
  metrics.en_above_100 = share(en_100, bright_hours_);
  metrics.en_above_300 = share(en_300, bright_hours_);
  metrics.en_above_500 = share(en_500, bright_hours_);
  metrics.en_above_750 = share(en_750, bright_hours_);
  metrics.en_median_lux.resize(count_.rows());
  for (Eigen::Index i = 0; i < count_.rows(); ++i) metrics.en_median_lux[i] = median(i);
  return metrics;
}

RoomMetrics room_metrics(const SensorMetrics& sensors, const Eigen::ArrayXf& daylight_factor,
                         Eigen::Index first, Eigen::Index count) {
  constexpr double half_of_hours = 50.0, sunny = 250.0;
  const RoomSensors room{first, count};
  const auto factor = daylight_factor.segment(first, count);
  // More than 250 hours, whose number is whole.
  return {.spatial_autonomy = room.share(sensors.autonomy, half_of_hours),
          .sun_exposure = room.share(sensors.sun_hours, sunny + 1.0),
          .mean_autonomy = room.mean(sensors.autonomy),
          .mean_continuous_autonomy = room.mean(sensors.continuous_autonomy),
          .mean_lux = room.mean(sensors.mean_lux),
          .mean_daylight_factor = 100.0 * double{factor.mean()},
          .median_daylight_factor = 100.0 * median_of({factor.begin(), factor.end()}),
          .en_level = level_of(sensors, room)};
}

}  // namespace lightwell
