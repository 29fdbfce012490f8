#include "radiosity/direct_light/patch_base.h"

#include "mesh/patches/patch_patterns.h"

namespace lightwell {

std::optional<CoatedBase> base_of_patch(const DirectLight& direct_light, const PatchMesh& mesh,
                                        int patch) {
  const CoatedBase* base = direct_light.base_of(mesh.material[patch]);
  if (!base) return std::nullopt;
  std::optional<CoatedBase> own;
  if (mesh.patterns && mesh.patterns->is_given(patch)) own = mesh.patterns->base_of(patch);
  return own ? own : std::optional(*base);
}

}  // namespace lightwell
