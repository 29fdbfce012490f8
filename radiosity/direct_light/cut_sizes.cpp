#include "radiosity/direct_light/cut_sizes.h"

#include <algorithm>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"

namespace lightwell {

CutSizes cut_sizes(const ElementCaster& caster, const DirectLight& direct_light,
                   const ShadowOptions& shadows) {
  if (!direct_light.has_clusters()) return {};
  const PatchMesh& mesh = caster.mesh();
  std::vector<int> patches;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if ((mesh.reflectance.row(p) > 0.0f).any()) patches.push_back(p);
  }
  constexpr int most_points = 256;
  const int count = std::min(most_points, static_cast<int>(patches.size()));
  CutSizes sizes{.lights = direct_light.light_count()};
  for (int i = 0; i < count; ++i) {
    // Evenly spaced among all patches.
    const auto at = static_cast<std::size_t>(i) * patches.size() / static_cast<std::size_t>(count);
    const int first = mesh.first_element[patches[at]];
    const PatchPoint middle = element_center(mesh, first);
    const int asked =
        direct_light.asked(caster, {.at = {middle.position, middle.normal, mesh.facet[first]},
                                    .key = static_cast<std::uint64_t>(patches[at]),
                                    .shadows = shadows});
    sizes.mean += static_cast<double>(asked) / count;
    sizes.most = std::max(sizes.most, asked);
  }
  return sizes;
}

}  // namespace lightwell
