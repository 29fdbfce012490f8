#include "mesh/cleaning/spread_power.h"

#include <vector>

#include "scene/picture_cells.h"
#include "scene/stated_power.h"

namespace lightwell {
namespace {

bool states_power(const Scene& scene, const Surface& surface) {
  return scene.materials[surface.material].stated_power != StatedPower::none;
}

// Area of one side by material, m^2; 0 for a material whose file states no power.
std::vector<double> areas_of(const Scene& scene) {
  std::vector<double> areas(scene.materials.size(), 0.0);
  for (const Surface& surface : scene.surfaces) {
    if (states_power(scene, surface)) areas[surface.material] += surface_area(surface);
  }
  return areas;
}

// Light of one side of all surfaces of a material, in the unit of the material's statement.
double amount_sent(const Scene& scene, int material) {
  double amount = 0.0;
  for (const Surface& surface : scene.surfaces) {
    if (surface.material != material) continue;
    const Spectrum M = mean_exitance(scene, surface).cast<float>();
    amount += surface_area(surface) *
              stated_amount(scene.bands, scene.materials[material].stated_power, M);
  }
  return amount;
}

}  // namespace

void keep_stated_power(const Scene& given, Scene& clean) {
  const std::vector<double> before = areas_of(given), after = areas_of(clean);
  for (int m = 0; m < static_cast<int>(clean.materials.size()); ++m) {
    if (!(before[m] > 0.0 && after[m] > 0.0)) continue;
    if (static_cast<float>(before[m] / after[m]) == 1.0f) continue;
    const double sent = amount_sent(given, m), left = amount_sent(clean, m);
    if (left > 0.0) scale_emission(clean.materials[m], static_cast<float>(sent / left));
  }
}

}  // namespace lightwell
