#include "mesh/cleaning/facet_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "mesh/geometry/welded_points.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

using Corners = std::vector<int>;  // welded points, in order

struct WeldedFacet {
  int facet = 0;
  std::vector<Corners> loops{};  // boundary, then holes
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

std::vector<WeldedFacet> weld(const Scene& scene) {
  WeldedPoints points(weld_share * coordinate_length(scene));
  std::vector<WeldedFacet> welded;
  const std::vector<FacetRef> facets = scene_facets(scene);
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[facets[f].surface].shape);
    if (!mesh) continue;
    const Facet& facet = mesh->facets[facets[f].facet];
    WeldedFacet next{.facet = f, .normal = facet_normal(*mesh, facet)};
    const auto add = [&](const std::vector<int>& loop) {
      Corners corners;
      for (const int v : loop) corners.push_back(points.add(mesh->vertices[v], points.tolerance()));
      next.loops.push_back(std::move(corners));
    };
    add(facet.boundary);
    for (const auto& hole : facet.holes) add(hole);
    welded.push_back(std::move(next));
  }
  return welded;
}

Corners sorted_corners(const WeldedFacet& facet) {
  Corners all;
  for (const Corners& loop : facet.loops) all.insert(all.end(), loop.begin(), loop.end());
  std::sort(all.begin(), all.end());
  return all;
}

/// Per edge, the uses from its lower to its higher point, and from its higher to its lower.
using EdgeUseCounts = std::map<std::array<int, 2>, std::array<int, 2>>;

void add_edges(const WeldedFacet& facet, EdgeUseCounts& uses) {
  for (const Corners& loop : facet.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a != b) ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
}

}  // namespace

FacetCheck check_facets(const Scene& scene) {
  FacetCheck check;
  // Facets by their corners: at most one facet per side of the surface is kept.
  std::map<Corners, std::vector<const WeldedFacet*>> same_corners;
  EdgeUseCounts uses;
  const std::vector<WeldedFacet> facets = weld(scene);
  for (const WeldedFacet& facet : facets) {
    auto& kept = same_corners[sorted_corners(facet)];
    const auto same_side = std::find_if(kept.begin(), kept.end(), [&](const WeldedFacet* other) {
      return other->normal.dot(facet.normal) > 0.0;
    });
    if (same_side != kept.end()) {
      check.duplicates.push_back({(*same_side)->facet, facet.facet});
      continue;
    }
    if (!kept.empty()) check.opposites.push_back({kept.front()->facet, facet.facet});
    kept.push_back(&facet);
    add_edges(facet, uses);
  }
  for (const auto& [edge, use] : uses) {
    const auto [forwards, backwards] = use;
    if (forwards + backwards == 1) ++check.open_edges;
    if (forwards + backwards == 2 && forwards != backwards) ++check.inconsistent_edges;
  }
  return check;
}

}  // namespace lightwell
