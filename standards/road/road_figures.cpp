#include "standards/road/road_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "standards/road/road_light.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double eyes_before = 60.0;  // m
constexpr int rows_of_lane = 3;

// All luminaires that the figures of a road need.
RoadLight light_around(const Road& road) {
  const RoadLuminaires& luminaires = road.luminaires;
  const double reach =
      std::max(farthest_glare, heights_beyond_point * luminaires.height) + luminaires.spacing;
  return {road, -reach, luminaires.spacing + reach};
}

// The middles of equal cells of a level rectangle.
LuxGrid even_grid(const Vector3d& corner, const Eigen::Vector2d& size, int columns, int rows) {
  LuxGrid grid{.corner = corner, .columns = columns, .rows = rows, .area = size.prod()};
  grid.step_u = size.x() / columns;
  grid.step_v = size.y() / rows;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      grid.cell.push_back(row * columns + column);
      grid.points.push_back({.position = corner + Vector3d((column + 0.5) * grid.step_u,
                                                           (row + 0.5) * grid.step_v, 0.0),
                             .normal = Vector3d::UnitZ()});
    }
  }
  return grid;
}

Eigen::ArrayXd values_at(const LuxGrid& grid, const std::function<double(const Vector3d&)>& value) {
  Eigen::ArrayXd values(static_cast<Eigen::Index>(grid.points.size()));
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = value(grid.points[i].position);
  }
  return values;
}

// U_l: along the middle row of a lane.
double along_lane(const LuxGrid& grid, const Eigen::ArrayXd& luminance, int lane) {
  const Eigen::Index first = Eigen::Index{rows_of_lane * lane + 1} * grid.columns;
  const auto middle = luminance.segment(first, grid.columns);
  return share(middle.minCoeff(), middle.maxCoeff());
}

/// Luminances that the driver of a lane sees, and the figures made of them.
struct SeenRoad {
  RoadObserver observer{};
  Eigen::ArrayXd luminance{};  ///< maintained
};

void add_glare(const Road& road, const RoadLight& light, const LuxGrid& grid, double way,
               RoadObserver& observer) {
  // The first luminaire ahead appears below the screen of 20 degrees at this distance.
  const double start = 2.75 * (road.luminaires.height - road_eye_height);
  const double first = way > 0.0 ? -start : road.luminaires.spacing + start;
  const double mean = observer.luminance / road.luminaires.maintenance;
  observer.threshold_increment = -1.0;
  for (int i = 0; i < grid.columns; ++i) {
    Vector3d eye = observer.eye;
    eye.x() = first + way * i * grid.step_u;
    const double f_TI = threshold_increment(light.veiling_luminance(eye, way), mean);
    if (f_TI > observer.threshold_increment) {
      observer.threshold_increment = f_TI;
      observer.glare_eye_x = eye.x();
    }
  }
}

SeenRoad seen_road(const Road& road, const RoadLight& light, const LuxGrid& grid, int lane) {
  SeenRoad seen;
  RoadObserver& observer = seen.observer;
  observer.lane = lane + 1;
  observer.is_oncoming = road.is_oncoming(lane);
  const double way = observer.is_oncoming ? -1.0 : 1.0;
  observer.eye = {way > 0.0 ? -eyes_before : road.luminaires.spacing + eyes_before,
                  (lane + 0.5) * road.lane_width(), road_eye_height};
  const double maintenance = road.luminaires.maintenance;
  seen.luminance = maintenance * values_at(grid, [&](const Vector3d& point) {
                     return light.luminance(road.surface, point, observer.eye);
                   });
  observer.luminance = seen.luminance.mean();
  observer.uniformity = share(seen.luminance.minCoeff(), observer.luminance);
  observer.longitudinal_uniformity = along_lane(grid, seen.luminance, lane);
  if (road.wet_surface) {
    const Eigen::ArrayXd wet = values_at(grid, [&](const Vector3d& point) {
      return light.luminance(*road.wet_surface, point, observer.eye);
    });
    observer.wet_uniformity = share(wet.minCoeff(), wet.mean());
  }
  add_glare(road, light, grid, way, observer);
  return seen;
}

void add_observers(const Road& road, const RoadLight& light, RoadFigures& figures) {
  const LuxGrid grid = road_grid(road, 0.0, road.width, rows_of_lane * road.lanes);
  Eigen::ArrayXd worst;
  for (int lane = 0; lane < road.lanes; ++lane) {
    SeenRoad seen = seen_road(road, light, grid, lane);
    if (lane == 0 || seen.observer.luminance < figures.observers[figures.worst].luminance) {
      figures.worst = figures.observers.size();
      worst = std::move(seen.luminance);
    }
    figures.observers.push_back(seen.observer);
  }
  figures.luminance = {"carriageway", grid, field_of(worst)};
}

Eigen::ArrayXd lux_of(const Road& road, const RoadLight& light, const LuxGrid& grid) {
  return road.luminaires.maintenance *
         values_at(grid, [&](const Vector3d& point) { return light.illuminance(point); });
}

