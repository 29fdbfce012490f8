#include "mesh/elements/refine_elements.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/elements/closure_pieces.h"
#include "mesh/patches/inset.h"
#include "mesh/patches/round_grid.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Numbers the places of the vertices in ascending order of coordinates. Vertices that touch in the
// base have the same bits.
std::vector<int> vertex_places(const PatchMesh& mesh) {
  std::vector<int> order(mesh.vertex_count());
  std::iota(order.begin(), order.end(), 0);
  const auto coordinates = [&](int v) {
    const Vector3d p = mesh.position(v);
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto p = coordinates(a), q = coordinates(b);
    return p < q || (p == q && a < b);
  });
  std::vector<int> place(order.size(), 0);
  int count = -1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || coordinates(order[i]) != coordinates(order[i - 1])) ++count;
    place[order[i]] = count;
  }
  return place;
}

double fan_area(const std::array<int, 4>& c, const std::vector<Vector3d>& positions) {
  const Vector3d& a = positions[c[0]];
  Vector3d sum = (positions[c[1]] - a).cross(positions[c[2]] - a);
  if (c[3] >= 0) sum += (positions[c[2]] - a).cross(positions[c[3]] - a);
  return 0.5 * sum.norm();
}

// Copies what refinement leaves unchanged. `first` is, per element of the base, its first element
// in `out`.
void copy_patches(const PatchMesh& base, const std::vector<int>& first, PatchMesh& out) {
  for (const int e : base.first_element) out.first_element.push_back(first[e]);
  out.area = base.area;
  out.reflectance = base.reflectance;
  out.transmittance = base.transmittance;
  out.behind = base.behind;
  out.emission = base.emission;
  out.surface = base.surface;
  out.material = base.material;
  out.is_back = base.is_back;
  out.round_grids = base.round_grids;
  for (RoundGrid& grid : out.round_grids) {
    for (int& e : grid.element) e = first[e];
  }
  out.textures = base.textures;
  out.patterns = base.patterns;
  out.notes = base.notes;
}

}  // namespace

RefinedElements::RefinedElements(const PatchMesh& base) : base_(&base) {
  vertices_.resize(base_->vertex_count());
  const std::vector<int> elements = vertex_elements(*base_);
  for (int v = 0; v < base_->vertex_count(); ++v) {
    vertices_[v] = {.position = base_->position(v), .element = elements[v]};
  }
  const std::vector<int> places = vertex_places(*base_);
  add_base_cells(places);
  find_reflex_corners(places);
}

