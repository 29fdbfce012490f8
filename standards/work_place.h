#pragma once

#include <string>
#include <vector>

#include "raytrace/readings/glare.h"
#include "scene/io/activity_file.h"
#include "standards/requirement.h"

namespace lightwell {

/// An observer's glare with its name.
struct NamedGlare {
  std::string name{};
  const Glare* glare = nullptr;
  double background_within = 0.0;  ///< relative bound of the background's luminance; NaN: unknown
};

/// Measurements of a work place, of maintained electric light. Fields without a name were not
/// asked for.
struct WorkPlace {
  std::string name{};
  GridField task{}, surround{}, background{};
  std::vector<GridField> walls{}, ceilings{};
  GridField cylindrical{};  ///< cylindrical illuminance over the task area
  GridField horizontal{};   ///< planar illuminance at the points of `cylindrical`
  std::vector<NamedGlare> observers{};
  std::vector<NamedRating> luminaires{};  ///< R_a of those whose spectrum is known
};

/// Least mean illuminance of the immediate surroundings of a task area, lx, for the one that the
/// task asks for (EN 12464-1:2021, table of clause 5.3.4: 500 for 750 and more, 300 for 500, 200
/// for 300, 150 for 200; that of the task below).
double surround_mean(double task_mean);

/// The limits of EN 12464-1 that were measured:
/// - task area: E_m and U_0 of the activity; surroundings: surround_mean() and U_0 0.40;
///   background, 3 m wide at least: a third of the surroundings' E_m, and U_0 0.10;
/// - walls and ceilings: E_m of the activity and U_0 0.10;
/// - cylindrical illuminance: E_m,z of the activity and U_0 0.10; recommended: a modelling index
///   E_m,z / E_m from 0.30 to 0.60;
/// - R_UG of each observer. The bound of R_UG is that of the background's luminance: 8 / ln 10
/// times
///   the relative bound;
/// - R_a of the worst luminaire whose spectrum is known.
std::vector<Requirement> work_place_requirements(const WorkPlace& place, const Activity& activity,
                                                 bool is_raised);

}  // namespace lightwell
