#include "viewer/report/area_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/errors.h"
#include "standards/activities.h"
#include "standards/emergency.h"
#include "standards/work_place.h"

namespace lightwell {
namespace {

/// Grids of a report under construction.
struct GridList {
  const Scene& scene;
  const ElementCaster& caster;
  Eigen::Vector3d up;
  std::vector<LuxGrid>& grids;

  int add(LuxGrid grid) {
    grid.is_of_area = true;
    grids.push_back(std::move(grid));
    return static_cast<int>(grids.size()) - 1;
  }
};

Eigen::Vector3d middle_of(const LuxGrid& grid) {
  return grid.corner +
         0.5 * (grid.columns * grid.step_u * grid.u + grid.rows * grid.step_v * grid.v);
}

// The points over the task area at the height of eyes.
LuxGrid eyes_of(const DesignArea& area, const GridList& list) {
  const LuxGrid& task = list.grids[static_cast<std::size_t>(area.grid)];
  LuxGridOptions options = task.options;
  options.height = area.eye_height;
  LuxGrid eyes = lux_grid(list.scene, task.surface, list.up, options);
  eyes.name = fmt::format("{}, eyes at {:g} {}", task.name,
                          area.eye_height / list.scene.metres_per_unit, list.scene.unit_name);
  return eyes;
}

// Adds the grid of a wall or a ceiling, which faces the eyes. Points that furniture hides from all
// eyes are left out. Several areas share the grid.
int add_inner_surface(int surface, const LuxGrid& eyes, GridList& list) {
  const std::string& name = list.scene.surfaces[static_cast<std::size_t>(surface)].name;
  const auto known = std::ranges::find(list.grids, name, &LuxGrid::name);
  if (known != list.grids.end()) return static_cast<int>(known - list.grids.begin());
  const LuxGrid grid = lux_grid(list.scene, surface, list.up, {.towards = middle_of(eyes)});
  return list.add(points_seen_from(list.caster, eyes, grid));
}

AreaGrids grids_of_activity(const DesignArea& area, const Activity& activity, GridList& list) {
  AreaGrids made{.task = area.grid, .surround = area.surround, .background = area.background};
  LuxGrid eyes = eyes_of(area, list);
  const auto add_all = [&](const std::vector<int>& surfaces, double limit) {
    std::vector<int> added;
    for (const int surface : surfaces) {
      if (limit > 0.0) added.push_back(add_inner_surface(surface, eyes, list));
    }
    return added;
  };
  made.walls = add_all(area.walls, activity.walls);
  made.ceilings = add_all(area.ceilings, activity.ceiling);
  if (!(activity.cylindrical > 0.0)) return made;
  made.horizontal = list.add(eyes);
  measure_as(GridQuantity::cylindrical, list.up, Eigen::Vector3d::Zero(), eyes);
  eyes.name += ", cylindrical";
  made.cylindrical = list.add(std::move(eyes));
  return made;
}

// The grid's points within a quarter of its width of the line along its middle.
LuxGrid middle_half(const LuxGrid& grid) {
  const bool is_along_u = grid.columns * grid.step_u >= grid.rows * grid.step_v;
  LuxGrid half = grid;
  double& step = is_along_u ? half.step_v : half.step_u;
  const Eigen::Vector3d across = is_along_u ? grid.v : grid.u;
  const int count = is_along_u ? grid.rows : grid.columns;
  half.corner += 0.25 * count * step * across;
  step *= 0.5;
  for (std::size_t i = 0; i < half.points.size(); ++i) {
    const int at = is_along_u ? grid.cell[i] / grid.columns : grid.cell[i] % grid.columns;
    half.points[i].position =
        grid.points[i].position + (0.25 * count - 0.5 * (at + 0.5)) * 2.0 * step * across;
  }
  return half;
}

// The line along the middle of a grid: one row of its cells, or one column.
LuxGrid centre_line(const LuxGrid& grid) {
  const bool is_along_u = grid.columns * grid.step_u >= grid.rows * grid.step_v;
  LuxGrid line = grid;
  int& across = is_along_u ? line.rows : line.columns;
  (is_along_u ? line.step_v : line.step_u) *= across;
  across = 1;
  line.cell.clear();
  line.points.clear();
  const int along = is_along_u ? line.columns : line.rows;
  for (int i = 0; i < along; ++i) {
    const double u = is_along_u ? i + 0.5 : 0.5, v = is_along_u ? 0.5 : i + 0.5;
    line.cell.push_back(i);
    line.points.push_back(
        {.position = line.corner + u * line.step_u * line.u + v * line.step_v * line.v,
         .normal = grid.points.front().normal});
  }
  return line;
}

AreaGrids grids_of_emergency(const DesignArea& area, GridList& list) {
  AreaGrids made;
  LuxGrid grid = list.grids[static_cast<std::size_t>(area.grid)];
  grid.is_direct_only = true;
  const std::string name = grid.name + ", direct light";
  if (area.emergency == EmergencyArea::escape_route) {
    const double width = std::min(grid.columns * grid.step_u, grid.rows * grid.step_v);
    if (width > widest_escape_route * (1.0 + 1e-9)) {
      throw InputError(fmt::format(
          "area '{}' is an escape route of {:.3g} m, and EN 1838 has them up to {:g} m wide; make "
          "it several strips by 'part' of [[grids]], or an open area",
          area.name, width, widest_escape_route));
    }
    LuxGrid line = centre_line(grid);
    line.name = name + ", centre line";
    made.centre_line = list.add(std::move(line));
    grid = middle_half(grid);
  }
  grid.name = name;
  made.emergency = list.add(std::move(grid));
  return made;
}

/// Fields of a report by grid.
class Fields {
 public:
  explicit Fields(const LightingReport& report) : report_(report) {}

