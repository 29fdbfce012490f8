#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// Pictures of a scene's materials, textures with masks as alpha, and their placement on facets.
/// Facets are numbered as by scene_facets. Scenes of bands other than RGB and materials that emit
/// light evenly have no pictures.
class DrawnPictures {
 public:
  /// Halves pictures until neither side exceeds `longest` texels, or no coarser level is left.
  DrawnPictures(const Scene& scene, int longest);

  const std::vector<DrawnPicture>& all() const { return pictures_; }
  /// Picture of a facet, an index into all(); -1: no picture, or no facet of the scene.
  int of(int facet) const;
  /// Texture map of a facet, equal for facets with the same map. Only in scenes with pictures; -1:
  /// none.
  int map_of(int facet) const { return facet_map_[static_cast<std::size_t>(facet)]; }
  /// Picture coordinates of a point on a facet with a picture: (0, 0) is the top left corner,
  /// (1, 1) the bottom right one.
  Eigen::Vector2f place(int facet, const Eigen::Vector3d& point) const;

 private:
  struct Map {
    int picture = 0;
    Eigen::Matrix<double, 2, 3> gradient = Eigen::Matrix<double, 2, 3>::Zero();
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  };
  std::vector<DrawnPicture> pictures_{};
  std::vector<Map> maps_{};
  std::vector<int> facet_map_{};  // index into maps_; -1: none; empty: no facet has a picture
};

/// Factor from the radiance of a vertex, with the mean reflectance of its pictures, to that of a
/// white texel: brightest / rho, vertices x 3; 1 without a picture. Of a picture of emission,
/// brightest / M, where M is the mean over the facet, as shown_radiance() has it.
Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor> picture_gains(const PatchMesh& mesh,
                                                                      const DrawnPictures& drawn);

}  // namespace lightwell
