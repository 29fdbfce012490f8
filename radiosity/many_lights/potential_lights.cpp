#include "radiosity/many_lights/potential_lights.h"

#include <algorithm>
#include <cstddef>

namespace lightwell {

std::vector<LightSample> sorted_samples(std::vector<PotentialLight> lights, double least) {
  double all = 0.0;
  for (const PotentialLight& light : lights) all += light.about;
  std::ranges::sort(lights, [](const PotentialLight& a, const PotentialLight& b) {
    return a.about != b.about ? a.about > b.about : a.light < b.light;
  });
  double asked = 0.0;
  std::size_t count = 0;
  while (count < lights.size() && all - asked > least) asked += lights[count++].about;
  std::vector<LightSample> samples;
  for (std::size_t k = 0; k < count; ++k) {
    samples.push_back({.light = lights[k].light, .chance = std::min(1.0, asked / all)});
  }
  return samples;
}

std::vector<LightSample> important_samples(const std::vector<PotentialLight>& lights, double least,
                                           double u, int cluster) {
  // The chance of light that the estimate takes for none: the middle of a light may lie below the
  // horizon or outside of a beam of which the point sees a part.
  constexpr double even = 0.1;
  std::vector<LightSample> samples;
  std::vector<PotentialLight> dim;
  double of_dim = 0.0;
  for (const PotentialLight& light : lights) {
    if (light.about > least) {
      samples.push_back({.light = light.light});
      continue;
    }
    dim.push_back(light);
    of_dim += light.about;
  }
  if (dim.empty()) return samples;
  const double by_number = (of_dim > 0.0 ? even : 1.0) / static_cast<double>(dim.size());
  const double by_light = of_dim > 0.0 ? (1.0 - even) / of_dim : 0.0;
  std::size_t k = 0;
  double before = 0.0, chance = by_number + by_light * dim[0].about;
  for (const double from : {0.0, 0.5}) {
    while (k + 1 < dim.size() && from + 0.5 * u >= before + chance) {
      before += chance;
      chance = by_number + by_light * dim[++k].about;
    }
    samples.push_back({.light = dim[k].light, .chance = 2.0 * chance, .cluster = cluster});
  }
  return samples;
}

}  // namespace lightwell
