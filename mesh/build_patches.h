#pragma once

#include "mesh/geometry/cut_size.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/progress.h"

namespace lightwell {

struct MeshOptions {
  /// Longest patch edge, metres. 0: chosen so that the scene's diffuse surfaces make about
  /// `auto_patch_count` patches.
  double max_patch_size = 0.0;
  int auto_patch_count = 1600;
  /// Elements along a patch edge, >= 1. More follow shadows more closely at the square of the cost.
  int elements_per_patch_edge = 2;
  /// Longest element edge, metres. 0: what the two above say. Else it decides instead of
  /// `elements_per_patch_edge`, and unless `max_patch_size` says otherwise patches are two elements
  /// long, or longer where there would be more than `most_patches` of them: light between patches
  /// then takes a time of its own, and what is left grows with the elements alone.
  double max_element_size = 0.0;
  int most_patches = 6400;
  /// Elements of polygons are twice as long, since RefinedElements will split those that matter
  /// (odd numbers per patch edge are rounded up); those of spheres, which it does not split, are
  /// not.
  bool to_be_refined = false;
  /// Cut receivers along the critical lines of emitters, most important first: D1, and D2 where the
  /// penumbra is not much wider than the elements.
  bool discontinuity = false;
  /// Elements that may add, as a share of those there would be without: what is left out is said in
  /// PatchMesh::notes.
  double discontinuity_growth = 1.0;
  double smooth_angle_degrees = 5.0;  ///< facets of one surface that meet at less share vertices
  /// Facets of one surface smaller than a patch share one as long as their normals stay within this
  /// of its mean. 0: no patch reaches over several facets.
  double curve_angle_degrees = 20.0;
};

/// Cuts the scene into patches and elements. Coplanar touching and intersecting surfaces are cut
/// along their contact lines first, so no element straddles one, and with `discontinuity` no
/// element straddles an important bound of a shadow; parts of a facet that are covered
/// by another surface lying on it become elements of their own. Throws InputError for a scene
/// without surfaces, or when the sizes ask for more than 20 million elements.
PatchMesh build_patches(const Scene& scene, const MeshOptions& options = {},
                        const Progress& progress = {});

/// What build_patches uses, but for `to_be_refined`: what the options say, or what they leave to
/// it.
CutSize cut_size(const Scene& scene, const MeshOptions& options);

}  // namespace lightwell
