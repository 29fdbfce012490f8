#include "scene/rays/cell_sheets.h"

#include <algorithm>
#include <span>
#include <utility>

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Finds the cell that begins at the edge where another cell ends.
class Neighbours {
 public:
  // `from`, `to`: the two corners of each quad that bound its edge.
  Neighbours(const CastGeometry& geometry, std::span<const int> quads, int from, int to) {
    for (const int q : quads) {
      const auto& c = geometry.quads[static_cast<std::size_t>(q)];
      edges_.push_back({{c[from], c[to]}, q});
    }
    std::ranges::sort(edges_);
  }

  // Returns the quad with that edge, -1 if there is none.
  int at(int from, int to) const {
    const std::array<int, 2> edge{from, to};
    const auto found = std::ranges::lower_bound(edges_, edge, {}, &Edge::first);
    return found != edges_.end() && found->first == edge ? found->second : -1;
  }

 private:
  using Edge = std::pair<std::array<int, 2>, int>;
  std::vector<Edge> edges_{};
};

class Joining {
 public:
  Joining(const CastGeometry& geometry, std::span<const int> quads, double longest, double margin)
      : geometry_(geometry),
        longest_(longest),
        margin_(margin),
        quads_(quads),
        lefts_(geometry, quads, 0, 3),
        rights_(geometry, quads, 1, 2),
        lows_(geometry, quads, 0, 1),
        highs_(geometry, quads, 3, 2),
        is_joined_(geometry.quads.size(), 0) {}

  CellSheets join() {
    CellSheets result;
    for (const int q : quads_) {
      while (is_joined_[static_cast<std::size_t>(q)] == 0) add_sheet(first_cell(q), result);
    }
    return result;
  }

 private:
  const std::array<int, 4>& corners(int q) const {
    return geometry_.quads[static_cast<std::size_t>(q)];
  }
  const Vector3d& position(int q, int corner) const {
    return geometry_
        .vertices[static_cast<std::size_t>(corners(q)[static_cast<std::size_t>(corner)])];
  }
  int group(int q) const {
    return geometry_.group[geometry_.triangles.size() + static_cast<std::size_t>(q)];
  }

  int right_of(int q) const { return lefts_.at(corners(q)[1], corners(q)[2]); }
  int left_of(int q) const { return rights_.at(corners(q)[0], corners(q)[3]); }
  int above(int q) const { return lows_.at(corners(q)[3], corners(q)[2]); }
  int below(int q) const { return highs_.at(corners(q)[0], corners(q)[1]); }

