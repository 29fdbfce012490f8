#include "viewer/report/requested_grids.h"

#include <fmt/format.h>

#include <utility>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

int find_surface(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    if (scene.surfaces[i].name == name) return static_cast<int>(i);
    names.push_back(scene.surfaces[i].name);
  }
  throw InputError(
      fmt::format("{}: there is no surface '{}'.{} 'lightwell info {} --surfaces' lists all.",
                  scene.file.string(), name, did_you_mean(name, names), scene.file.string()));
}

}  // namespace

std::vector<LuxGrid> requested_grids(const GridRequest& asked,
                                     std::span<const CalculationGrid> of_file, const Scene& scene,
                                     const Eigen::Vector3d& up) {
  std::vector<LuxGrid> grids;
  const double spacing = asked.spacing;
  constexpr double strip = 0.5;  // m
  const double margin = asked.margin.value_or(strip);
  for (const CalculationGrid& grid : of_file) {
    const double usual = grid.height > 0.0 ? margin : 0.0;
    LuxGrid made = lux_grid(scene, grid.surface, up,
                            {.height = grid.height,
                             .margin = grid.margin.value_or(usual),
                             .spacing = grid.spacing > 0.0 ? grid.spacing : spacing,
                             .part = grid.part});
    made.name = grid.name;
    for (const int other : grid.leaves_out) {
      made = without_points_over(grids[static_cast<std::size_t>(other)], std::move(made));
    }
    if (made.points.empty()) {
      throw InputError(fmt::format(
          "{}: grid '{}' has no points beside those of the grids that it leaves out; give it a "
          "larger part, or a smaller spacing",
          scene.file.string(), grid.name));
    }
    measure_as(grid.quantity, up, grid.facing, made);
    grids.push_back(std::move(made));
  }
  for (const std::string& name : asked.surfaces) {
    grids.push_back(lux_grid(scene, find_surface(scene, name), up, {.spacing = spacing}));
  }
  for (const NamedNumber& plane : asked.planes) {
    grids.push_back(lux_grid(scene, find_surface(scene, plane.name), up,
                             {.height = plane.value, .margin = margin, .spacing = spacing}));
    grids.back().name = fmt::format("{} + {:g} {}", plane.name, plane.value / scene.metres_per_unit,
                                    scene.unit_name);
  }
  return grids;
}

}  // namespace lightwell