RoadField lit_strip(const Road& road, const RoadLight& light, const std::string& name, double right,
                    double width) {
  RoadField strip{name, road_grid(road, right, width, illuminance_rows(width))};
  strip.field = field_of(lux_of(road, light, strip.grid));
  return strip;
}

// True if a strip with a class of its own begins within a lane's width of an edge of the
// carriageway.
bool has_neighbour(const Road& road, bool is_left) {
  return std::ranges::any_of(road.strips, [&](const RoadStrip& strip) {
    return strip.is_left == is_left && !strip.classes.empty() && strip.gap < road.lane_width();
  });
}

void add_edges(const Road& road, const RoadLight& light, RoadFigures& figures) {
  const double wide = road.lane_width();
  for (const bool is_left : {false, true}) {
    const double edge = is_left ? road.width : 0.0;
    const auto mean = [&](double right) {
      return lit_strip(road, light, {}, right, wide).field.mean;
    };
    const double inside = mean(is_left ? edge - wide : edge);
    const double outside = mean(is_left ? edge : edge - wide);
    const bool is_median = road.has_median_at(is_left);
    figures.edges.push_back({.is_left = is_left,
                             .value = share(outside, inside),
                             .is_required = !is_median && !has_neighbour(road, is_left)});
  }
}

const char* side_name(bool is_left) {
  return is_left ? "left edge" : "right edge";
}

std::string lane_name(const RoadObserver& observer) {
  return fmt::format("lane {}{}", observer.lane, observer.is_oncoming ? ", oncoming" : "");
}

// The observer whose figure stands worst to its limit.
void add_worst(Requirement requirement, const std::vector<RoadObserver>& observers,
               const std::function<std::optional<double>(const RoadObserver&)>& figure,
               std::vector<Requirement>& requirements) {
  if (!(requirement.limit > 0.0)) return;
  for (const RoadObserver& observer : observers) {
    const auto value = figure(observer);
    if (!value) return;
    const bool is_worse =
        !requirement.value ||
        (requirement.is_upper ? *value > *requirement.value : *value < *requirement.value);
    if (!is_worse) continue;
    requirement.value = value;
    requirement.place = lane_name(observer);
  }
  requirements.push_back(std::move(requirement));
}

void add_luminance_limits(const RoadClass& limits, const std::string& area,
                          const RoadFigures& figures, std::vector<Requirement>& requirements) {
  const auto& observers = figures.observers;
  using Seen = const RoadObserver&;
  const auto at_least = [&](Figure figure, double limit, auto value) {
    add_worst({.area = area, .figure = figure, .limit = limit}, observers, value, requirements);
  };
  at_least(Figure::luminance, limits.luminance,
           [](Seen seen) { return std::optional(seen.luminance); });
  at_least(Figure::overall_uniformity, limits.uniformity,
           [](Seen seen) { return std::optional(seen.uniformity); });
  at_least(Figure::longitudinal_uniformity, limits.longitudinal_uniformity,
           [](Seen seen) { return std::optional(seen.longitudinal_uniformity); });
  at_least(Figure::wet_uniformity, limits.wet_uniformity,
           [](Seen seen) { return seen.wet_uniformity; });
  add_worst(
      {.area = area,
       .figure = Figure::threshold_increment,
       .is_upper = true,
       .limit = limits.threshold_increment},
      observers, [](Seen seen) { return std::optional(seen.threshold_increment); }, requirements);
  for (const EdgeRatio& edge : figures.edges) {
    if (!edge.is_required) continue;
    requirements.push_back({.area = area,
                            .place = side_name(edge.is_left),
                            .figure = Figure::edge_ratio,
                            .limit = limits.edge_ratio,
                            .value = edge.value});
  }
}

void add_illuminance_limits(const RoadClass& limits, const std::string& area, const LuxField& field,
                            std::vector<Requirement>& requirements) {
  const auto add = [&](Figure figure, bool is_upper, double limit, double value) {
    if (!(limit > 0.0)) return;
    requirements.push_back({.area = area,
                            .place = "ground",
                            .figure = figure,
                            .is_upper = is_upper,
                            .limit = limit,
                            .value = value});
  };
  add(Figure::mean, false, limits.mean, field.mean);
  add(Figure::mean, true, limits.greatest_mean, field.mean);
  add(Figure::least, false, limits.least, field.least);
  add(Figure::uniformity, false, limits.uniformity, field.uniformity);
}

// Least semi-cylindrical or vertical illuminance of a strip for people who walk either way.
void add_upright_limits(const RoadClass& limits, const Road& road, const RoadLight& light,
                        const RoadField& strip, std::vector<Requirement>& requirements) {
  const bool is_round = limits.semicylindrical > 0.0;
  const double limit = is_round ? limits.semicylindrical : limits.vertical;
  if (!(limit > 0.0)) return;
  for (const double way : {1.0, -1.0}) {
    const Vector3d facing(way, 0.0, 0.0);
    const Eigen::ArrayXd lux = values_at(strip.grid, [&](const Vector3d& ground) {
      const Vector3d face = ground + road_eye_height * Vector3d::UnitZ();
      return is_round ? light.semicylindrical(face, facing) : light.vertical(face, facing);
    });
    requirements.push_back(
        {.area = strip.name,
         .place = way > 0.0 ? "facing the traffic's way" : "facing the traffic",
         .figure = is_round ? Figure::least_semicylindrical : Figure::least_vertical,
         .limit = limit,
         .value = road.luminaires.maintenance * lux.minCoeff()});
  }
}

