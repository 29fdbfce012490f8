#pragma once

#include <vector>

#include "mesh/cleaning/facet_check.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {

/// Input for view factors: the polygons of a file as pure geometry, all diffuse, opaque and without
/// light, and the rows of their sides.
struct ViewFactorScene {
  Scene scene{};                 ///< one band; one surface for each facet
  std::vector<int> front_row{};  ///< row of each facet's front; -1: none
  std::vector<int> back_row{};   ///< row of each facet's back; -1: none, or no back
  int row_count = 0;
};

/// Fronts of facets have rows. With `two_sided` backs have rows, too: row n + i is the back of row
/// i of n. Facets that lie on each other are merged into the first:
///   - a second facet with the same orientation is dropped, since nothing could distinguish the
///     two;
///   - a second facet with the opposite orientation becomes the back of the first, so that rays
///     need not choose between the two.
///
/// Facets without a row block light from both sides.
ViewFactorScene make_view_factor_scene(const NumberedScene& numbered, const FacetCheck& check,
                                       bool two_sided);

/// Row of every patch of a mesh of `view.scene`; -1: none.
std::vector<int> rows_of_patches(const ViewFactorScene& view, const PatchMesh& mesh);

}  // namespace lightwell
