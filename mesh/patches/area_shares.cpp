#include "mesh/patches/area_shares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>

#include "scene/scenery_box.h"

namespace lightwell {

double typical_area(std::span<const double> area) {
  std::vector<double> sorted(area.begin(), area.end());
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const double total = std::accumulate(sorted.begin(), sorted.end(), 0.0);
  double typical = 0.0, larger = 0.0;
  // About half; elements of a regular grid do not add up to this share, so rounding cannot decide.
  constexpr double about_half = 0.47;
  for (std::size_t i = 0; i < sorted.size() && larger < about_half * total; ++i) {
    typical = sorted[i];
    larger += sorted[i];
  }
  return typical;
}

std::vector<int> samples_by_area(std::span<const double> area, int samples, int most_times) {
  constexpr double large = 0.25;  // share of the typical area
  // The power changes between the areas that patches of a grid have, which are halves and quarters,
  // so that rounding does not decide.
  constexpr double between = 0.45;
  const double least_of_large = large * typical_area(area);
  std::vector<int> counts(area.size(), samples);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!(area[i] < least_of_large)) continue;
    const double times = area[i] > 0.0 ? least_of_large / area[i] : most_times;
    const double halvings = std::floor(std::log2(times) + between);
    const double power = std::min(std::exp2(halvings), static_cast<double>(most_times));
    counts[i] = std::max(1, samples / static_cast<int>(power));
  }
  return counts;
}

std::vector<int> samples_by_area(const Scene& scene, const PatchMesh& mesh, int samples,
                                 int most_times) {
  const std::vector<char> is_near = near_scenery(scene).is_near;
  std::vector<int> near;
  std::vector<double> area;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const auto facet = static_cast<std::size_t>(mesh.facet[mesh.first_element[p]]);
    if (is_near[facet] == 0) continue;
    near.push_back(p);
    area.push_back(mesh.area[p]);
  }
  const std::vector<int> of_near = samples_by_area(area, samples, most_times);
  std::vector<int> counts(static_cast<std::size_t>(mesh.patch_count()), samples);
  for (std::size_t i = 0; i < near.size(); ++i) {
    counts[static_cast<std::size_t>(near[i])] = of_near[i];
  }
  return counts;
}

}  // namespace lightwell
