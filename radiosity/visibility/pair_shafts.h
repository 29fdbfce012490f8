#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_outline.h"
#include "radiosity/visibility/visible_exchange.h"

namespace lightwell {

/// What stands between the patches of a mesh, pair by pair. Keeps a reference to the mesh.
class PairShafts {
 public:
  PairShafts(const ElementCaster& caster, const std::vector<PatchOutline>& outlines);

  /// Bytes that it will take, roughly: every patch an end of one part, every facet an occluder.
  static std::int64_t bytes_for(const PatchMesh& mesh);

  /// Whether something lies on part of the patch, which no shaft shows.
  bool is_covered(int patch) const { return is_covered_[static_cast<std::size_t>(patch)] != 0; }
  /// Whether something lies on all of it: the patch sees that and nothing else.
  bool is_hidden(int patch) const { return is_hidden_[static_cast<std::size_t>(patch)] != 0; }

  /// Fills `between` for two polygons, neither of which is covered.
  void find(int i, int j, Between& between) const;
  /// Whether find() found little enough for visible().
  bool has_exact(int i, int j, const Between& between) const;
  /// S_ij of polygons with `between` between them, to `tolerance` of F of the smaller one; see
  /// visible_exchange. Nothing where has_exact() is false.
  std::optional<VisibleExchange> visible(int i, int j, const Between& between, double unoccluded,
                                         double tolerance) const;

 private:
  const PatchMesh& mesh_;
  Shafts shafts_;
  std::vector<ShaftEnd> ends_;
  std::vector<char> is_covered_, is_hidden_;
};

}  // namespace lightwell
