#include "viewer/report/year_count.h"

#include <algorithm>

namespace lightwell {
namespace {

// The measures of all rooms.
void set_metrics(const SensorMetrics& sensors, const Eigen::ArrayXf& daylight_factor,
                 RoomMetrics YearRoom::*which, std::vector<YearRoom>& rooms) {
  for (YearRoom& room : rooms) {
    room.*which = room_metrics(sensors, daylight_factor, room.first, room.count);
  }
}

}  // namespace

YearCount::YearCount(std::span<const SkyHour> hours, int sensors, YearReport& made)
    : made_(made),
      metrics_(AnnualMetrics(sensors, hours, static_cast<int>(made.weather.hours.size()),
                             made.occupancy)) {
  for (YearRoom& room : made_.rooms) {
    room.mean_of_hours.assign(made_.weather.hours.size(), 0.0f);
    const SensorRange range{.first = room.first, .count = room.count};
    OfRoom counted;
    for (const DaylightRating& rating : made_.ratings) {
      counted.rated.emplace_back(
          RoomHours(range, {.mean = rating.mean.lux, .point = rating.point.lux}));
    }
    if (room.lighting) counted.lamps.emplace(LampUse(range, *room.lighting, made_.occupancy));
    rooms_.push_back(std::move(counted));
  }
}

void YearCount::add(const HourBlock& block, const std::vector<double>& errors) {
  std::vector<float> less, more;
  for (const double error : errors) {
    less.push_back(static_cast<float>(1.0 - std::min(1.0, error)));
    more.push_back(static_cast<float>(1.0 + error));
  }
  metrics_.add(block, less, more);
  for (OfRoom& counted : rooms_) {
    for (BoundedCount<RoomHours>& rated : counted.rated) rated.add(block, less, more);
    if (counted.lamps) counted.lamps->add(block, less, more);
  }
  for (YearRoom& room : made_.rooms) {
    for (std::size_t h = 0; h < block.hours.size(); ++h) {
      room.mean_of_hours[static_cast<std::size_t>(block.hours[h].number)] =
          block.total.col(static_cast<Eigen::Index>(h)).segment(room.first, room.count).mean();
    }
  }
}

MetricBounds YearCount::finish(const Eigen::ArrayXd* open_sun_hours) {
  const auto with_sun = [&](const AnnualMetrics& metrics) {
    SensorMetrics sensors = metrics.sensors();
    if (open_sun_hours) sensors.sun_hours = *open_sun_hours;
    return sensors;
  };
  made_.sensors = with_sun(metrics_.value);
  MetricBounds bounds{.least = with_sun(metrics_.less), .most = with_sun(metrics_.more)};
  set_metrics(made_.sensors, made_.daylight_factor, &YearRoom::metrics, made_.rooms);
  set_metrics(bounds.least, made_.daylight_factor, &YearRoom::least, made_.rooms);
  set_metrics(bounds.most, made_.daylight_factor, &YearRoom::most, made_.rooms);
  for (std::size_t r = 0; r < rooms_.size(); ++r) finish_room(rooms_[r], made_.rooms[r]);
  return bounds;
}

void YearCount::finish_room(const OfRoom& counted, YearRoom& room) const {
  for (const BoundedCount<RoomHours>& count : counted.rated) {
    const auto bounded = [&](int (RoomHours::*hours)() const) -> BoundedFigure {
      return {.value = static_cast<double>((count.value.*hours)()),
              .least = static_cast<double>((count.less.*hours)()),
              .most = static_cast<double>((count.more.*hours)())};
    };
    room.rated_hours.push_back(
        {.mean = bounded(&RoomHours::mean_hours), .point = bounded(&RoomHours::point_hours)});
  }
  if (!counted.lamps) return;
  const BoundedCount<LampUse>& lamps = *counted.lamps;
  const int daylight_hours = lamps.value.daylight_hours();
  // More light leaves less to the lamps.
  room.lamps = {.daylight_hours = daylight_hours,
                .night_hours = occupied_hours_of(made_) - daylight_hours,
                .daylight_dependency = {.value = lamps.value.daylight_dependency(),
                                        .least = lamps.more.daylight_dependency(),
                                        .most = lamps.less.daylight_dependency()}};
}

int occupied_hours_of(const YearReport& made) {
  return static_cast<int>(made.weather.hours.size()) / hours_a_day *
         (made.occupancy.to - made.occupancy.from);
}

OperatedCount::OperatedCount(std::span<const SkyHour> hours, int sensors, const YearReport& made)
    : hours_(hours), sensors_(sensors), made_(made) {}

void OperatedCount::add(const ComputedYear& year, const HourBlock& block) {
  count_of(year.number).add(block);
}

Eigen::ArrayXd OperatedCount::open_sun_hours() {
  return count_of(0).sensors().sun_hours;
}

std::vector<YearInStates> OperatedCount::years(const OperatedYear& year,
                                               const OperatedWindows& windows) {
  std::vector<YearInStates> all;
  for (std::size_t number = 0; number < year.plan.computations.size(); ++number) {
    YearInStates in_states{.states = states_text(windows, year.plan.computations[number]),
                           .error = year.errors[number]};
    const SensorMetrics sensors = count_of(number).sensors();
    for (const YearRoom& room : made_.rooms) {
      in_states.rooms.push_back(
          room_metrics(sensors, year.daylight_factor, room.first, room.count));
    }
    all.push_back(std::move(in_states));
  }
  return all;
}

// The measures of a computation. A year without light adds no hours to them.
AnnualMetrics& OperatedCount::count_of(std::size_t number) {
  const auto year_hours = static_cast<int>(made_.weather.hours.size());
  return counts_.try_emplace(number, sensors_, hours_, year_hours, made_.occupancy).first->second;
}

}  // namespace lightwell
