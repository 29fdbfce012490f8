#pragma once

#include <array>
#include <span>

namespace lightwell {

/// A piece of an element by its nodes, in the element's direction (counter-clockwise). Nodes 0 to 3
/// are the element's corners, 4 + i is the middle of the edge from corner i to the next, 8 the
/// centre. [3] is -1 for a triangle.
using ElementPiece = std::array<int, 4>;

constexpr int middle_node = 4, center_node = 8;

/// The pieces of an element with vertices in the middle of some of its edges (bit i of
/// `split_edges`: edge i) and no other vertices on its boundary:
/// - without split edges, the element itself;
/// - with all edges split, four similar pieces, piece i at corner i ("red");
/// - otherwise the pieces that close the mesh ("green"; Bank, Sherman & Weiser 1983, "Refinement
///   algorithms and data structures for regular local mesh refinement", for triangles).
std::span<const ElementPiece> closure_pieces(int corner_count, unsigned split_edges);

}  // namespace lightwell
