#pragma once

#include <array>
#include <functional>
#include <vector>

#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Rows and columns of equal parallelograms that fill a larger one, as meshing leaves them on
/// walls: rays need but look for the whole, and where they meet it says which cell that is.
struct CellSheet {
  std::array<Eigen::Vector3d, 4> corners{};       ///< in the order of the cells' own
  int columns = 1, rows = 1;                      ///< along corners 0 to 1, and 0 to 3
  float column_margin = 0.0f, row_margin = 0.0f;  ///< past the cells on each side, in cells
  int first = 0;                                  ///< of its cells in CellSheets::cells, row by row
};

struct CellSheets {
  std::vector<CellSheet> sheets{};
  std::vector<int> cells{};   ///< numbers of quads
  std::vector<int> single{};  ///< quads of no sheet

  struct CellPoint {
    int quad = -1;
    float u = 0.0f, v = 0.0f;  ///< as Hit has them
  };
  /// At (u, v) of a sheet, each in [0, 1].
  CellPoint cell_point(const CellSheet& sheet, float u, float v) const;
};

/// Joins quads of a group where `may_join` allows; each of a geometry's quads is in one sheet of
/// two or more, or single. Cells differ from even ones by less than a millionth of their edges.
/// No sheet is longer than `longest`, metres, either way: boxes around large ones that lie askew
/// would be full of nothing. Sheets reach past their cells by `margin`, metres: beside them may lie
/// smaller ones, and along an edge that is one's whole and another's part rays would slip through
/// where rounding bends it.
CellSheets join_cells(const CastGeometry& geometry, double longest, double margin,
                      const std::function<bool(int quad)>& may_join);

}  // namespace lightwell
