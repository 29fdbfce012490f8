#include "scene/found_by_chance.h"

namespace lightwell {

Spectrum limited_sum(std::span<const Spectrum> found, int count, float besides) {
  constexpr float of_the_others = 4.0f;
  if (count < 2) return found.front();
  float all = 0.0f;
  for (const Spectrum& light : found) all += light.mean();
  Spectrum sum = Spectrum::Zero(found.front().size());
  for (const Spectrum& light : found) {
    const float own = light.mean();
    const float mean_of_others = (all - own) / static_cast<float>(count - 1);
    const float most = of_the_others * mean_of_others + besides;
    sum += own > most ? Spectrum(light * (most / own)) : light;
  }
  return sum;
}

}  // namespace lightwell
