#include "radiosity/paths/squared_indices.h"

#include "radiosity/visibility/medium_walks.h"
#include "scene/parallel.h"

namespace lightwell {

Eigen::ArrayXd squared_indices(const Scene& scene, const ElementCaster& caster) {
  const MediumWalks walks(scene);
  if (!walks.bends()) return {};
  const PatchMesh& mesh = caster.mesh();
  // Patches of panes and bodies neither take nor send diffuse light.
  Eigen::ArrayXd result = Eigen::ArrayXd::Ones(mesh.patch_count());
  constexpr int grain = 64;
  parallel_for(mesh.patch_count(), grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      if (walks.passes(mesh.facet[mesh.first_element[p]])) continue;
      const double index = double{walks.before(caster, p).index};
      result[p] = index * index;
    }
  });
  return (result != 1.0).any() ? result : Eigen::ArrayXd();
}

}  // namespace lightwell
