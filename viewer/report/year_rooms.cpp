#include "viewer/report/year_rooms.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/errors.h"
#include "scene/io/matches_glob.h"
#include "scene/io/nearest_name.h"
#include "standards/lighting_energy.h"

namespace lightwell {
namespace {

void use_room(const RoomUse& use, YearRoom& room) {
  room.is_regularly_occupied = use.is_regularly_occupied;
  room.lighting = use.lighting;
  if (use.area) room.area = *use.area;
  if (room.lighting && room.lighting->watts && !(room.area > 0.0)) {
    throw InputError(fmt::format(
        "{}: the sensors '{}' have a power in watts and no area to relate its energy to; add "
        "'area', in square metres",
        use.place, room.name));
  }
}

// Daylight factors of a room, %, with the bound of the year's light with all windows in their first
// states.
void set_factors(const YearReport& report, const YearRoom& room, DaylitRoom& rated) {
  const double error = report.states.empty() ? report.error : report.states.front().error;
  const Eigen::ArrayXd all = 100.0 * report.daylight_factor.cast<double>();
  const auto factors = all.segment(room.first, room.count);
  const double mean = room.metrics.mean_daylight_factor, least = factors.minCoeff();
  // Relative to a quarter of the mean of all sensors at least, see year_error().
  const double mean_within = error * mean;
  const double least_within = error * std::max(least, 0.25 * all.mean());
  const auto bounded = [](double value, double within) -> BoundedFigure {
    return {.value = value, .least = std::max(0.0, value - within), .most = value + within};
  };
  rated.mean_factor = bounded(mean, mean_within);
  rated.least_factor = bounded(least, least_within);
  rated.uniformity = {.value = share(least, mean),
                      .least = share(rated.least_factor.least, rated.mean_factor.most),
                      .most = rated.mean_factor.least > 0.0
                                  ? std::min(1.0, rated.least_factor.most / rated.mean_factor.least)
                                  : 1.0};
}

DaylitRoom rated_room(const YearReport& report, const YearRoom& room, std::size_t rating) {
  DaylitRoom rated{.name = room.name,
                   .area = has_areas(report) ? room.area : static_cast<double>(room.count)};
  rated.autonomy = {.value = room.metrics.spatial_autonomy,
                    .least = room.least.spatial_autonomy,
                    .most = room.most.spatial_autonomy};
  const double exposure = room.metrics.sun_exposure;
  rated.sun_exposure = {.value = exposure, .least = exposure, .most = exposure};
  rated.mean_hours = room.rated_hours[rating].mean;
  rated.point_hours = room.rated_hours[rating].point;
  set_factors(report, room, rated);
  return rated;
}

}  // namespace

void use_rooms(std::span<const RoomUse> uses, std::vector<YearRoom>& rooms) {
  std::vector<char> is_used(uses.size(), 0);
  std::vector<std::string> names;
  for (YearRoom& room : rooms) {
    names.push_back(room.name);
    if (room.grid) room.area = room.grid->area;
    const auto use = std::ranges::find_if(
        uses, [&](const RoomUse& one) { return matches_glob(one.sensors, room.name); });
    if (use == uses.end()) continue;
    is_used[static_cast<std::size_t>(use - uses.begin())] = 1;
    use_room(*use, room);
  }
  for (std::size_t u = 0; u < uses.size(); ++u) {
    if (is_used[u] != 0) continue;
    throw InputError(fmt::format(
        "{}: no sensors are left for '{}'.{} The sensors are '{}', and each has the first table "
        "that fits its name",
        uses[u].place, uses[u].sensors, did_you_mean(uses[u].sensors, names),
        fmt::join(names, "', '")));
  }
}

void require_occupied_rooms(std::span<const YearRoom> rooms) {
  if (std::ranges::any_of(rooms, &YearRoom::is_regularly_occupied)) return;
  throw InputError(
      "no room is regularly occupied, so that nothing can be rated; leave a room without "
      "'regularly_occupied = false', or leave '--rating' out");
}

bool has_areas(const YearReport& report) {
  return std::ranges::all_of(report.rooms, [](const YearRoom& room) {
    return !room.is_regularly_occupied || room.area > 0.0;
  });
}

std::vector<RatedYear> rate_year(const YearReport& report) {
  std::vector<RatedYear> rated;
  for (std::size_t r = 0; r < report.ratings.size(); ++r) {
    std::vector<DaylitRoom> rooms;
    for (const YearRoom& room : report.rooms) {
      if (room.is_regularly_occupied) rooms.push_back(rated_room(report, room, r));
    }
    const DaylightRating& rating = report.ratings[r];
    rated.push_back({.rating = rating, .daylight = rate_daylight(rating, rooms)});
  }
  return rated;
}

LampEnergy lamp_energy(const YearRoom& room) {
  const LampHours& hours = room.lamps;
  // Without a power there is no energy, and the area does not matter.
  EnergyUse use{.watts = room.lighting->watts.value_or(0.0),
                .area = room.area > 0.0 ? room.area : 1.0,
                .daylight_hours = static_cast<double>(hours.daylight_hours),
                .night_hours = static_cast<double>(hours.night_hours)};
  const double full = energy_indicator(use);
  const auto energy = [&](double dependency) {
    use.daylight = dependency;
    return energy_indicator(use);
  };
  const double all_hours = use.daylight_hours + use.night_hours;
  const auto saved_share = [&](double dependency) {
    return share(use.daylight_hours * (1.0 - dependency), all_hours);
  };
  const BoundedFigure& F_D = hours.daylight_dependency;
  LampEnergy of;
  of.indicator = {.value = energy(F_D.value), .least = energy(F_D.least), .most = energy(F_D.most)};
  // The more the lamps take, the less is saved.
  of.saved = {.value = full - of.indicator.value,
              .least = full - of.indicator.most,
              .most = full - of.indicator.least};
  of.saved_share = {.value = saved_share(F_D.value),
                    .least = saved_share(F_D.most),
                    .most = saved_share(F_D.least)};
  return of;
}

std::string control_text(const RoomLighting& lighting) {
  std::string text = "on/off";
  if (lighting.control == LampControl::stepped) text = fmt::format("{} steps", lighting.steps);
  if (lighting.control == LampControl::dimmed) text = "dimmed";
  if (lighting.standby > 0.0) {
    text += fmt::format(", standby {:g} %", 100.0 * lighting.standby);
  }
  return text + (lighting.is_one_zone ? ", by the darkest sensor" : ", each sensor by itself");
}

}  // namespace lightwell
