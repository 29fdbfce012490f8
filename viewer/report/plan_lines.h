#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/scene.h"

namespace lightwell {

/// A straight line of a plan, m along u and v from the grid's corner.
struct PlanSegment {
  Eigen::Vector2d from, to;
};

/// A luminaire in a plan.
struct PlanLuminaire {
  /// Outlines of the opening of a lamp, or of each facet of an emitting surface, m.
  std::vector<std::vector<Eigen::Vector2d>> outlines{};
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  std::string label{};  ///< text above the middle, such as a level; empty: none
};

/// An eye in a plan.
struct PlanEye {
  Eigen::Vector2d position, direction;  ///< direction: unit, or zero for a look along the normal
  int number = 0;                       ///< of the observer, from 1
};

/// The room around a grid, seen along the normal of the grid against its direction.
struct PlanLines {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  ///< area shown, m
  double cut_height = 0.0;           ///< m above the grid, of the plane that cuts the walls
  std::vector<PlanSegment> walls{};  ///< where that plane cuts opaque surfaces
  std::vector<PlanSegment> panes{};  ///< where the plane cuts glass
  std::vector<PlanSegment> edges{};  ///< of surfaces below the plane, as far as they are seen
  std::vector<PlanLuminaire> luminaires{};
  std::vector<PlanEye> eyes{};
};

/// Lines of the plan of a grid. The cutting plane lies 1.2 m above the surface below the grid, or
/// half way to what is above the grid if that is lower. Edges between facets that lie nearly in one
/// plane are left out, and so are edges beyond the longest 5000.
PlanLines plan_lines(const Scene& scene, const ElementCaster& caster, const LuxGrid& grid,
                     std::span<const Camera> eyes);

}  // namespace lightwell
