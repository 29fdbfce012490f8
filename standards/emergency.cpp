#include "standards/emergency.h"

#include <algorithm>

namespace lightwell {

std::vector<Requirement> emergency_requirements(const EmergencyLight& light) {
  constexpr double of_route = 1.0, of_open_area = 0.5, of_high_risk = 15.0;  // lx
  constexpr double most_diversity = 40.0, least_uniformity = 0.10, share_of_usual = 0.10;
  std::vector<Requirement> made;
  switch (light.kind) {
    case EmergencyArea::escape_route:
      made = {least_at_least(of_route, light.centre_line),
              diversity_at_most(most_diversity, light.centre_line),
              least_at_least(0.5 * of_route, light.area)};
      break;
    case EmergencyArea::open_area:
      made = {least_at_least(of_open_area, light.area),
              diversity_at_most(most_diversity, light.area)};
      break;
    case EmergencyArea::high_risk_task_area:
      made = {mean_at_least(std::max(of_high_risk, share_of_usual * light.usual_lux), light.area),
              uniformity_at_least(least_uniformity, light.area)};
      break;
  }
  for (Requirement& requirement : made) requirement.area = light.name;
  return made;
}

}  // namespace lightwell
