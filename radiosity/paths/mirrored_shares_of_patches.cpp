#include "radiosity/paths/mirrored_shares_of_patches.h"

#include <vector>

#include "mesh/patches/patch_patterns.h"
#include "scene/specular.h"

namespace lightwell {

BandArray mirrored_shares(const Scene& scene, const PatchMesh& mesh) {
  std::vector<Spectrum> of_material;
  for (const Material& material : scene.materials) of_material.push_back(mean_specular(material));
  BandArray shares(mesh.patch_count(), scene.bands.count());
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const auto material = static_cast<std::size_t>(mesh.material[static_cast<std::size_t>(i)]);
    const bool has_pattern = mesh.patterns && mesh.patterns->is_given(i);
    shares.row(i) =
        (has_pattern ? mean_specular(mesh.patterns->mirror_of(scene.materials[material], i))
                     : of_material[material])
            .transpose();
  }
  return shares;
}

}  // namespace lightwell