void RefinedElements::add_base_cells(const std::vector<int>& places) {
  cell_of_.assign(base_->element_count(), -1);
  std::vector<std::tuple<int, int, int>> sides;  // places, 4 cell + corner
  for (int e = 0; e < base_->element_count(); ++e) {
    const bool is_round = round_grid_of(*base_, base_->facet[e]) != nullptr;
    const int twin = base_->twin[e];
    if (is_round || (twin >= 0 && twin < e)) continue;
    const int number = static_cast<int>(cells_.size());
    cell_of_[e] = number;
    add_cell({.base = e,
              .corner_count = static_cast<std::int8_t>(base_->corner_count(e)),
              .side_count = static_cast<std::int8_t>(twin >= 0 ? 2 : 1)});
    Side& front = side_of(number, 0);
    const int n = corner_count(number);
    std::array<int, 4> place{-1, -1, -1, -1};
    for (int i = 0; i < n; ++i) {
      front.vertex[i] = base_->corners[e][i];
      place[i] = places[front.vertex[i]];
    }
    for (int i = 0; i < n && twin >= 0; ++i) {
      const int at = base_->corners[twin][i];
      const auto same = std::find(place.begin(), place.end(), places[at]);
      side_of(number, 1).vertex[same - place.begin()] = at;
    }
    for (int i = 0; i < n; ++i) {
      const auto [low, high] = std::minmax(place[i], place[(i + 1) % n]);
      sides.emplace_back(low, high, 4 * number + i);
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& [low, high, user] = sides[i];
    const bool is_new =
        i == 0 || std::get<0>(sides[i - 1]) != low || std::get<1>(sides[i - 1]) != high;
    const int edge = is_new ? add_edge() : static_cast<int>(edges_.size()) - 1;
    const bool is_backwards = places[corner_vertex(user / 4, 0, user % 4)] != low;
    set_edge(user / 4, user % 4, {edge, is_backwards});
  }
}

void RefinedElements::find_reflex_corners(const std::vector<int>& places) {
  reflex_.resize(base_->vertex_count());
  std::iota(reflex_.begin(), reflex_.end(), 0);
  if (base_->at_reflex_corner.empty()) return;
  const auto root = [this](int v) {
    while (reflex_[v] != v) v = reflex_[v] = reflex_[reflex_[v]];
    return v;
  };
  std::vector<std::tuple<int, int, int, int>> corners;  // place, facet, side, vertex
  for (int e = 0; e < base_->element_count(); ++e) {
    for (int i = 0; i < base_->corner_count(e); ++i) {
      const int v = base_->corners[e][i];
      if (!base_->at_reflex_corner[v]) continue;
      corners.emplace_back(places[v], base_->facet[e], base_->is_back[base_->patch[e]], v);
    }
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const auto& [place, facet, side, vertex] = corners[i];
    if (std::tuple(place, facet, side) != std::tuple(std::get<0>(corners[i - 1]),
                                                     std::get<1>(corners[i - 1]),
                                                     std::get<2>(corners[i - 1]))) {
      continue;
    }
    const int r = root(vertex), s = root(std::get<3>(corners[i - 1]));
    reflex_[std::max(r, s)] = std::min(r, s);
  }
  for (int v = 0; v < base_->vertex_count(); ++v) reflex_[v] = root(v);
}

int RefinedElements::element(int cell, int side) const {
  const int e = cells_[cell].base;
  return side == 0 ? e : base_->twin[e];
}

double RefinedElements::area(int cell) const {
  const Cell& c = cells_[cell];
  std::array<int, 4> corners{0, 1, 2, c.corner_count == 4 ? 3 : -1};
  std::vector<Vector3d> positions;
  for (int i = 0; i < c.corner_count; ++i) positions.push_back(position(corner_vertex(cell, 0, i)));
  return fan_area(corners, positions);
}

template <class Visit>
void RefinedElements::for_each_leaf(int root, Visit&& visit) const {
  if (!cells_[root].is_split) return visit(root);
  for (int i = 0; i < 4; ++i) for_each_leaf(cells_[root].first_child + i, visit);
}

std::vector<int> RefinedElements::leaves() const {
  std::vector<int> all;
  for (const int root : cell_of_) {
    if (root >= 0) for_each_leaf(root, [&](int cell) { all.push_back(cell); });
  }
  return all;
}

unsigned RefinedElements::split_edges(const Cell& cell) const {
  unsigned edges = 0;
  for (int i = 0; i < cell.corner_count; ++i) {
    if (edges_[cell.edge[i]].splits > 0) edges |= 1U << i;
  }
  return edges;
}

std::int64_t RefinedElements::element_count() const {
  std::int64_t count = 0;
  for (int e = 0; e < base_->element_count(); ++e) {
    const int root = cell_of_[e];
    if (root < 0) {  // backs are counted with their fronts
      if (base_->twin[e] < 0 || round_grid_of(*base_, base_->facet[e])) ++count;
      continue;
    }
    for_each_leaf(root, [&](int leaf) {
      const Cell& cell = cells_[leaf];
      const auto pieces = closure_pieces(cell.corner_count, split_edges(cell)).size();
      count += static_cast<std::int64_t>(pieces) * side_count(leaf);
    });
  }
  return count;
}

int RefinedElements::add_vertex(const Vertex& vertex) {
  vertices_.push_back(vertex);
  return static_cast<int>(vertices_.size()) - 1;
}

int RefinedElements::edge_vertex(int number, int side, int i) {
  const Cell& cell = cells_[number];
  Edge& edge = edges_[cell.edge[i]];
  const int a = corner_vertex(number, side, i);
  const int b = corner_vertex(number, side, (i + 1) % cell.corner_count);
  const auto representative = [this](int v) {
    return v < static_cast<int>(reflex_.size()) ? reflex_[v] : v;
  };
  const auto between = [&](int from, int to) {
    return std::minmax({representative(from), representative(to)});
  };
  for (int m = edge.first_middle; m >= 0; m = vertices_[m].next_middle) {
    if (between(vertices_[m].from, vertices_[m].to) == between(a, b)) return m;
  }
  edge.first_middle = add_vertex({.position = 0.5 * (position(a) + position(b)),
                                  .element = element(number, side),
                                  .from = a,
                                  .to = b,
                                  .next_middle = edge.first_middle});
  return edge.first_middle;
}

int RefinedElements::center_vertex(int number, int side) {
  Side& at = side_of(number, side);
  if (at.center >= 0) return at.center;
  const int n = corner_count(number);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < n; ++i) sum += position(corner_vertex(number, 0, i));
  at.center = add_vertex({.position = sum / n,
                          .element = element(number, side),
                          .from = -2 - side_number(number, side)});
  return at.center;
}