  // Electric light alone, where it is known by itself.
  GridField operator[](std::optional<int> grid) const {
    if (!grid) return {};
    const CalculationSurface& surface = report_.surfaces[static_cast<std::size_t>(*grid)];
    const LuxField* const electric = electric_field(report_, surface);
    return {surface.grid.name, electric ? electric : &surface.field};
  }
  std::vector<GridField> all(const std::vector<int>& grids) const {
    std::vector<GridField> fields;
    for (const int grid : grids) fields.push_back((*this)[grid]);
    return fields;
  }

 private:
  const LightingReport& report_;
};

std::vector<NamedGlare> observers_of(const DesignArea& area, const LightingReport& report) {
  std::vector<NamedGlare> observers;
  for (const std::string& name : area.observers) {
    const auto at = std::ranges::find(report.observers, name, &Observer::name);
    if (at != report.observers.end()) observers.push_back({name, &at->glare});
  }
  return observers;
}

}  // namespace

std::vector<AreaGrids> add_area_grids(const std::vector<DesignArea>& areas,
                                      const std::vector<Activity>& activities, const Scene& scene,
                                      const ElementCaster& caster, const Eigen::Vector3d& up,
                                      std::vector<LuxGrid>& grids) {
  GridList list{scene, caster, up, grids};
  std::vector<AreaGrids> made;
  for (const DesignArea& area : areas) {
    made.push_back(
        area.emergency
            ? grids_of_emergency(area, list)
            : grids_of_activity(area, find_activity(activities, area.activity, area.name), list));
  }
  return made;
}

std::vector<Requirement> judge_areas(const std::vector<DesignArea>& areas,
                                     const std::vector<Activity>& activities,
                                     const std::vector<AreaGrids>& of,
                                     const LightingReport& report) {
  const Fields fields(report);
  std::vector<Requirement> requirements;
  for (std::size_t a = 0; a < areas.size(); ++a) {
    const DesignArea& area = areas[a];
    const AreaGrids& grids = of[a];
    std::vector<Requirement> some;
    if (area.emergency) {
      some = emergency_requirements({.name = area.name,
                                     .kind = *area.emergency,
                                     .area = fields[grids.emergency],
                                     .centre_line = fields[grids.centre_line],
                                     .usual_lux = area.usual_lux});
    } else {
      some = work_place_requirements({.name = area.name,
                                      .task = fields[grids.task],
                                      .surround = fields[grids.surround],
                                      .background = fields[grids.background],
                                      .walls = fields.all(grids.walls),
                                      .ceilings = fields.all(grids.ceilings),
                                      .cylindrical = fields[grids.cylindrical],
                                      .horizontal = fields[grids.horizontal],
                                      .observers = observers_of(area, report),
                                      .error_estimate = report.error_estimate},
                                     find_activity(activities, area.activity, area.name),
                                     area.is_raised);
    }
    requirements.insert(requirements.end(), some.begin(), some.end());
  }
  return requirements;
}

}  // namespace lightwell
