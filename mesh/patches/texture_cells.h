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

/// Numbers of cells of an element from corner 0 towards corner 1, and from there towards corner 2.
struct CellGrid {
  int along = 0, across = 0;
};

inline constexpr CellGrid finest_cells{.along = most_texture_points, .across = most_texture_points};

/// Corners of an element. A triangle starts with its shortest edge, and repeats its last corner.
std::array<Eigen::Vector3d, 4> corners_of(const PatchMesh& mesh, int element);

/// Cell (i, j) of grid.along x grid.across cells.
TextureCell texture_cell(const std::array<Eigen::Vector3d, 4>& corner, const CellGrid& grid, int i,
                         int j);

/// Cells of an element as fine as the texels, from 4 to most_texture_points in each direction.
CellGrid cells_over(const FacetTextures& textures, int facet,
                    const std::array<Eigen::Vector3d, 4>& corner);

/// Sides of the parallelogram over which the picture is filtered about the middle of a cell. The
/// filter itself reaches half a cell farther, so that texels beside the element stay out.
Eigen::Matrix<double, 3, 2> filter_of(const TextureCell& cell);

}  // namespace lightwell
