#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/coat.h"

namespace lightwell {

/// Means over patches of what patterns mirror and pass (see SurfacePattern): with the reflectance
/// and transmittance of a patch, which are means as well, they add up to what all of the patch
/// sends on.
class PatchPatterns {
 public:
  /// `mesh` has textures.
  PatchPatterns(const Scene& scene, const PatchMesh& mesh);

  /// True if a part of the patch shows a pattern.
  bool is_given(int patch) const { return row_[static_cast<std::size_t>(patch)] >= 0; }
  /// The part of a material that mirrors, refracts and passes light straight on, as a patch with a
  /// pattern has it: shares and roughness are the patch's means.
  Material mirror_of(const Material& material, int patch) const;
  /// The coated base of a patch with a pattern; empty: the patch has no coat.
  std::optional<CoatedBase> base_of(int patch) const;
  /// Sets the transmittance of the patches of a translucent mesh to the means.
  void set_transmittance(PatchMesh& mesh) const;

 private:
  struct Sums;
  void add_element(const Scene& scene, const PatchMesh& mesh, int element, Sums& sums) const;
  void keep(int patch, const Sums& sums);

  std::vector<int> row_{};  // by patch; -1: no pattern
  BandArray specular_{}, bare_{}, straight_{}, transmittance_{};
  Eigen::ArrayXf cover_{}, roughness_{};
  std::vector<std::shared_ptr<const CoatLevels>> coat_{};  // by row; null: no coat
};

}  // namespace lightwell
