#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Exitance M within the facets that shine by a picture, W/m^2 per band, as relight() may have
/// scaled it: the picture times a factor for each facet. The factor keeps the power of
/// PatchMesh::emission. Keeps a reference to the mesh.
class PicturedEmission {
 public:
  explicit PicturedEmission(const PatchMesh& mesh);

  /// True if the side of the facet that the patch lies on shines by a picture.
  bool shines(int patch) const;
  /// M at `point` (metres) of a facet that shines, unfiltered.
  Spectrum at(int facet, const Eigen::Vector3d& point) const;
  /// Mean M about `point` over the parallelogram with sides `footprint` (columns, metres).
  Spectrum over(int facet, const Eigen::Vector3d& point,
                const Eigen::Matrix<double, 3, 2>& footprint) const;
  /// Mean M of an element on any facet.
  Spectrum of_element(int element) const;

 private:
  const PatchMesh* mesh_;
  const FacetTextures* textures_ = nullptr;  // null: no facet shines by a picture
  std::vector<int> scale_of_{};              // by facet; -1: no picture
  std::vector<Spectrum> scale_{};
};

/// Exitance at a point (metres) of an element, as PicturedEmission::at() has it, for few points.
Spectrum emission_at(const PatchMesh& mesh, int element, const Eigen::Vector3d& point);

/// Mean exitance of each facet over its patches that shine (facets of the mesh x bands), W/m^2; 0
/// for facets without any.
BandArray facet_emission(const PatchMesh& mesh);

/// Exitance at vertices (vertices x bands): where a picture shines, the mean of the elements around
/// the vertex, weighted by area; else that of the vertex's patch.
BandArray vertex_emission(const PatchMesh& mesh);

}  // namespace lightwell
