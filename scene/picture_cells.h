#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A facet cut into the cells of a grid along the texels of its picture. Cells are a power of two
/// of texels wide in either direction, so that the edges of texels are edges of cells where cells
/// are not larger.
struct PictureCells {
  /// Position in the grid, in cells from its corner: place * (p, 1), p in metres.
  Eigen::Matrix<double, 2, 4> place = Eigen::Matrix<double, 2, 4>::Zero();
  int columns = 1, rows = 1;
  std::vector<double> area{};           ///< of the facet within each cell, m^2, row by row
  std::vector<Eigen::Array3f> value{};  ///< mean of the picture over each cell

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Cells of a facet with texture coordinates `uv`, at most about `most_across` in each direction.
/// Coordinates that do not spread the picture over the facet's plane make a single cell.
PictureCells picture_cells(const SurfaceTexture& image, const UvMap& uv, const PolygonMesh& mesh,
                           const Facet& facet, int most_across);

/// `most_across` for each of many facets, so that all their cells together are a few million.
int cells_across(std::size_t facets);

/// Mean of the picture over the facet.
Eigen::Array3d mean_of(const PictureCells& cells);

/// Mean exitance of a surface's emitting sides, W/m^2: where a picture shines, its mean over the
/// facets.
Eigen::ArrayXd mean_exitance(const Scene& scene, const Surface& surface);

}  // namespace lightwell
