#pragma once

#include <string>
#include <vector>

#include "scene/io/lighting_design.h"
#include "standards/requirement.h"

namespace lightwell {

/// Greatest width of an escape route, m; wider ones are several routes, or an open area (EN 1838).
inline constexpr double widest_escape_route = 2.0;

/// Measurements of an area in an emergency, of maintained light straight from the luminaires. EN
/// 1838 leaves reflected light out.
struct EmergencyLight {
  std::string name{};
  EmergencyArea kind = EmergencyArea::escape_route;
  GridField area{};         ///< all of the area; of a route, the middle half of its width
  GridField centre_line{};  ///< of a route
  double usual_lux = 0.0;   ///< of a high-risk task area, without emergency
};

/// The limits of EN 1838:2013:
/// - escape route: 1 lx along its centre line, half of that over the middle half of its width;
///   E_max / E_min of the centre line at most 40;
/// - open area: 0.5 lx; E_max / E_min at most 40;
/// - high-risk task area: a tenth of the usual illuminance, and 15 lx; U_0 0.10.
std::vector<Requirement> emergency_requirements(const EmergencyLight& light);

}  // namespace lightwell
