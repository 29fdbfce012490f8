#pragma once

#include <Eigen/Core>
#include <array>

#include "mesh/patches/patch_mesh.h"
#include "scene/facet_textures.h"

namespace lightwell {

/// Most points per direction of an element at which its pictures are read.
inline constexpr int most_texture_points = 16;

/// A piece of an element under the bilinear map of the unit square.
struct TextureCell {
  Eigen::Vector3d middle;             ///< m
  Eigen::Matrix<double, 3, 2> sides;  ///< m
  double area = 0.0;                  ///< m^2
};

/// Corners of an element; a triangle repeats its last corner.
std::array<Eigen::Vector3d, 4> corners_of(const PatchMesh& mesh, int element);

/// Cell (i, j) of points x points cells.
TextureCell texture_cell(const std::array<Eigen::Vector3d, 4>& corner, int points, int i, int j);

/// Points per direction of an element, as fine as the texels, from 4 to most_texture_points.
int points_across(const FacetTextures& textures, int facet,
                  const std::array<Eigen::Vector3d, 4>& corner);

/// Sides of the parallelogram over which the picture is filtered about the middle of a cell. The
/// filter itself reaches half a cell farther, so that texels beside the element stay out.
Eigen::Matrix<double, 3, 2> filter_of(const TextureCell& cell);

}  // namespace lightwell