std::array<int, 4> RefinedElements::ends(int vertex) const {
  const Vertex& v = vertices_[vertex];
  if (v.from >= -1) return {v.from, v.to, -1, -1};
  return sides_[-2 - v.from].vertex;
}

PatchPoint RefinedElements::inside(int vertex, double share) const {
  const Vertex& v = vertices_[vertex];
  const PatchPoint center = element_center(*base_, v.element);
  const Vector3d near =
      v.position + inset_share(*base_, v.element, share) * (center.position - v.position);
  if (const RoundGrid* grid = round_grid_of(*base_, base_->facet[v.element])) {
    // A sphere has no rim at which something else could stand.
    const bool has_rim = !std::holds_alternative<Sphere>(grid->shape);
    const Vector3d at = has_rim ? nearest_on(grid->shape, near) : v.position;
    return {v.element, at, round_normal(*base_, *grid, base_->patch[v.element], at)};
  }
  return {v.element, near, center.normal};
}

// The vertices of a piece on the given side, counter-clockwise there.
std::array<int, 4> RefinedElements::piece_vertices(int cell, int side,
                                                   const std::array<int, 4>& piece) {
  std::array<int, 4> c{-1, -1, -1, -1};
  for (int i = 0; i < 4 && piece[i] >= 0; ++i) {
    c[i] = piece[i] == center_node   ? center_vertex(cell, side)
           : piece[i] >= middle_node ? edge_vertex(cell, side, piece[i] - middle_node)
                                     : corner_vertex(cell, side, piece[i]);
  }
  if (side == 0) return c;
  return c[3] < 0 ? std::array<int, 4>{c[0], c[2], c[1], -1}
                  : std::array<int, 4>{c[0], c[3], c[2], c[1]};
}

void RefinedElements::shrink_to_fit() {
  vertices_.shrink_to_fit();
  edges_.shrink_to_fit();
  cells_.shrink_to_fit();
  sides_.shrink_to_fit();
}

