#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// What a surface shows, as graphics hardware and model files have it.
struct DrawnPicture {
  int width = 0, height = 0;
  /// Rows from the top, 4 bytes a texel: sRGB of rho over `brightest`, and 0 in holes, else 255.
  std::vector<std::uint8_t> rgba{};
  Eigen::Array3f brightest = Eigen::Array3f::Ones();  ///< rho of a white texel, > 0
  bool has_holes = false;
  bool is_smooth = true;  ///< texels are blended; else flat squares
  std::array<TextureWrap, 2> wrap = {TextureWrap::repeat, TextureWrap::repeat};
};

/// The pictures of a scene's materials, its textures with its masks as their alpha, and where they
/// lie on its facets. Numbers facets as scene_facets does. Scenes of bands other than RGB, and
/// materials that emit light, have none.
class DrawnPictures {
 public:
  /// Pictures wider or higher than `longest` texels are halved until they are not.
  DrawnPictures(const Scene& scene, int longest);

  const std::vector<DrawnPicture>& all() const { return pictures_; }
  /// On a facet, an index into all(); -1: none, or a facet the scene does not have.
  int of(int facet) const;
  /// The same for facets over which the picture goes on alike, of those that have one.
  int map_of(int facet) const { return facet_map_[static_cast<std::size_t>(facet)]; }
  /// Place in the picture of a point on a facet that has one: (0, 0) is the top left corner, (1, 1)
  /// the bottom right one.
  Eigen::Vector2f place(int facet, const Eigen::Vector3d& point) const;

 private:
  struct Map {
    int picture = 0;
    Eigen::Matrix<double, 2, 3> gradient = Eigen::Matrix<double, 2, 3>::Zero();
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  };
  std::vector<DrawnPicture> pictures_{};
  std::vector<Map> maps_{};
  std::vector<int> facet_map_{};  // -1: none; empty: nowhere
};

/// Factor from what a vertex shows on the whole, with the mean of its pictures, to what a white
/// texel shows there; vertices x 3, 1 where there is no picture.
Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor> picture_gains(const PatchMesh& mesh,
                                                                      const DrawnPictures& drawn);

}  // namespace lightwell
