#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_tree.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// A mesh made of RefinedElements, and what its parts are there.
struct RefinedMesh {
  PatchMesh mesh{};
  std::vector<int> cell{};    ///< per element; -1 on spheres
  std::vector<int> vertex{};  ///< per vertex, its number in RefinedElements
  std::shared_ptr<const ElementTree> tree{};
};

/// Elements of a base mesh, split where asked for: a tree over each. *Cells* are the elements and
/// what they are split into, four alike each time (quadrilaterals along the lines between the
/// middles of opposite edges); both sides of a sheet are one cell. Across an edge, of whatever
/// facet and surface, cells that are not split differ by one level at most; where they differ the
/// coarser is closed by triangles and quadrilaterals (see closure_pieces) that are not cells and
/// are never split. So the meshes conform as the base does, and patches, facets and areas stay what
/// they are.
///
/// Vertices in the middle of an edge are shared as its ends are: not across contact lines; but
/// along edges that lead to a reflex corner, where only the corner's own are several. Numbers of
/// cells and vertices stay valid whatever is split and merged: what was found out for one can be
/// kept. Those of the base mesh's vertices are the base's own.
///
/// No angle is less than a third of the least that the base's triangles have, and the triangles
/// into which diagonals cut its parallelograms (Rosenberg & Stenger 1975 for halved triangles; a
/// triangle with two angles a is halved into a third of a at worst). Elements of spheres stay what
/// they are.
///
/// Keeps a reference to the base; a copy is a refinement of its own.
class RefinedElements {
 public:
  explicit RefinedElements(const PatchMesh& base);
  explicit RefinedElements(PatchMesh&& base) = delete;

  const PatchMesh& base() const { return *base_; }
  /// That are not split and not on spheres, in the base's order.
  std::vector<int> leaves() const;
  int level(int cell) const { return cells_[cell].level; }
  /// What was split into this cell; -1 for an element of the base.
  int parent(int cell) const { return cells_[cell].parent; }
  bool is_split(int cell) const { return cells_[cell].is_split; }
  int corner_count(int cell) const { return cells_[cell].corner_count; }
  int side_count(int cell) const { return cells_[cell].side_count; }
  /// Sides of all cells, those of a cell in a row: 0, 1, ... side_total() - 1.
  int side_number(int cell, int side) const { return cells_[cell].first_side + side; }
  int side_total() const { return static_cast<int>(sides_.size()); }
  /// The base's element on a side of the cell (0: front).
  int element(int cell, int side) const;
  double area(int cell) const;  ///< m^2, one side
  int cell_count() const { return static_cast<int>(cells_.size()); }
  /// The first of the four it was split into, which are numbered in a row.
  int first_child(int cell) const { return cells_[cell].first_child; }

  /// Splits leaves, and coarser neighbours as balance demands; what is split already is left out.
  /// Returns all that were split, in an order whose reverse undoes it in merge().
  std::vector<int> split(std::span<const int> cells);
  /// Undoes the split of each cell that has only leaves below, where balance allows it. Returns how
  /// many were.
  int merge(std::span<const int> cells);

  /// Of mesh(), both sides, without making it.
  std::int64_t element_count() const;
  RefinedMesh mesh();
  /// Gives back memory for what was expected to be split further.
  void shrink_to_fit();

  /// Numbers of vertices, by corner, edge (from corner i to the next), or in the middle. The latter
  /// two are made when first asked for; they are in mesh() only once something is split there.
  int corner_vertex(int cell, int side, int corner) const {
    return side_of(cell, side).vertex[corner];
  }
  int edge_vertex(int cell, int side, int edge);
  int center_vertex(int cell, int side);

  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  Eigen::Vector3d position(int vertex) const { return vertices_[vertex].position; }
  /// The vertices that this one was made half-way between (2 or 4, the rest -1): lower numbers.
  /// None for the base's own.
  std::array<int, 4> ends(int vertex) const;
  /// A place next to a vertex, `inset` of the way to the middle of a base element that has it, and
  /// that element and its normal; on spheres the vertex itself.
  PatchPoint inside(int vertex, double inset) const;

 private:
  // There are as many as elements, or several times as many: what one could do without is derived.
  struct Vertex {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    int element = -1;  // of the base
    // The ends of the edge that it is the middle of; or a side's number, from -2 downwards, whose
    // centre it is; or none.
    int from = -1, to = -1;
    int next_middle = -1;  // of that edge, on other sides and sheets
  };
  struct Edge {
    int first_half = -1;  // two in a row, from its start and from its end to the middle
    int parent = -1;
    int splits = 0;         // split cells that it bounds
    int first_user = -1;    // 4 cell + corner, and so on by Cell::next_user
    int first_middle = -1;  // vertex, and so on by Vertex::next_middle
  };
  struct Side {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    int center = -1;
  };
  struct Cell {
    int base = 0, parent = -1, first_child = -1, first_side = -1;
    // The number of sides itself: loops to a bit's `? 2 : 1` GCC 12.2 (-O3) ran past the end of.
    std::int8_t level = 0, corner_count = 4, side_count = 1;
    bool is_split : 1 = false, is_active : 1 = true;
    unsigned char backwards : 4 = 0;  // bit i: edge i goes from corner i + 1 to corner i
    std::array<int, 4> edge{-1, -1, -1, -1}, next_user{-1, -1, -1, -1};
  };

  void add_base_cells(const std::vector<int>& places);
  void find_reflex_corners(const std::vector<int>& places);
  const Side& side_of(int cell, int side) const { return sides_[side_number(cell, side)]; }
  Side& side_of(int cell, int side) { return sides_[side_number(cell, side)]; }
  int add_cell(const Cell& cell);
  struct EdgeUse {
    int edge = -1;
    bool is_backwards = false;  // from its end to its start
  };
  void set_edge(int cell, int corner, EdgeUse use);
  EdgeUse half(int cell, int edge, int end) const;
  int add_edge();
  void split_edge(int edge);
  void make_children(int cell);
  void split_alone(int cell);
  bool may_merge(const Cell& cell) const;
  unsigned split_edges(const Cell& cell) const;
  int add_vertex(const Vertex& vertex);
  template <class Visit>
  void for_each_leaf(int root, Visit&& visit) const;
  ElementTree tree(std::vector<int> first_element) const;
  std::array<int, 4> piece_vertices(int cell, int side, const std::array<int, 4>& piece);

  const PatchMesh* base_;
  std::vector<Vertex> vertices_;
  std::vector<int> reflex_;  // per base vertex, the lowest vertex of its reflex corner, or itself
  std::vector<Edge> edges_;
  std::vector<Cell> cells_;
  std::vector<Side> sides_;
  std::vector<int> cell_of_;  // per base element, fronts only; else -1
};

}  // namespace lightwell
