#pragma once

#include <array>
#include <span>

namespace lightwell {

/// A piece of an element by its nodes, counter-clockwise as the element: 0 to 3 are the element's
/// corners, 4 + i is the middle of its edge from corner i to the next, 8 its centre. [3] is -1 for
/// a triangle.
using ElementPiece = std::array<int, 4>;

constexpr int middle_node = 4, center_node = 8;

/// The pieces of an element that has vertices in the middle of some of its edges (bit i of
/// `split_edges`: of edge i), without any other vertex on its boundary: one if there are none; four
/// alike, piece i at corner i, if there are on all ("red"); else what closes the mesh ("green";
/// Bank, Sherman & Weiser 1983, "Refinement algorithms and data structures for regular local mesh
/// refinement", for triangles).
std::span<const ElementPiece> closure_pieces(int corner_count, unsigned split_edges);

}  // namespace lightwell
