#pragma once

#include <optional>
#include <vector>

#include "scene/io/activity_file.h"
#include "standards/requirement.h"
#include "standards/sports.h"
#include "viewer/report/lighting_report.h"

namespace lightwell {

/// Tables of limits by keys.
struct LimitTables {
  std::vector<Activity> activities{};
  std::vector<Sport> sports{};
};

/// Indices into LightingReport::surfaces of what was measured for a design area.
struct AreaGrids {
  std::optional<int> task{}, surround{}, background{};
  std::vector<int> walls{}, ceilings{};
  std::optional<int> cylindrical{}, horizontal{};  ///< at the height of eyes
  std::optional<int> emergency{}, centre_line{};
  std::optional<int> pitch{};  ///< of a sport, with the points of EN 12193
  std::vector<int> cameras{};  ///< towards each camera of a sport
};

/// Adds to the `grids` that the areas name (by index) those that the areas need besides: walls,
/// ceilings, cylinders at the height of eyes, those of direct light, and those of
/// EN 12193 with upright planes towards cameras. Walls and ceilings have no
/// points that are hidden from all eyes over the task area.
/// Returns an entry for each area. Throws InputError for an activity or a sport that is not in the
/// tables, for an escape route wider than EN 1838 has them, and what lux_grid() throws.
std::vector<AreaGrids> add_area_grids(const std::vector<DesignArea>& areas,
                                      const LimitTables& tables, const Scene& scene,
                                      const ElementCaster& caster, const Eigen::Vector3d& up,
                                      std::vector<LuxGrid>& grids);

/// The limits that the areas are held to, and the measured figures. `of` is that of
/// add_area_grids().
std::vector<Requirement> judge_areas(const std::vector<DesignArea>& areas,
                                     const LimitTables& tables, const std::vector<AreaGrids>& of,
                                     const Eigen::Vector3d& up, const LightingReport& report);

}  // namespace lightwell
