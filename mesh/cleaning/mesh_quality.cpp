#include "mesh/cleaning/mesh_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "mesh/geometry/welded_points.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// A directed edge from its first to its second point, as numbers of welded points.
using MeshEdge = std::pair<int, int>;

bool is_sliver(const PolygonMesh& mesh, const Facet& facet) {
  const auto corner = [&](std::size_t i) {
    return mesh.vertices[static_cast<std::size_t>(facet.boundary[i % facet.boundary.size()])];
  };
  const double area = facet_area(mesh, facet);
  double longest = 0.0;
  if (facet.boundary.size() == 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, (corner(i + 1) - corner(i)).norm());
    }
    return !(2.0 * area >= sliver_share * longest * longest);
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < facet.boundary.size(); ++i) mean += corner(i) - corner(0);
  mean = corner(0) + mean / static_cast<double>(facet.boundary.size());
  for (std::size_t i = 0; i < facet.boundary.size(); ++i) {
    longest = std::max(longest, 2.0 * (corner(i) - mean).norm());
  }
  return !(area >= sliver_share * longest * longest);
}

std::vector<MeshEdge> edges_of(const PolygonMesh& mesh, double tolerance) {
  WeldedPoints points(tolerance);
  std::vector<int> welded;
  welded.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) welded.push_back(points.add(p, tolerance));
  std::vector<MeshEdge> edges;
  const auto add = [&](const std::vector<int>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = welded[static_cast<std::size_t>(loop[i])];
      const int b = welded[static_cast<std::size_t>(loop[(i + 1) % loop.size()])];
      if (a != b) edges.emplace_back(a, b);
    }
  };
  for (const Facet& facet : mesh.facets) {
    add(facet.boundary);
    for (const auto& hole : facet.holes) add(hole);
  }
  return edges;
}

// Counts edges, sorted by their ends so that all uses of an edge, in either direction, are
// consecutive.
void count_edges(std::vector<MeshEdge> edges, MeshQuality& quality) {
  const auto ends = [](const MeshEdge& e) { return std::minmax(e.first, e.second); };
  std::ranges::sort(edges, [&](const MeshEdge& a, const MeshEdge& b) {
    return std::pair(ends(a), a) < std::pair(ends(b), b);
  });
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first, forwards = 0;
    while (last < edges.size() && ends(edges[last]) == ends(edges[first])) {
      forwards += edges[last].first < edges[last].second ? 1 : 0;
      ++last;
    }
    const std::size_t uses = last - first;
    quality.open_edges += uses == 1 ? 1 : 0;
    quality.non_manifold_edges += uses > 2 ? 1 : 0;
    quality.inconsistent_edges += (forwards > 1 ? 1 : 0) + (uses - forwards > 1 ? 1 : 0);
    first = last;
  }
}

}  // namespace

MeshQuality mesh_quality(const Scene& scene) {
  const double tolerance = weld_share * coordinate_length(scene);
  MeshQuality quality;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) continue;
    for (const Facet& facet : mesh->facets) {
      quality.triangles += static_cast<std::int64_t>(facet.boundary.size()) - 2;
      // Each hole is joined to the boundary by two edges.
      for (const auto& hole : facet.holes) {
        quality.triangles += static_cast<std::int64_t>(hole.size()) + 2;
      }
      quality.slivers += is_sliver(*mesh, facet) ? 1 : 0;
    }
    count_edges(edges_of(*mesh, tolerance), quality);
  }
  return quality;
}

}  // namespace lightwell