// The tree over the base's elements, with the numbers that mesh() gives, leaf by leaf.
ElementTree RefinedElements::tree(std::vector<int> first_element) const {
  ElementTree tree;
  tree.root.assign(cell_of_.size(), -1);
  struct Open {
    int node, cell;
  };
  std::vector<Open> open;
  for (std::size_t e = 0; e < cell_of_.size(); ++e) {
    if (cell_of_[e] < 0) continue;
    int element = first_element[e];
    tree.root[e] = static_cast<int>(tree.nodes.size());
    tree.nodes.emplace_back();
    open.push_back({tree.root[e], cell_of_[e]});
    while (!open.empty()) {
      const auto [node, number] = open.back();
      open.pop_back();
      const Cell& cell = cells_[number];
      if (cell.is_split) {
        const int first = static_cast<int>(tree.nodes.size());
        tree.nodes[node] = {.first = first, .split_edges = ElementTree::is_split};
        tree.nodes.resize(tree.nodes.size() + 4);
        for (int i = 3; i >= 0; --i) open.push_back({first + i, cell.first_child + i});
        continue;
      }
      const unsigned edges = split_edges(cell);
      tree.nodes[node] = {.first = element, .split_edges = static_cast<std::int8_t>(edges)};
      element += static_cast<int>(closure_pieces(cell.corner_count, edges).size());
    }
  }
  tree.first_element = std::move(first_element);
  return tree;
}

RefinedMesh RefinedElements::mesh() {
  RefinedMesh refined;
  PatchMesh& out = refined.mesh;
  std::vector<double> areas;
  std::vector<Vector3d> positions;
  std::vector<int> number;  // in the mesh, per vertex of the refinement
  std::vector<int> first(base_->element_count() + 1, 0);
  const auto count = static_cast<std::size_t>(element_count());
  areas.reserve(count);
  out.corners.reserve(count);
  out.patch.reserve(count);
  out.facet.reserve(count);
  out.twin.reserve(count);
  refined.cell.reserve(count);
  const auto mesh_vertex = [&](int v) {
    if (v >= static_cast<int>(number.size())) number.resize(vertices_.size(), -1);
    if (number[v] < 0) {
      number[v] = static_cast<int>(positions.size());
      positions.push_back(position(v));
      refined.vertex.push_back(v);
      const bool is_base = v < static_cast<int>(base_->at_reflex_corner.size());
      out.at_reflex_corner.push_back(is_base ? base_->at_reflex_corner[v] : 0);
    }
    return number[v];
  };
  const auto add = [&](int e, int cell, std::array<int, 4> c) {
    for (int& v : c) v = v < 0 ? -1 : mesh_vertex(v);
    out.corners.push_back(c);
    out.patch.push_back(base_->patch[e]);
    out.facet.push_back(base_->facet[e]);
    refined.cell.push_back(cell);
  };
  for (int e = 0; e < base_->element_count(); ++e) {
    first[e] = static_cast<int>(out.corners.size());
    const int side =
        cell_of_[e] < 0 && base_->twin[e] >= 0 && cell_of_[base_->twin[e]] >= 0 ? 1 : 0;
    const int root = side == 0 ? cell_of_[e] : cell_of_[base_->twin[e]];
    if (root < 0) {
      add(e, -1, base_->corners[e]);
      areas.push_back(base_->element_area[e]);
      continue;
    }
    double sum = 0.0;
    for_each_leaf(root, [&](int leaf) {
      const Cell& cell = cells_[leaf];
      const int corner_count = cell.corner_count;
      for (const ElementPiece& piece : closure_pieces(corner_count, split_edges(cell))) {
        add(e, leaf, piece_vertices(leaf, side, piece));
        areas.push_back(fan_area(out.corners.back(), positions));
        sum += areas.back();
      }
    });
    // Scaled to the exact area of the element; rounding moves the middle of an edge off its line.
    for (std::size_t i = first[e]; i < areas.size(); ++i) areas[i] *= base_->element_area[e] / sum;
  }
  first.back() = static_cast<int>(out.corners.size());
  for (int e = 0; e < base_->element_count(); ++e) {
    for (int k = first[e]; k < first[e + 1]; ++k) {
      out.twin.push_back(base_->twin[e] < 0 ? -1 : first[base_->twin[e]] + (k - first[e]));
    }
  }
  out.element_area =
      Eigen::Map<Eigen::ArrayXd>(areas.data(), static_cast<Eigen::Index>(areas.size()));
  copy_patches(*base_, first, out);
  build_topology(out, positions);
  refined.tree = std::make_shared<const ElementTree>(tree(std::move(first)));
  return refined;
}

}  // namespace lightwell
