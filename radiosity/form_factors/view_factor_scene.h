#pragma once

#include <vector>

#include "mesh/cleaning/facet_check.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {

/// What view factors are computed from: the polygons of a file as shapes alone, every one diffuse,
/// opaque and without light, and which row each of their sides belongs to.
struct ViewFactorScene {
  Scene scene{};                 ///< one band; one surface for each facet
  std::vector<int> front_row{};  ///< by facet; -1: none
  std::vector<int> back_row{};   ///< the same for the backs; -1: none, or there is no back
  int row_count = 0;
};

/// Facets see with their fronts. With `two_sided` their backs have rows too: row n + i is the back
/// of row i of n. Of facets that lie on each other the first stands for all: a second that faces
/// the same way is left out, for nothing could tell the two apart, and one that faces the other
/// way becomes the first one's back, which keeps rays from having to choose between the two.
/// Facets without a row block light from both sides.
ViewFactorScene make_view_factor_scene(const NumberedScene& numbered, const FacetCheck& check,
                                       bool two_sided);

/// The row of every patch of a mesh of `view.scene`; -1: none.
std::vector<int> rows_of_patches(const ViewFactorScene& view, const PatchMesh& mesh);

}  // namespace lightwell
