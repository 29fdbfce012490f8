#include "standards/sports.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "standards/table_key.h"

namespace lightwell {
namespace {

// The odd number nearest to `count`, at least 1.
int nearest_odd(double count) {
  return std::max(1, 2 * static_cast<int>(std::floor(0.5 * count)) + 1);
}

void add_camera_limits(const CameraField& camera, const TelevisionLimits& limits,
                       const std::string& area, std::vector<Requirement>& requirements) {
  const LuxField& field = *camera.field.field;
  const auto add = [&](Figure figure, double limit, double value, double within) {
    if (!(limit > 0.0)) return;
    requirements.push_back({.area = area,
                            .place = camera.field.name,
                            .figure = figure,
                            .is_upper = figure == Figure::gradient,
                            .limit = limit,
                            .value = value,
                            .within = within});
  };
  add(Figure::vertical_mean, limits.mean, field.mean, field.mean_within * field.mean);
  add(Figure::vertical_uniformity, limits.uniformity, field.uniformity,
      uniformity_at_least(limits.uniformity, camera.field).within);
  const double contrast = share(field.least, field.greatest);
  add(Figure::vertical_contrast, limits.contrast, contrast,
      share(known_bound(field, field.least), field.greatest) +
          contrast * share(known_bound(field, field.greatest), field.greatest));
  const Gradient gradient = greatest_gradient(*camera.grid, field);
  add(Figure::gradient, limits.gradient, gradient.percent, gradient.within);
}

}  // namespace

const SportLimits& sport_limits(const std::vector<Sport>& sports, const std::string& key,
                                int sport_class, const std::string& asked_by) {
  const Sport& sport =
      find_entry(sports, {.key = key, .asked_by = asked_by, .noun = "sport", .option = "--sports"});
  return sport.classes[static_cast<std::size_t>(sport_class - 1)];
}

LuxGrid sport_grid(const LuxGrid& area) {
  const double u = area.columns * area.step_u, v = area.rows * area.step_v;
  const double longer = std::max(u, v), shorter = std::min(u, v);
  const int along = nearest_odd(longer / greatest_grid_spacing(longer));
  const int across = nearest_odd(shorter * along / longer);
  LuxGrid grid = area;
  grid.columns = u >= v ? along : across;
  grid.rows = u >= v ? across : along;
  grid.step_u = u / grid.columns;
  grid.step_v = v / grid.rows;
  grid.cell.clear();
  grid.points.clear();
  const Eigen::Vector3d lift = area.points.front().position - area.corner -
                               area.u * area.u.dot(area.points.front().position - area.corner) -
                               area.v * area.v.dot(area.points.front().position - area.corner);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x = (column + 0.5) * grid.step_u, y = (row + 0.5) * grid.step_v;
      const int old =
          static_cast<int>(y / area.step_v) * area.columns + static_cast<int>(x / area.step_u);
      if (!std::ranges::binary_search(area.cell, old)) continue;
      grid.cell.push_back(row * grid.columns + column);
      grid.points.push_back({.position = area.corner + lift + x * area.u + y * area.v,
                             .normal = area.points.front().normal});
    }
  }
  return grid.points.empty() ? area : grid;
}

Gradient greatest_gradient(const LuxGrid& grid, const LuxField& field) {
  Gradient greatest;
  double highest = 0.0;  // of change and bound
  const auto index_of = [&](int cell) -> std::optional<Eigen::Index> {
    const auto at = std::ranges::lower_bound(grid.cell, cell);
    if (at == grid.cell.end() || *at != cell) return {};
    return at - grid.cell.begin();
  };
  const auto compare = [&](Eigen::Index a, std::optional<Eigen::Index> b) {
    if (!b) return;
    constexpr double percent = 100.0;
    const double brighter = std::max(field.lux[a], field.lux[*b]);
    if (!(brighter > 0.0)) return;
    const double change = percent * std::abs(field.lux[a] - field.lux[*b]) / brighter;
    const double bound = percent * (field.lux_within[a] + field.lux_within[*b]) / brighter;
    if (std::isnan(bound) || change + bound > highest) highest = change + bound;
    if (change > greatest.percent) greatest = {change, bound};
  };
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    const int cell = grid.cell[i];
    const auto here = static_cast<Eigen::Index>(i);
    if ((cell + 1) % grid.columns != 0) compare(here, index_of(cell + 1));
    compare(here, index_of(cell + grid.columns));
  }
  const double others = highest - greatest.percent;
  greatest.within = std::isnan(others) ? others : std::max(greatest.within, others);
  return greatest;
}

std::vector<Requirement> sport_requirements(const SportPlace& place, const SportLimits& limits,
                                            const TelevisionLimits& cameras) {
  std::vector<Requirement> requirements;
  const auto add = [&](Requirement requirement) {
    requirement.area = place.name;
    if (requirement.limit > 0.0) requirements.push_back(std::move(requirement));
  };
  add(mean_at_least(limits.mean, place.pitch));
  add(uniformity_at_least(limits.uniformity, place.pitch));
  for (const CameraField& camera : place.cameras) {
    add_camera_limits(camera, cameras, place.name, requirements);
  }
  for (const NamedRating& observer : place.observers) {
    add({.place = observer.name,
         .figure = Figure::glare_rating,
         .is_upper = true,
         .limit = limits.glare_rating,
         .value = observer.value,
         .within = observer.within});
  }
  add_colour_rendering(limits.colour_rendering, place.luminaires, place.name, requirements);
  return requirements;
}

}  // namespace lightwell