void add_limits(const std::vector<RoadClass>& classes, const Road& road, const RoadLight& light,
                const RoadField& strip, RoadFigures& figures) {
  for (const RoadClass& limits : classes) {
    if (limits.is_of_luminance()) {
      add_luminance_limits(limits, strip.name, figures, figures.requirements);
    } else {
      add_illuminance_limits(limits, strip.name, strip.field, figures.requirements);
      add_upright_limits(limits, road, light, strip, figures.requirements);
    }
  }
}

// Luminaires in one spacing, of which those of a median light both carriageways.
int luminaires_of_field(RoadArrangement arrangement) {
  const bool is_single =
      arrangement == RoadArrangement::single_right || arrangement == RoadArrangement::single_left;
  return is_single ? 1 : 2;
}

void add_power(const Road& road, RoadFigures& figures) {
  const double spacing = road.luminaires.spacing, watts = road.luminaires.watts;
  if (!(watts > 0.0)) return;
  constexpr double km = 1000.0, kilowatt = 1000.0;
  const double power = watts * luminaires_of_field(road.luminaires.arrangement);
  figures.watts_per_km = power * km / spacing;
  double area = 0.0, flux = 0.0;
  // An area without a class is not to be lit. Of two carriageways each has its like, and so has
  // each strip on their outer sides. Strips in the median belong to both.
  const auto add = [&](const RoadField& lit, const std::vector<RoadClass>& classes, int count) {
    if (classes.empty()) return;
    const double here = lit.grid.area * count;
    area += here;
    flux += here * lit.field.mean;
  };
  const int both = road.median > 0.0 ? 2 : 1;
  add(figures.illuminance.front(), road.classes, both);
  for (std::size_t i = 0; i < road.strips.size(); ++i) {
    const RoadStrip& strip = road.strips[i];
    add(figures.illuminance[i + 1], strip.classes, road.has_median_at(strip.is_left) ? 1 : both);
  }
  if (flux > 0.0) figures.power_density = power / flux;
  if (road.hours > 0.0 && area > 0.0) figures.energy = power * road.hours / (kilowatt * area);
}

}  // namespace

RoadField illuminance_map(const Road& road) {
  double low = -road.lane_width(), high = road.width + road.lane_width();
  for (const RoadStrip& strip : road.strips) {
    low = std::min(low, right_edge(road, strip));
    high = std::max(high, right_edge(road, strip) + strip.width);
  }
  const auto count = [](double length) {
    constexpr double apart = 0.5;  // m
    constexpr int most = 400;      // more would not show on paper
    return std::min(most, static_cast<int>(std::ceil(length / apart)));
  };
  const Eigen::Vector2d size(road.luminaires.spacing, high - low);
  RoadField map{"road and strips",
                even_grid({0.0, low, 0.0}, size, count(size.x()), count(size.y()))};
  map.field = field_of(lux_of(road, light_around(road), map.grid));
  return map;
}

LuxGrid road_grid(const Road& road, double right, double width, int rows) {
  constexpr int columns = 10;
  constexpr double long_field = 30.0, farthest_apart = 3.0, rounding = 1e-9;
  const double spacing = road.luminaires.spacing;
  const bool is_long = spacing > long_field;
  return even_grid(
      {0.0, right, 0.0}, {spacing, width},
      is_long ? static_cast<int>(std::ceil(spacing / farthest_apart - rounding)) : columns, rows);
}

int illuminance_rows(double width) {
  constexpr double farthest_apart = 1.5, rounding = 1e-9;
  constexpr int least = 3;
  return std::max(least, static_cast<int>(std::ceil(width / farthest_apart - rounding)));
}

double right_edge(const Road& road, const RoadStrip& strip) {
  return strip.is_left ? road.width + strip.gap : -strip.gap - strip.width;
}

RoadFigures road_figures(const Road& road) {
  const RoadLight light = light_around(road);
  RoadFigures figures;
  add_observers(road, light, figures);
  figures.illuminance.push_back(lit_strip(road, light, "carriageway", 0.0, road.width));
  for (const RoadStrip& strip : road.strips) {
    figures.illuminance.push_back(
        lit_strip(road, light, strip.name, right_edge(road, strip), strip.width));
  }
  add_edges(road, light, figures);
  add_limits(road.classes, road, light, figures.illuminance.front(), figures);
  for (std::size_t i = 0; i < road.strips.size(); ++i) {
    add_limits(road.strips[i].classes, road, light, figures.illuminance[i + 1], figures);
  }
  add_power(road, figures);
  return figures;
}

}  // namespace lightwell