  // True if cell `q` stands in a column and row of the lattice that the cell `origin` begins.
  bool is_in_lattice(int q, int origin, int column, int row) const {
    if (q < 0 || is_joined_[static_cast<std::size_t>(q)] != 0 || group(q) != group(origin)) {
      return false;
    }
    constexpr double tolerance = 1e-6;
    const Vector3d &begin = position(origin, 0), along = position(origin, 1) - begin,
                   up = position(origin, 3) - begin;
    const double nearest = tolerance * std::min(along.norm(), up.norm());
    if (!(nearest > 0.0)) return false;
    constexpr std::array<std::array<int, 2>, 4> corner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int c = 0; c < 4; ++c) {
      const Vector3d even = begin + (column + corner[c][0]) * along + (row + corner[c][1]) * up;
      if (!((position(q, c) - even).norm() <= nearest)) return false;
    }
    return true;
  }

  // First cell of the rows and columns through `q`: as far back as cells continue evenly.
  int first_cell(int q) const {
    const auto go_back = [&](const auto& before, bool along_row) {
      const int column = along_row ? 1 : 0, row = along_row ? 0 : 1;
      for (int next = before(q);
           is_in_lattice(next, next, 0, 0) && is_in_lattice(q, next, column, row);
           next = before(q)) {
        q = next;
      }
    };
    go_back([&](int of) { return left_of(of); }, true);
    go_back([&](int of) { return below(of); }, false);
    return q;
  }

  // Most cells of a sheet along the edge of `q` from corner 0 to `corner`.
  int most(int q, int corner) const {
    const double times = longest_ / (position(q, corner) - position(q, 0)).norm();
    return static_cast<int>(std::min(times, static_cast<double>(quads_.size())));
  }

  void add_sheet(int origin, CellSheets& result) {
    std::vector<int> cells{origin};
    if (!is_in_lattice(origin, origin, 0, 0)) {  // no parallelogram, or without width
      is_joined_[static_cast<std::size_t>(origin)] = 1;
      result.single.push_back(origin);
      return;
    }
    const int most_columns = most(origin, 1), most_rows = most(origin, 3);
    for (int next = right_of(origin);
         static_cast<int>(cells.size()) < most_columns &&
         is_in_lattice(next, origin, static_cast<int>(cells.size()), 0);
         next = right_of(next)) {
      cells.push_back(next);
    }
    const auto columns = static_cast<int>(cells.size());
    int rows = 1;
    for (bool is_whole = true; is_whole && rows < most_rows; rows += is_whole ? 1 : 0) {
      const std::size_t last = cells.size() - static_cast<std::size_t>(columns);
      for (int column = 0; column < columns && is_whole; ++column) {
        const int next = above(cells[last + static_cast<std::size_t>(column)]);
        is_whole = is_in_lattice(next, origin, column, rows);
        if (is_whole) cells.push_back(next);
      }
      if (!is_whole) cells.resize(last + static_cast<std::size_t>(columns));
    }
    for (const int q : cells) is_joined_[static_cast<std::size_t>(q)] = 1;
    if (cells.size() == 1) {
      result.single.push_back(origin);
      return;
    }
    const auto at = [&](int column, int row, int corner) -> const Vector3d& {
      return position(cells[static_cast<std::size_t>(row * columns + column)], corner);
    };
    const Vector3d along = position(origin, 1) - position(origin, 0),
                   up = position(origin, 3) - position(origin, 0);
    const double of_column = margin_ / along.norm(), of_row = margin_ / up.norm();
    const Vector3d aside = of_column * along, over = of_row * up;
    result.sheets.push_back(
        {.corners = {at(0, 0, 0) - aside - over, at(columns - 1, 0, 1) + aside - over,
                     at(columns - 1, rows - 1, 2) + aside + over,
                     at(0, rows - 1, 3) - aside + over},
         .columns = columns,
         .rows = rows,
         .column_margin = static_cast<float>(of_column),
         .row_margin = static_cast<float>(of_row),
         .first = static_cast<int>(result.cells.size())});
    result.cells.insert(result.cells.end(), cells.begin(), cells.end());
  }

  const CastGeometry& geometry_;
  double longest_, margin_;
  std::span<const int> quads_;
  Neighbours lefts_, rights_, lows_, highs_;  // cells by their left, right, low and high edges
  std::vector<char> is_joined_;
};

}  // namespace

CellSheets::CellPoint CellSheets::cell_point(const CellSheet& sheet, float u, float v) const {
  const auto cells_on = [](float share, int count, float margin) {
    return share * (static_cast<float>(count) + 2.0f * margin) - margin;
  };
  const float across = cells_on(u, sheet.columns, sheet.column_margin),
              up = cells_on(v, sheet.rows, sheet.row_margin);
  const int column = std::clamp(static_cast<int>(across), 0, sheet.columns - 1);
  const int row = std::clamp(static_cast<int>(up), 0, sheet.rows - 1);
  return {.quad = cells[static_cast<std::size_t>(sheet.first + row * sheet.columns + column)],
          .u = std::clamp(across - static_cast<float>(column), 0.0f, 1.0f),
          .v = std::clamp(up - static_cast<float>(row), 0.0f, 1.0f)};
}

CellSheets join_cells(const CastGeometry& geometry, double longest, double margin,
                      const std::function<bool(int quad)>& may_join) {
  std::vector<int> candidates, others;
  for (int q = 0; q < static_cast<int>(geometry.quads.size()); ++q) {
    (may_join(q) ? candidates : others).push_back(q);
  }
  CellSheets result = Joining(geometry, candidates, longest, margin).join();
  result.single.insert(result.single.end(), others.begin(), others.end());
  std::ranges::sort(result.single);
  return result;
}

}  // namespace lightwell
