#include "raytrace/caustics/light_regions.h"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>
#include <utility>

#include "scene/disjoint_sets.h"

namespace lightwell {
namespace {

struct DirectedEdge {
  int low, high;  // vertices
  bool is_reversed;
  int element;
};

std::vector<DirectedEdge> directed_edges(const PatchMesh& mesh) {
  std::vector<DirectedEdge> edges;
  edges.reserve(4 * static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) {
      const int from = mesh.corners[e][c], to = mesh.corners[e][(c + 1) % n];
      if (from == to) continue;  // at a sphere's pole
      edges.push_back({std::min(from, to), std::max(from, to), from > to, e});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tuple(a.low, a.high, a.element) < std::tuple(b.low, b.high, b.element);
  });
  return edges;
}

using PointKey = std::array<double, 3>;

PointKey key_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

// Removes edges between elements that meet without sharing vertices, as at reflex corners: such
// edges bound nothing.
void drop_seams(std::vector<LightRegions::Edge>& bounds) {
  std::set<std::pair<PointKey, PointKey>> all;
  for (const auto& edge : bounds) all.insert({key_of(edge.from), key_of(edge.to)});
  std::erase_if(bounds, [&](const LightRegions::Edge& edge) {
    return all.contains({key_of(edge.to), key_of(edge.from)});
  });
}

}  // namespace

LightRegions light_regions(const PatchMesh& mesh) {
  DisjointSets joined(static_cast<std::size_t>(mesh.vertex_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 1; c < mesh.corner_count(e); ++c) {
      joined.join(mesh.corners[e][0], mesh.corners[e][c]);
    }
  }
  LightRegions regions;
  std::vector<int> number(mesh.vertex_count(), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    int& region = number[joined.root(mesh.corners[e][0])];
    if (region < 0) {
      region = regions.count();
      regions.bounds.emplace_back();
    }
    regions.of_element.push_back(region);
  }
  const std::vector<DirectedEdge> edges = directed_edges(mesh);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
      ++end;
    if (end - i == 1) {
      const DirectedEdge& edge = edges[i];
      LightRegions::Edge bound{mesh.position(edge.low), mesh.position(edge.high)};
      if (edge.is_reversed) std::swap(bound.from, bound.to);
      regions.bounds[regions.of_element[edge.element]].push_back(bound);
    }
    i = end;
  }
  for (auto& bounds : regions.bounds) drop_seams(bounds);
  return regions;
}

}  // namespace lightwell
