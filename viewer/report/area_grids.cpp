#include "viewer/report/area_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "raytrace/cameras/choose_camera.h"
#include "raytrace/readings/glare_rating.h"
#include "scene/errors.h"
#include "standards/activities.h"
#include "standards/emergency.h"
#include "standards/sports.h"
#include "standards/work_place.h"

namespace lightwell {
namespace {

const Activity& activity_of(const DesignArea& area, const std::vector<Activity>& activities) {
  return find_activity(activities, area.activity, fmt::format("area '{}'", area.name));
}

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

// The depth of the floor below the points of a task area, m: that of the lowest surface within 1.5
// m, which is more than furniture has and less than a storey. 0 without any.
double depth_of_floor(const LuxGrid& task, const GridList& list) {
  constexpr double deepest = 1.5, beyond = 1e-6;  // m
  constexpr int most_surfaces = 64;
  double depth = 0.0;
  for (const Probe& point : task.points) {
    // A point on a surface begins above the surface.
    double at = -beyond;
    for (int i = 0; i < most_surfaces; ++i) {
      const Ray ray{
          .origin = point.position - at * list.up, .direction = -list.up, .t_max = deepest - at};
      ElementHit hit;
      list.caster.closest_hits({&ray, 1}, {&hit, 1});
      if (hit.facet < 0) break;
      at += hit.t + beyond;
      depth = std::max(depth, at - beyond);
    }
  }
  return depth;
}

// The points over the task area at the height of eyes above the floor.
LuxGrid eyes_of(const DesignArea& area, const GridList& list) {
  LuxGrid eyes = list.grids[static_cast<std::size_t>(area.grid)];
  constexpr double level = 0.9;  // cosine of the steepest plane over which eyes are
  if (eyes.points.front().normal.dot(list.up) < level) {
    throw InputError(fmt::format(
        "area '{}': its grid '{}' is not level, and the activity has limits at eyes over it; name "
        "a level grid, or an activity without limits for walls, ceiling and cylindrical "
        "illuminance",
        area.name, eyes.name));
  }
  const double lift = area.eye_height - depth_of_floor(eyes, list);
  eyes.corner += lift * list.up;
  eyes.options.height += lift;
  for (Probe& point : eyes.points) {
    point.position += lift * list.up;
    point.normal = list.up;
  }
  eyes.name = fmt::format("{}, eyes at {:g} {}", eyes.name,
                          area.eye_height / list.scene.metres_per_unit, list.scene.unit_name);
  return eyes;
}

/// Walls and ceilings, and the eyes of all areas that have limits for them.
using EyesBySurface = std::map<int, LuxGrid>;

void add_eyes(const std::vector<int>& surfaces, const LuxGrid& eyes, EyesBySurface& all) {
  for (const int surface : surfaces) {
    const auto [at, is_new] = all.try_emplace(surface, eyes);
    if (is_new) continue;
    at->second.points.insert(at->second.points.end(), eyes.points.begin(), eyes.points.end());
  }
}

// Adds the grids of walls and ceilings, which face the eyes. Points that furniture hides from all
// eyes are left out. Returns the grid of each surface.
std::map<int, int> add_inner_surfaces(const EyesBySurface& surfaces, GridList& list) {
  std::map<int, int> made;
  for (const auto& [surface, eyes] : surfaces) {
    const LuxGrid grid = lux_grid(list.scene, surface, list.up, {.towards = middle_of(eyes)});
    made[surface] = list.add(points_seen_from(list.caster, eyes, grid));
  }
  return made;
}

bool is_along_u(const LuxGrid& grid) {
  return grid.columns * grid.step_u >= grid.rows * grid.step_v;
}

// The middle half of a route's width: the cells of the grid at half their width.
LuxGrid middle_half(const LuxGrid& grid) {
  const bool along_u = is_along_u(grid);
  LuxGrid half = grid;
  double& step = along_u ? half.step_v : half.step_u;
  const Eigen::Vector3d across = along_u ? grid.v : grid.u;
  const int count = along_u ? grid.rows : grid.columns;
  const double whole_step = step;
  step *= 0.5;
  half.area *= 0.5;
  half.corner += 0.25 * count * whole_step * across;
  for (std::size_t i = 0; i < half.points.size(); ++i) {
    const int at = along_u ? grid.cell[i] / grid.columns : grid.cell[i] % grid.columns;
    half.points[i].position += (0.25 * count - 0.5 * (at + 0.5)) * whole_step * across;
  }
  return half;
}

// The line along the middle of a route: one row of its cells, or one column. The line has a point
// where the grid has one beside the line.
LuxGrid centre_line(const LuxGrid& grid) {
  const bool along_u = is_along_u(grid);
  LuxGrid line = grid;
  int& across = along_u ? line.rows : line.columns;
  const int low = (across - 1) / 2, high = across / 2;
  (along_u ? line.step_v : line.step_u) *= across;
  across = 1;
  line.cell.clear();
  line.points.clear();
  const int along = along_u ? line.columns : line.rows;
  for (int i = 0; i < along; ++i) {
    const auto has = [&](int row) {
      const int cell = along_u ? row * grid.columns + i : i * grid.columns + row;
      return std::ranges::binary_search(grid.cell, cell);
    };
    if (!has(low) && !has(high)) continue;
    const double u = along_u ? i + 0.5 : 0.5, v = along_u ? 0.5 : i + 0.5;
    line.cell.push_back(i);
    line.points.push_back(
        {.position = line.corner + u * line.step_u * line.u + v * line.step_v * line.v,
         .normal = grid.points.front().normal});
  }
  if (line.points.empty()) {
    throw InputError(
        fmt::format("grid '{}' has no point along its middle, where EN 1838 has a limit; give the "
                    "route another "
                    "'part'",
                    grid.name));
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

// The points of EN 12193, and upright planes over them that face each camera.
AreaGrids grids_of_sport(const DesignArea& area, const std::vector<Sport>& sports, GridList& list) {
  const SportUse& use = *area.sport;
  sport_limits(sports, use.sport, use.number, fmt::format("area '{}'", area.name));
  LuxGrid pitch = sport_grid(list.grids[static_cast<std::size_t>(area.grid)]);
  const std::string name = pitch.name;
  pitch.name = name + ", EN 12193";
  AreaGrids made{.pitch = list.add(pitch)};
  for (const std::string& camera : use.cameras) {
    LuxGrid grid = pitch;
    grid.name = fmt::format("{}, towards camera {}", name, camera);
    const Eigen::Vector3d lift = use.camera_height * list.up;
    const Eigen::Vector3d eye = choose_camera(list.scene, camera).position;
    grid.corner += lift;
    grid.options.height += use.camera_height;
    measure_as(GridQuantity::vertical, list.up, eye - middle_of(grid), grid);
    for (Probe& point : grid.points) {
      point.position += lift;
      const Eigen::Vector3d way = eye - point.position;
      const Eigen::Vector3d level = way - way.dot(list.up) * list.up;
      if (level.norm() > 0.0) point.normal = level.normalized();
    }
    made.cameras.push_back(list.add(std::move(grid)));
  }
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
  const LuxGrid& grid(int grid) const {
    return report_.surfaces[static_cast<std::size_t>(grid)].grid;
  }
  std::vector<GridField> all(const std::vector<int>& grids) const {
    std::vector<GridField> fields;
    for (const int grid : grids) fields.push_back((*this)[grid]);
    return fields;
  }

 private:
  const LightingReport& report_;
};

// Relative bound of an observer's background: that of the illuminance of the eye over the part of
// the illuminance that is reflected.
double background_within(const Observer& observer, double maintenance_factor) {
  const double reflected = maintenance_factor * std::numbers::pi * observer.glare.background;
  return reflected > 0.0 ? observer.lux_within / reflected : 0.0;
}

std::vector<NamedGlare> observers_of(const DesignArea& area, const LightingReport& report) {
  std::vector<NamedGlare> observers;
  for (const std::string& name : area.observers) {
    const auto at = std::ranges::find(report.observers, name, &Observer::name);
    if (at == report.observers.end()) continue;
    observers.push_back({name, &at->glare, background_within(*at, report.maintenance_factor)});
  }
  return observers;
}

// R_G of new luminaires for the eyes of an area; its bound follows from that of E_h,av and from the
// steps of the directions. Luminaires' own light is taken as exact.
std::vector<NamedRating> glare_ratings(const DesignArea& area, const LuxField& pitch,
                                       const Eigen::Vector3d& up, const LightingReport& report) {
  constexpr double per_relative = 24.0 * 0.9 / std::numbers::ln10;
  const double veil =
      environment_veil(pitch.mean / report.maintenance_factor, area.sport->reflectance);
  std::vector<NamedRating> ratings;
  for (const std::string& name : area.observers) {
    const auto at = std::ranges::find(report.observers, name, &Observer::name);
    if (at == report.observers.end()) continue;
    ratings.push_back({name, greatest_glare_rating(at->arriving, veil, up),
                       per_relative * pitch.mean_within + glare_rating_step_within});
  }
  return ratings;
}

// R_a of the luminaires whose spectrum is known; NaN where R_a is not defined.
std::vector<NamedRating> rated_luminaires(const LightingReport& report) {
  std::vector<NamedRating> rated;
  for (const LuminaireRow& row : report.luminaires) {
    if (row.colour) rated.push_back({row.name, row.colour->rendering, row.colour->within});
  }
  return rated;
}

std::vector<Requirement> judge_sport(const DesignArea& area, const AreaGrids& grids,
                                     const std::vector<Sport>& sports, const Eigen::Vector3d& up,
                                     const Fields& fields, const LightingReport& report) {
  const SportUse& use = *area.sport;
  SportPlace place{.name = area.name, .pitch = fields[grids.pitch]};
  for (const int grid : grids.cameras) {
    place.cameras.push_back({fields[grid], &fields.grid(grid)});
  }
  place.observers = glare_ratings(area, *place.pitch.field, up, report);
  place.luminaires = rated_luminaires(report);
  return sport_requirements(place, sport_limits(sports, use.sport, use.number, area.name),
                            use.television);
}

}  // namespace

std::vector<AreaGrids> add_area_grids(const std::vector<DesignArea>& areas,
                                      const LimitTables& tables, const Scene& scene,
                                      const ElementCaster& caster, const Eigen::Vector3d& up,
                                      std::vector<LuxGrid>& grids) {
  GridList list{scene, caster, up, grids};
  std::vector<AreaGrids> made(areas.size());
  EyesBySurface inner;
  for (std::size_t a = 0; a < areas.size(); ++a) {
    const DesignArea& area = areas[a];
    if (area.emergency) {
      made[a] = grids_of_emergency(area, list);
      continue;
    }
    if (area.sport) {
      made[a] = grids_of_sport(area, tables.sports, list);
      continue;
    }
    made[a] = {.task = area.grid, .surround = area.surround, .background = area.background};
    const Activity& activity = activity_of(area, tables.activities);
    const bool has_walls = activity.walls > 0.0 && !area.walls.empty();
    const bool has_ceilings = activity.ceiling > 0.0 && !area.ceilings.empty();
    if (!(activity.cylindrical > 0.0 || has_walls || has_ceilings)) continue;
    LuxGrid eyes = eyes_of(area, list);
    if (has_walls) add_eyes(area.walls, eyes, inner);
    if (has_ceilings) add_eyes(area.ceilings, eyes, inner);
    if (!(activity.cylindrical > 0.0)) continue;
    made[a].horizontal = list.add(eyes);
    measure_as(GridQuantity::cylindrical, up, Eigen::Vector3d::Zero(), eyes);
    eyes.name += ", cylindrical";
    made[a].cylindrical = list.add(std::move(eyes));
  }
  const std::map<int, int> grid_of = add_inner_surfaces(inner, list);
  for (std::size_t a = 0; a < areas.size(); ++a) {
    const auto add_known = [&](const std::vector<int>& surfaces, std::vector<int>& to) {
      for (const int surface : surfaces) {
        if (const auto at = grid_of.find(surface); at != grid_of.end()) to.push_back(at->second);
      }
    };
    add_known(areas[a].walls, made[a].walls);
    add_known(areas[a].ceilings, made[a].ceilings);
  }
  return made;
}

std::vector<Requirement> judge_areas(const std::vector<DesignArea>& areas,
                                     const LimitTables& tables, const std::vector<AreaGrids>& of,
                                     const Eigen::Vector3d& up, const LightingReport& report) {
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
    } else if (area.sport) {
      some = judge_sport(area, grids, tables.sports, up, fields, report);
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
                                      .luminaires = rated_luminaires(report)},
                                     activity_of(area, tables.activities), area.is_raised);
    }
    requirements.insert(requirements.end(), some.begin(), some.end());
  }
  return requirements;
}

}  // namespace lightwell
