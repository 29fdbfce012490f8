#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_tree.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// A mesh made of RefinedElements, and the origin of its elements and vertices.
struct RefinedMesh {
  PatchMesh mesh{};
  std::vector<int> cell{};    ///< per element, its cell; -1 on round shapes
  std::vector<int> vertex{};  ///< per vertex, its number in RefinedElements
  std::shared_ptr<const ElementTree> tree{};
};

/// Adaptive refinement of the elements of a base mesh: a tree over each element.
///
/// *Cells* are the elements and what these are split into, four similar children each time;
/// quadrilaterals are split along the lines between the middles of opposite edges. The two sides of
/// a sheet are one cell. Across an edge, of whatever facet and surface, leaves differ by one level
/// at most. Where the levels differ, the coarser cell is closed by triangles and quadrilaterals
/// (see closure_pieces()) that are not cells and are never split. So the meshes conform as the base
/// does, and patches, facets and areas stay.
///
/// A vertex in the middle of an edge is shared as the edge's ends are: not across contact lines.
/// Along an edge to a reflex corner the middle is shared, and only the corner itself has several
/// vertices. Numbers of cells and vertices stay valid through splits and merges, so results for a
/// cell or vertex can be kept. The base mesh's vertices keep their numbers.
///
/// No angle is less than a third of the least angle of the base's triangles and of the triangles
/// into which diagonals cut the base's parallelograms (Rosenberg & Stenger 1975 for halved
/// triangles; a triangle with two angles a is halved into a third of a at worst). Elements of
/// round shapes are never split.
///
/// Keeps a reference to the base; a copy is a refinement of its own.
class RefinedElements {
 public:
  explicit RefinedElements(const PatchMesh& base);
  explicit RefinedElements(PatchMesh&& base) = delete;

  const PatchMesh& base() const { return *base_; }
  /// The cells that are neither split nor on round shapes, in the base's order.
  std::vector<int> leaves() const;
  int level(int cell) const { return cells_[cell].level; }
  /// The cell that was split into this cell; -1 for an element of the base.
  int parent(int cell) const { return cells_[cell].parent; }
  bool is_split(int cell) const { return cells_[cell].is_split; }
  int corner_count(int cell) const { return cells_[cell].corner_count; }
  int side_count(int cell) const { return cells_[cell].side_count; }
  /// Number of a cell's side among the sides of all cells, 0 .. side_total() - 1; the sides of a
  /// cell are consecutive.
  int side_number(int cell, int side) const { return cells_[cell].first_side + side; }
  int side_total() const { return static_cast<int>(sides_.size()); }
  /// The base's element on a side of the cell (0: front, 1: back).
  int element(int cell, int side) const;
  double area(int cell) const;  ///< m^2, one side
  int cell_count() const { return static_cast<int>(cells_.size()); }
  /// The first of the four children, which are numbered consecutively; -1 if the cell was never
  /// split.
  int first_child(int cell) const { return cells_[cell].first_child; }

  /// Splits leaves, and coarser neighbours as balance demands; cells that are split already are
  /// skipped. Returns all cells that were split, in an order whose reverse undoes the splits in
  /// merge().
  std::vector<int> split(std::span<const int> cells);
  /// Undoes the split of each cell whose children are all leaves, where balance allows. Returns the
  /// number of merged cells.
  int merge(std::span<const int> cells);

  /// Number of elements of mesh(), both sides, without making the mesh.
  std::int64_t element_count() const;
  RefinedMesh mesh();
  /// Releases memory reserved for further splits.
  void shrink_to_fit();

  /// Vertices of a cell by corner, by edge (from corner i to the next), or in the middle. Edge and
  /// centre vertices are made at the first call, and are in mesh() only once something is split
  /// there.
  int corner_vertex(int cell, int side, int corner) const {
    return side_of(cell, side).vertex[corner];
  }
  int edge_vertex(int cell, int side, int edge);
  int center_vertex(int cell, int side);

  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  Eigen::Vector3d position(int vertex) const { return vertices_[vertex].position; }
  /// The vertices half-way between which `vertex` was made (2 or 4, the rest -1), all of lower
  /// numbers; none for a vertex of the base.
  std::array<int, 4> ends(int vertex) const;
  /// A place near a vertex: at the inset_share() for `share` of the way to the middle of a base
  /// element that has the vertex, with that element and its normal; on spheres the vertex itself.
  PatchPoint inside(int vertex, double share) const;

 private:
  // Vertices and cells are as many as elements or several times as many, so values that can be
  // derived are not stored.
  struct Vertex {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    int element = -1;  // of the base mesh
    // The ends of the edge whose middle the vertex is; or -2 - n if it is the centre of side number
    // n; or -1.
    int from = -1, to = -1;
    int next_middle = -1;  // next middle vertex of the same edge, on other sides and sheets
  };
  struct Edge {
    // Edges from the start and from the end to the middle, numbered consecutively.
    int first_half = -1;
    int parent = -1;
    int splits = 0;         // number of split cells that the edge bounds
    int first_user = -1;    // 4 cell + corner, the head of a list linked by Cell::next_user
    int first_middle = -1;  // vertex, the head of a list linked by Vertex::next_middle
  };
  struct Side {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    int center = -1;
  };
  struct Cell {
    int base = 0, parent = -1, first_child = -1, first_side = -1;
    // The side count is a number and not a bit: GCC 12.2 (-O3) ran past the end of loops to a bit's
    // `? 2 : 1`.
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
    bool is_backwards = false;  // true if the cell passes the edge from its end to its start
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
  // Per base vertex, the lowest vertex of its reflex corner, or the vertex itself.
  std::vector<int> reflex_;
  std::vector<Edge> edges_;
  std::vector<Cell> cells_;
  std::vector<Side> sides_;
  std::vector<int> cell_of_;  // per base element on a front, its cell; else -1
};

}  // namespace lightwell
