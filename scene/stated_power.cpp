#include "scene/stated_power.h"

#include <numeric>

namespace lightwell {

double stated_amount(const Bands& bands, StatedPower unit, const Spectrum& power) {
  if (unit == StatedPower::lumens) return luminous(bands, power);
  return std::accumulate(power.begin(), power.end(), 0.0);
}

void scale_emission(Material& material, float factor) {
  material.emission *= factor;
  if (material.emission_texture) material.emission_texture->factor *= factor;
}

}  // namespace lightwell
