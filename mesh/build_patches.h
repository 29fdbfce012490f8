#pragma once

#include "mesh/patches/patch_mesh.h"
#include "scene/progress.h"

namespace lightwell {

struct CutSize;

/// Sizes and borders of patches and elements.
struct MeshOptions {
  /// Longest patch edge, metres. 0: chosen so that the diffuse surfaces make about
  /// `auto_patch_count` patches, or up to 2.5 times as many in a scene with much area in little
  /// space: of 1600 patches, no edge is longer than a quarter of the mean free path, 4 V / A with
  /// the volume V of the scene's box and the area A within. In a scene with surroundings, such as a
  /// ground of kilometres, this size is that of what is near, and the surroundings' patches grow
  /// with the distance from there.
  double max_patch_size = 0.0;
  int auto_patch_count = 1600;
  /// Elements along a patch edge, 1 to 1000. A larger number follows shadows more closely, at
  /// quadratic cost.
  int elements_per_patch_edge = 2;
  /// Longest element edge, metres; replaces `elements_per_patch_edge` unless 0. With
  /// `max_patch_size` 0, patches are then two elements long, or longer where there would be more
  /// than `most_patches`: the solver's work grows with the patches, the rest with the elements
  /// alone.
  double max_element_size = 0.0;
  int most_patches = 6400;
  /// True: elements of polygons are twice as long, since refinement will split those that matter
  /// (odd numbers per patch edge are rounded up). Elements of round shapes are never split: they
  /// keep their size, and those of few spheres span 22.5 degrees at most.
  bool to_be_refined = false;
  /// True: receivers are cut along the critical lines of emitters, those of greatest weight first:
  /// D1, and D2 where the penumbra is not much wider than the elements.
  bool discontinuity = false;
  /// Limit on the elements that `discontinuity` adds, as a share of those without; PatchMesh::notes
  /// reports what was left out.
  double discontinuity_growth = 1.0;
  /// Facets of one surface that meet at a smaller angle share vertices.
  double smooth_angle_degrees = 5.0;
  /// Facets of one surface smaller than a patch share a patch as long as their normals stay within
  /// this angle of the patch's mean. 0: no patch reaches over several facets.
  double curve_angle_degrees = 20.0;
};

/// Cuts the scene into patches and elements. Touching, intersecting and coplanar surfaces are cut
/// along their contact lines first, so no element straddles one; parts of a facet that are covered
/// by another surface lying on the facet become elements of their own. With `discontinuity`, no
/// element straddles an important bound of a shadow.
///
/// A polygon that crosses itself is meshed as convex pieces, but without the lines where others
/// touch it; emitters should be cut before (see merge_planar_regions()). A polygon without area is
/// left out. PatchMesh::notes counts both.
///
/// Throws InputError for a scene without surfaces, for options out of range, and for sizes that
/// would make more than 20 million elements.
PatchMesh build_patches(const Scene& scene, const MeshOptions& options = {},
                        const Progress& progress = {});

/// The sizes that build_patches() uses, `to_be_refined` left aside: those of the options, or those
/// chosen in their place. Throws InputError for a scene without surfaces and for options out of
/// range.
CutSize cut_size(const Scene& scene, const MeshOptions& options);

}  // namespace lightwell
