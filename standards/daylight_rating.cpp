#include "standards/daylight_rating.h"

#include <algorithm>

namespace lightwell {
namespace {

// One of the values of a BoundedFigure. All limits that bear on points are lower ones, so that the
// least values of all figures give the fewest points.
using End = double BoundedFigure::*;
constexpr End ends[] = {&BoundedFigure::value, &BoundedFigure::least, &BoundedFigure::most};

// True if a figure is at least a limit, but for the rounding of sums of areas.
bool reaches(double value, double limit) {
  constexpr double rounding = 1e-12;
  return value >= limit * (1.0 - rounding);
}

template <class Value>
BoundedFigure at_ends(Value value) {
  BoundedFigure figure;
  for (const End end : ends) figure.*end = static_cast<double>(value(end));
  return figure;
}

bool has_factors(const DaylightRating& rating, const DaylitRoom& room, End end) {
  const bool is_even = reaches(room.uniformity.*end, rating.uniformity) ||
                       reaches(room.least_factor.*end, rating.uniformity * rating.daylight_factor);
  return rating.daylight_factor > 0.0 && is_even &&
         reaches(room.mean_factor.*end, rating.daylight_factor);
}

bool has_hours(const DaylightRating& rating, const DaylitRoom& room, End end) {
  return rating.has_hours() && reaches(room.mean_hours.*end, rating.mean.hours) &&
         reaches(room.point_hours.*end, rating.point.hours);
}

// Mean of a figure over the area of all rooms.
template <class Value>
double area_mean(std::span<const DaylitRoom> rooms, Value value) {
  double sum = 0.0, area = 0.0;
  for (const DaylitRoom& room : rooms) {
    sum += room.area * static_cast<double>(value(room));
    area += room.area;
  }
  return share(sum, area);
}

double mean_autonomy(std::span<const DaylitRoom> rooms, End end) {
  return area_mean(rooms, [&](const DaylitRoom& room) { return room.autonomy.*end; });
}

double complying_area(const DaylightRating& rating, std::span<const DaylitRoom> rooms, End end) {
  return area_mean(rooms, [&](const DaylitRoom& room) {
    return has_factors(rating, room, end) || has_hours(rating, room, end) ? 100.0 : 0.0;
  });
}

int most_points(const std::vector<RatingStep>& steps) {
  int most = 0;
  for (const RatingStep& step : steps) most = std::max(most, step.points);
  return most;
}

int points_of(const std::vector<RatingStep>& steps, double value) {
  int points = 0;
  for (const RatingStep& step : steps) {
    if (reaches(value, step.at_least)) points = std::max(points, step.points);
  }
  return points;
}

int points_at(const DaylightRating& rating, std::span<const DaylitRoom> rooms, End end) {
  if (rating.autonomy.empty()) {
    return points_of(rating.area, complying_area(rating, rooms, end));
  }
  const int points = points_of(rating.autonomy, mean_autonomy(rooms, end));
  const auto& each = rating.autonomy_of_each;
  if (points == 0 || !each || !std::ranges::all_of(rooms, [&](const DaylitRoom& room) {
        return reaches(room.autonomy.*end, each->at_least);
      })) {
    return points;
  }
  return std::min(points + each->points, most_points(rating.autonomy));
}

// Adds the figures of a room that the rating limits.
void add_room(const DaylightRating& rating, const DaylitRoom& room,
              std::vector<RatedFigure>& figures) {
  const auto add = [&](DaylightFigure figure, double limit, const BoundedFigure& value) {
    figures.push_back({.room = room.name, .figure = figure, .limit = limit, .value = value});
  };
  if (const auto& each = rating.autonomy_of_each) {
    add(DaylightFigure::spatial_autonomy, each->at_least, room.autonomy);
    figures.back().points = each->points;
  }
  if (rating.sun_exposure > 0.0) {
    add(DaylightFigure::sun_exposure, rating.sun_exposure, room.sun_exposure);
    figures.back().is_upper = figures.back().is_recommended = true;
  }
  if (rating.daylight_factor > 0.0) {
    add(DaylightFigure::mean_factor, rating.daylight_factor, room.mean_factor);
    if (rating.uniformity > 0.0) {
      add(DaylightFigure::factor_uniformity, rating.uniformity, room.uniformity);
      add(DaylightFigure::least_factor, rating.uniformity * rating.daylight_factor,
          room.least_factor);
    }
    add(DaylightFigure::factor_route, 1.0,
        at_ends([&](End end) { return has_factors(rating, room, end); }));
  }
  if (rating.mean.hours > 0.0) {
    add(DaylightFigure::mean_hours, rating.mean.hours, room.mean_hours);
  }
  if (rating.point.hours > 0.0) {
    add(DaylightFigure::point_hours, rating.point.hours, room.point_hours);
  }
  if (rating.has_hours()) {
    add(DaylightFigure::hours_route, 1.0,
        at_ends([&](End end) { return has_hours(rating, room, end); }));
  }
}

void add_steps(const std::vector<RatingStep>& steps, DaylightFigure figure,
               const BoundedFigure& value, std::vector<RatedFigure>& figures) {
  for (const RatingStep& step : steps) {
    figures.push_back(
        {.figure = figure, .limit = step.at_least, .points = step.points, .value = value});
  }
}

}  // namespace

Verdict verdict_of(const RatedFigure& figure) {
  const auto is_met = [&](double value) {
    return figure.is_upper ? reaches(figure.limit, value) : reaches(value, figure.limit);
  };
  const bool least = is_met(figure.value.least), most = is_met(figure.value.most);
  if (least != most) return Verdict::too_close;
  return least ? Verdict::met : Verdict::missed;
}

RatedDaylight rate_daylight(const DaylightRating& rating, std::span<const DaylitRoom> rooms) {
  RatedDaylight rated;
  for (const DaylitRoom& room : rooms) add_room(rating, room, rated.figures);
  add_steps(rating.autonomy, DaylightFigure::spatial_autonomy,
            at_ends([&](End end) { return mean_autonomy(rooms, end); }), rated.figures);
  add_steps(rating.area, DaylightFigure::complying_area,
            at_ends([&](End end) { return complying_area(rating, rooms, end); }), rated.figures);
  rated.points = {
      .value = points_at(rating, rooms, &BoundedFigure::value),
      .least = points_at(rating, rooms, &BoundedFigure::least),
      .most = points_at(rating, rooms, &BoundedFigure::most),
      .available = most_points(rating.autonomy.empty() ? rating.area : rating.autonomy)};
  return rated;
}

}  // namespace lightwell
