#include "mesh/discontinuity/critical_features.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/disjoint_sets.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double parallel_cosine = 1.0 - 1e-12;  // directions less than 1.4e-6 rad apart are equal

// A facet's use of the edge between two points.
struct PlaneEdge {
  int plane = 0;
  bool is_forward = false;  // from the lower-numbered point to the other
  Vector3d low, high;
};
using PlaneEdges = std::map<std::array<int, 2>, std::vector<PlaneEdge>>;

template <class Keep>
PlaneEdges plane_edges(const std::vector<FacetPlane>& planes, Keep&& keep) {
  PlaneEdges uses;
  for (int p = 0; p < static_cast<int>(planes.size()); ++p) {
    const FacetPlane& plane = planes[p];
    if (!keep(plane)) continue;
    plane.for_each_edge([&](int i, int j) {
      const bool is_forward = plane.point[i] < plane.point[j];
      if (!is_forward) std::swap(i, j);
      uses[{plane.point[i], plane.point[j]}].push_back(
          {p, is_forward, plane.corner[i], plane.corner[j]});
    });
  }
  return uses;
}

// True if the edge lies between two facets of one plane that face the same way or opposite ways.
// Light is continuous across such an edge.
bool is_seam(const std::vector<PlaneEdge>& uses, const std::vector<FacetPlane>& planes) {
  if (uses.size() != 2) return false;
  const double cosine = planes[uses[0].plane].normal.dot(planes[uses[1].plane].normal);
  return uses[0].is_forward != uses[1].is_forward ? cosine > parallel_cosine
                                                  : cosine < -parallel_cosine;
}

bool is_straight(const std::vector<Vector3d>& edges) {
  return edges.size() == 2 && edges[0].dot(edges[1]) < -parallel_cosine;
}

const Material& material_of(const Scene& scene, const FacetPlane& plane) {
  return scene.materials[scene.surfaces[plane.surface].material];
}

void add_border_edge(const std::array<int, 2>& ends, const PlaneEdge& use, EmittingPolygon& emitter,
                     std::map<int, int>& corner_of_point) {
  const Vector3d d = (use.high - use.low).normalized();
  emitter.edges.push_back({use.low, use.high});
  for (const int end : {0, 1}) {
    const auto [entry, is_new] =
        corner_of_point.try_emplace(ends[end], static_cast<int>(emitter.corners.size()));
    if (is_new) emitter.corners.push_back({.position = end == 0 ? use.low : use.high});
    emitter.corners[entry->second].edges.push_back(end == 0 ? d : Vector3d(-d));
  }
}

}  // namespace

std::vector<EmittingPolygon> emitting_polygons(const Scene& scene,
                                               const std::vector<FacetPlane>& planes) {
  const PlaneEdges uses = plane_edges(
      planes, [&](const FacetPlane& plane) { return material_of(scene, plane).is_emitter(); });
  DisjointSets sheets(planes.size());  // planes, joined across seams
  // Emission is the same on both sides of a seam only within a material and a side.
  const auto joins = [&](const std::vector<PlaneEdge>& edge) {
    return is_seam(edge, planes) && edge[0].is_forward != edge[1].is_forward &&
           &material_of(scene, planes[edge[0].plane]) == &material_of(scene, planes[edge[1].plane]);
  };
  for (const auto& [ends, edge] : uses) {
    if (joins(edge)) sheets.join(edge[0].plane, edge[1].plane);
  }
  std::map<int, EmittingPolygon> of_root;
  for (int p = 0; p < static_cast<int>(planes.size()); ++p) {
    const Material& material = material_of(scene, planes[p]);
    if (!material.is_emitter()) continue;
    const int root = sheets.root(p);
    EmittingPolygon& emitter = of_root
                                   .try_emplace(root, EmittingPolygon{.normal = planes[root].normal,
                                                                      .center = Vector3d::Zero()})
                                   .first->second;
    const double area = planes[p].area();
    emitter.planes.push_back(p);
    emitter.center += area * planes[p].origin;
    emitter.area += area;
    emitter.power += area * static_cast<double>(material.emission.mean());
  }
  std::map<int, std::map<int, int>> corner_of_point;
  for (const auto& [ends, edge] : uses) {
    if (joins(edge)) continue;
    for (const PlaneEdge& use : edge) {
      const int root = sheets.root(use.plane);
      add_border_edge(ends, use, of_root.at(root), corner_of_point[root]);
    }
  }
  std::vector<EmittingPolygon> result;
  for (auto& [root, emitter] : of_root) {
    emitter.center /= emitter.area;
    std::erase_if(emitter.corners, [](const auto& c) { return is_straight(c.edges); });
    result.push_back(emitter);
    if (!material_of(scene, planes[root]).emits_both_sides) continue;
    emitter.normal = -emitter.normal;
    result.push_back(std::move(emitter));
  }
  double most = 0.0;
  for (const EmittingPolygon& emitter : result) most = std::max(most, emitter.power);
  // Powers equal to rounding count as equal, so the order does not depend on the unit of length.
  constexpr double step = 1e-9;
  const auto share = [most](const EmittingPolygon& e) { return std::round(e.power / most / step); };
  std::stable_sort(result.begin(), result.end(),
                   [&](const auto& one, const auto& other) { return share(one) > share(other); });
  return result;
}

OccluderFeatures occluder_features(const Scene& scene, const std::vector<FacetPlane>& planes) {
  const PlaneEdges uses = plane_edges(planes, [&](const FacetPlane& plane) {
    return !material_of(scene, plane).dielectric.has_value();
  });
  OccluderFeatures features;
  std::map<int, OccluderVertex> vertices;
  for (const auto& [ends, edge] : uses) {
    if (is_seam(edge, planes)) continue;
    const Vector3d &from = edge.front().low, &to = edge.front().high;
    OccluderEdge& added = features.edges.emplace_back(
        OccluderEdge{.a = ends[0], .b = ends[1], .from = from, .to = to});
    const Vector3d d = (to - from).normalized();
    for (const PlaneEdge& use : edge) {
      added.planes.push_back(use.plane);
      added.inwards.push_back(planes[use.plane].normal.cross(use.is_forward ? d : Vector3d(-d)));
    }
    for (const int end : {0, 1}) {
      OccluderVertex& vertex = vertices[ends[end]];
      vertex.position = end == 0 ? from : to;
      vertex.edges.push_back(end == 0 ? d : Vector3d(-d));
    }
  }
  for (auto& [point, vertex] : vertices) {
    if (!is_straight(vertex.edges)) features.vertices.push_back(std::move(vertex));
  }
  return features;
}

}  // namespace lightwell
