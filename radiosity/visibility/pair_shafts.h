#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_outline.h"
#include "radiosity/visibility/visible_exchange.h"

namespace lightwell {

/// Occluders between pairs of patches of a mesh, and visible exchange areas. Keeps a reference to
/// the mesh.
class PairShafts {
 public:
  PairShafts(const ElementCaster& caster, const std::vector<PatchOutline>& outlines);

  /// Estimated bytes of a PairShafts: one convex part per patch, one occluder per facet.
  static std::int64_t bytes_for(const PatchMesh& mesh);

  /// True if another surface lies face to face on part of the patch. No shaft holds such a surface.
  bool is_covered(int patch) const { return is_covered_[static_cast<std::size_t>(patch)] != 0; }
  /// True if another surface lies on every element of the patch: the patch sees that surface only.
  bool is_hidden(int patch) const { return is_hidden_[static_cast<std::size_t>(patch)] != 0; }

  /// Fills `between` with the occluders between patches i and j. Precondition: both patches are
  /// polygons, and neither is covered.
  void find(int i, int j, Between& between) const;
  /// True if visible() can compute the pair. Conditions:
  ///   - no round shape and no polygon with holes in between;
  ///   - at most most_pieces_between pieces in between;
  ///   - both patches are polygons that do not cross themselves.
  bool has_exact(int i, int j, const Between& between) const;
  /// Exchange area S_ij, m^2, behind the occluders in `between`, to `tolerance` of the form factor
  /// F of the smaller patch; see visible_exchange. `unoccluded`: S_ij without occluders. Empty
  /// where has_exact() is false.
  std::optional<VisibleExchange> visible(int i, int j, const Between& between, double unoccluded,
                                         double tolerance) const;

 private:
  const PatchMesh& mesh_;
  Shafts shafts_;
  std::vector<ShaftEnd> ends_;
  std::vector<char> is_covered_, is_hidden_;
};

}  // namespace lightwell
