// The part of RefinedElements that splits and merges cells.
#include <utility>

#include "mesh/elements/closure_pieces.h"
#include "mesh/elements/refine_elements.h"

namespace lightwell {

int RefinedElements::add_edge() {
  edges_.emplace_back();
  return static_cast<int>(edges_.size()) - 1;
}

int RefinedElements::add_cell(const Cell& cell) {
  const int number = static_cast<int>(cells_.size());
  cells_.push_back(cell);
  cells_.back().first_side = side_total();
  sides_.resize(sides_.size() + static_cast<std::size_t>(side_count(number)));
  return number;
}

void RefinedElements::set_edge(int number, int corner, EdgeUse use) {
  Cell& cell = cells_[number];
  Edge& edge = edges_[use.edge];
  cell.edge[corner] = use.edge;
  if (use.is_backwards) cell.backwards |= static_cast<unsigned char>(1U << corner);
  cell.next_user[corner] = edge.first_user;
  edge.first_user = 4 * number + corner;
}

void RefinedElements::split_edge(int number) {
  if (edges_[number].first_half >= 0) return;
  const int first = add_edge();
  add_edge();
  edges_[number].first_half = first;
  edges_[first].parent = edges_[first + 1].parent = number;
}

// The half of an edge of a cell from the corner `end` to the middle.
RefinedElements::EdgeUse RefinedElements::half(int number, int edge, int end) const {
  const Cell& cell = cells_[number];
  const bool is_backwards = (cell.backwards >> edge & 1) != 0;
  const bool is_first = (end == edge) != is_backwards;
  return {edges_[cell.edge[edge]].first_half + (is_first ? 0 : 1)};
}

void RefinedElements::make_children(int number) {
  const Cell parent = cells_[number];
  const int n = parent.corner_count;
  for (int i = 0; i < n; ++i) split_edge(parent.edge[i]);
  std::array<std::array<int, 9>, 2> vertex{};  // per side and node of closure_pieces
  for (int side = 0; side < side_count(number); ++side) {
    for (int i = 0; i < n; ++i) {
      vertex[side][i] = corner_vertex(number, side, i);
      vertex[side][middle_node + i] = edge_vertex(number, side, i);
    }
    if (n == 4) vertex[side][center_node] = center_vertex(number, side);
  }
  // The inner edges: between middles in a triangle, from each middle to the centre in a
  // quadrilateral.
  std::array<int, 4> inner{-1, -1, -1, -1};
  for (int i = 0; i < n; ++i) inner[i] = add_edge();
  const auto edge_between = [&](int a, int b) -> EdgeUse {
    if (a < middle_node) return half(number, b - middle_node, a);
    if (b < middle_node) return {half(number, a - middle_node, b).edge, true};
    if (n == 4) return {inner[std::min(a, b) - middle_node], a > b};
    const int i = a - middle_node, k = b - middle_node;
    return (i + 1) % n == k ? EdgeUse{inner[i]} : EdgeUse{inner[k], true};
  };
  cells_[number].first_child = static_cast<int>(cells_.size());
  for (const ElementPiece& piece : closure_pieces(n, (1U << n) - 1)) {
    const int child = add_cell({.base = parent.base,
                                .parent = number,
                                .level = static_cast<std::int8_t>(parent.level + 1),
                                .corner_count = parent.corner_count,
                                .side_count = parent.side_count,
                                .is_active = false});
    for (int i = 0; i < n; ++i) {
      for (int side = 0; side < side_count(child); ++side) {
        side_of(child, side).vertex[i] = vertex[side][piece[i]];
      }
      set_edge(child, i, edge_between(piece[i], piece[(i + 1) % n]));
    }
  }
}

void RefinedElements::split_alone(int number) {
  if (cells_[number].first_child < 0) make_children(number);
  Cell& cell = cells_[number];
  cell.is_split = true;
  for (int i = 0; i < cell.corner_count; ++i) ++edges_[cell.edge[i]].splits;
  for (int i = 0; i < 4; ++i) cells_[cell.first_child + i].is_active = true;
}

std::vector<int> RefinedElements::split(std::span<const int> cells) {
  std::vector<int> open, done;
  for (const int marked : cells) {
    open.push_back(marked);
    while (!open.empty()) {
      const int number = open.back();
      const Cell& cell = cells_[number];
      if (cell.is_split || !cell.is_active) {
        open.pop_back();
        continue;
      }
      // A leaf along the whole of an edge of which this cell has a half would get two vertices
      // there, so the leaf is split first.
      const std::size_t before = open.size();
      for (int i = 0; i < cell.corner_count; ++i) {
        const int whole = edges_[cell.edge[i]].parent;
        if (whole < 0) continue;
        for (int user = edges_[whole].first_user; user >= 0;
             user = cells_[user / 4].next_user[user % 4]) {
          const Cell& other = cells_[user / 4];
          if (other.is_active && !other.is_split) open.push_back(user / 4);
        }
      }
      if (open.size() > before) continue;
      open.pop_back();
      split_alone(number);
      done.push_back(number);
    }
  }
  return done;
}

bool RefinedElements::may_merge(const Cell& cell) const {
  if (!cell.is_split) return false;
  for (int i = 0; i < 4; ++i) {
    if (cells_[cell.first_child + i].is_split) return false;
  }
  for (int i = 0; i < cell.corner_count; ++i) {
    const Edge& edge = edges_[cell.edge[i]];
    for (int half = 0; half < 2; ++half) {
      if (edges_[edge.first_half + half].splits > 0) return false;
    }
  }
  return true;
}

int RefinedElements::merge(std::span<const int> cells) {
  int count = 0;
  for (const int number : cells) {
    Cell& cell = cells_[number];
    if (!may_merge(cell)) continue;
    cell.is_split = false;
    for (int i = 0; i < cell.corner_count; ++i) --edges_[cell.edge[i]].splits;
    for (int i = 0; i < 4; ++i) cells_[cell.first_child + i].is_active = false;
    ++count;
  }
  return count;
}

}  // namespace lightwell
