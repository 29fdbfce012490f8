#include "viewer/export/chart_neighbours.h"

#include <Eigen/Geometry>
#include <array>
#include <numeric>
#include <tuple>

#include "scene/disjoint_sets.h"

namespace lightwell {
namespace {

/// Cosine of half a degree: facets with a smaller angle between them are coplanar.
const double least_turned = std::cos(0.5 * std::numbers::pi / 180.0);

}  // namespace

Eigen::Vector3d face_vector(const BakedModel& model, int face) {
  const auto& c = model.faces[face];
  const auto& p = model.position;
  if (c[3] < 0) return (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]);
  return (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]);
}

ChartNeighbours::ChartNeighbours(const BakedModel& model, const BakedPart& part)
    : model_(model), first_vertex_(part.first_vertex) {
  for (int f = part.first_face; f < part.first_face + part.face_count; ++f) {
    for (int c = 0; c < model.corner_count(f); ++c) around_.emplace_back(model.faces[f][c], f);
  }
  std::sort(around_.begin(), around_.end());
  find_creases(part);
}

int ChartNeighbours::joined(int vertex) const {
  return joined_[static_cast<std::size_t>(vertex - first_vertex_)];
}

// Edges sorted by the positions of their ends, so that both sides of a crease are adjacent.
void ChartNeighbours::find_creases(const BakedPart& part) {
  struct Edge {
    std::array<int, 2> place, vertex;  // of the ends, the lower place first
    int face;
  };
  const std::vector<int> place = places(part);
  std::vector<Edge> edges;
  for (int f = part.first_face; f < part.first_face + part.face_count; ++f) {
    const int count = model_.corner_count(f);
    for (int c = 0; c < count; ++c) {
      int a = model_.faces[f][c], b = model_.faces[f][(c + 1) % count];
      if (place[a - first_vertex_] > place[b - first_vertex_]) std::swap(a, b);
      edges.push_back({{place[a - first_vertex_], place[b - first_vertex_]}, {a, b}, f});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.place, a.face) < std::tie(b.place, b.face);
  });
  DisjointSets weld(static_cast<std::size_t>(part.vertex_count));
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Edge &one = edges[i - 1], &other = edges[i];
    if (one.place != other.place || one.vertex == other.vertex) continue;
    const double cosine = face_vector(model_, one.face)
                              .normalized()
                              .dot(face_vector(model_, other.face).normalized());
    if (!(cosine >= most_turned) || cosine > least_turned) continue;
    across_.emplace_back(one.face, other.face);
    across_.emplace_back(other.face, one.face);
    for (const int end : {0, 1}) {
      weld.join(one.vertex[end] - first_vertex_, other.vertex[end] - first_vertex_);
    }
  }
  std::sort(across_.begin(), across_.end());
  for (int v = 0; v < part.vertex_count; ++v) joined_.push_back(weld.root(v) + first_vertex_);
}

// A number for each vertex of the part, equal for vertices at equal positions.
std::vector<int> ChartNeighbours::places(const BakedPart& part) const {
  std::vector<int> order(static_cast<std::size_t>(part.vertex_count));
  std::iota(order.begin(), order.end(), first_vertex_);
  const auto key = [&](int v) {
    const Eigen::Vector3d& p = model_.position[v];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> place(order.size());
  int number = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i - 1]) != key(order[i])) ++number;
    place[order[i] - first_vertex_] = number;
  }
  return place;
}

}  // namespace lightwell
