#include "mesh/elements/closure_pieces.h"

#include <algorithm>
#include <vector>

namespace lightwell {
namespace {

using Pieces = std::vector<ElementPiece>;

// Turns a pattern so that its edge 0 becomes edge `first`.
Pieces turned_pieces(Pieces pieces, int first, int corner_count) {
  for (ElementPiece& piece : pieces) {
    for (int& node : piece) {
      if (node < 0 || node == center_node) continue;
      const int base = node < middle_node ? 0 : middle_node;
      node = base + (node - base + first) % corner_count;
    }
  }
  return pieces;
}

// The pattern whose split edges begin at edge 0; empty if there is none.
Pieces pattern(int corner_count, unsigned split_edges) {
  if (corner_count == 3) {
    switch (split_edges) {
      case 0b000:
        return {{0, 1, 2, -1}};
      case 0b001:
        return {{0, 4, 2, -1}, {4, 1, 2, -1}};
      case 0b011:
        return {{4, 1, 5, -1}, {0, 4, 5, 2}};
      case 0b111:
        return {{0, 4, 6, -1}, {4, 1, 5, -1}, {6, 5, 2, -1}, {4, 5, 6, -1}};
      default:
        return {};
    }
  }
  switch (split_edges) {
    case 0b0000:
      return {{0, 1, 2, 3}};
    case 0b0001:
      return {{4, 1, 2, -1}, {4, 2, 3, -1}, {4, 3, 0, -1}};
    case 0b0011:
      return {{4, 1, 5, 8}, {0, 4, 8, 3}, {8, 5, 2, 3}};
    case 0b0101:
      return {{0, 4, 6, 3}, {4, 1, 2, 6}};
    case 0b0111:
      return {{0, 4, 6, 3}, {4, 1, 5, -1}, {5, 2, 6, -1}, {4, 5, 6, -1}};
    // Corners keep their numbers, so that all cells of a refined grid have one direction.
    case 0b1111:
      return {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
    default:
      return {};
  }
}

struct Table {
  std::array<Pieces, 8> of_triangle{};
  std::array<Pieces, 16> of_quad{};

  Table() {
    for (unsigned edges = 0; edges < 8; ++edges) of_triangle[edges] = find(3, edges);
    for (unsigned edges = 0; edges < 16; ++edges) of_quad[edges] = find(4, edges);
  }

  static Pieces find(int corner_count, unsigned split_edges) {
    const unsigned all = (1U << corner_count) - 1;
    for (int first = 0; first < corner_count; ++first) {
      const unsigned from_first =
          ((split_edges >> first) | (split_edges << (corner_count - first))) & all;
      Pieces pieces = pattern(corner_count, from_first);
      if (!pieces.empty()) return turned_pieces(std::move(pieces), first, corner_count);
    }
    return {};
  }
};

}  // namespace

std::span<const ElementPiece> closure_pieces(int corner_count, unsigned split_edges) {
  static const Table table;
  return corner_count == 3 ? table.of_triangle[split_edges] : table.of_quad[split_edges];
}

}  // namespace lightwell
