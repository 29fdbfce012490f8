#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/io/remarks.h"
#include "scene/io/stf/stf_file.h"

namespace lightwell {

/// A room in plan, raised to its height. Wall i leads from corner i to the next.
struct StfPlan {
  std::string name{};                      ///< unique
  std::vector<Eigen::Vector2d> corners{};  ///< m, counter-clockwise seen from above
  std::vector<double> walls{};             ///< reflectances, [0,1]
  double floor = 0.0, ceiling = 0.0;       ///< reflectances, [0,1]
  double height = 0.0;                     ///< m
  double level = 0.0;                      ///< m, z of the floor

  Eigen::Vector2d corner(std::size_t i) const { return corners[i % corners.size()]; }
  /// The outline at a height above the floor, m; its front faces up.
  Loop outline(double above) const;
};

/// Reads the plan of a room. Reflectances that the room lacks are 0.7 of the ceiling, 0.5 of walls
/// and 0.2 of the floor, with a remark. Throws InputError
///   - for keys that are missing or wrong, and a count of points that the room does not have;
///   - for an outline that crosses itself or has no area;
///   - for sizes that no room has in metres.
StfPlan read_stf_plan(StfSection& room, const std::string& name, Remarks& remarks);

/// Raises rooms that lie over others in plan onto them: STF has no levels, and rooms of several
/// storeys all stand on z = 0. Throws LimitError where comparing the plans would take minutes.
void set_levels(const StfSection& project, std::vector<StfPlan>& plans, Remarks& remarks);

}  // namespace lightwell
