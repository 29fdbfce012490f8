#pragma once

#include <array>
#include <functional>
#include <vector>

#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Rows and columns of equal parallelograms that fill a larger one, as meshing leaves on walls.
/// Rays are cast at the whole sheet, and the point where a ray meets the sheet gives the cell.
struct CellSheet {
  std::array<Eigen::Vector3d, 4> corners{};       ///< in the order of a cell's corners
  int columns = 1, rows = 1;                      ///< along corners 0 to 1, and 0 to 3
  float column_margin = 0.0f, row_margin = 0.0f;  ///< reach past the cells on each side, in cells
  int first = 0;  ///< index into CellSheets::cells; cells follow row by row
};

struct CellSheets {
  std::vector<CellSheet> sheets{};
  std::vector<int> cells{};   ///< indices of quads
  std::vector<int> single{};  ///< quads of no sheet

  struct CellPoint {
    int quad = -1;
    float u = 0.0f, v = 0.0f;  ///< as in Hit
  };
  /// Cell at (u, v) of a sheet, each in [0, 1].
  CellPoint cell_point(const CellSheet& sheet, float u, float v) const;
};

/// Joins quads of a group where `may_join` allows. Each quad of the geometry is then either in one
/// sheet of two or more cells, or single. Cells of a sheet differ from equal ones by less than a
/// millionth of their edges.
///
/// `longest`: largest length and width of a sheet, metres. Boxes around larger sheets that lie
/// askew would be nearly empty.
///
/// `margin`: reach of a sheet past its cells, metres. A sheet may have smaller neighbours; along an
/// edge that is whole on one side and divided on the other, rays would slip through where rounding
/// bends the edge.
CellSheets join_cells(const CastGeometry& geometry, double longest, double margin,
                      const std::function<bool(int quad)>& may_join);

}  // namespace lightwell
