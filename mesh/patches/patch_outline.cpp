#include "mesh/patches/patch_outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "mesh/patches/round_grid.h"
#include "scene/facet_textures.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

bool is_before(const Vector3d& a, const Vector3d& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

struct OutlineEdge {
  Vector3d from, to;
  bool operator<(const OutlineEdge& other) const {
    if (from != other.from) return is_before(from, other.from);
    return is_before(to, other.to);
  }
};

// The edges of the elements that have no counterpart. Edges are compared by position, because
// vertices are not shared across contact lines.
std::vector<OutlineEdge> free_edges(const PatchMesh& mesh, std::span<const int> elements) {
  std::vector<OutlineEdge> edges;
  for (const int e : elements) {
    const int n = mesh.corner_count(e);
    for (int k = 0; k < n; ++k) {
      edges.push_back(
          {mesh.position(mesh.corners[e][k]), mesh.position(mesh.corners[e][(k + 1) % n])});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<OutlineEdge> free;
  for (const OutlineEdge& edge : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), OutlineEdge{edge.to, edge.from})) {
      free.push_back(edge);
    }
  }
  return free;
}

// Joins the edges end to end. Edges are sorted, so the next edge is found by its start.
std::vector<std::vector<Vector3d>> chained(const std::vector<OutlineEdge>& edges) {
  std::vector<std::vector<Vector3d>> loops;
  std::vector<char> used(edges.size(), 0);
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    std::vector<Vector3d> loop;
    for (std::size_t at = start; at < edges.size() && !used[at];) {
      used[at] = 1;
      loop.push_back(edges[at].from);
      const Vector3d& next = edges[at].to;
      at =
          static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), next,
                                                    [](const OutlineEdge& edge, const Vector3d& p) {
                                                      return is_before(edge.from, p);
                                                    }) -
                                   edges.begin());
      while (at < edges.size() && edges[at].from == next && used[at]) ++at;
      if (at < edges.size() && edges[at].from != next) break;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Vector3d> without_straight_corners(const std::vector<Vector3d>& loop) {
  constexpr double straight = 1e-9;  // sine of the turn
  std::vector<Vector3d> corners;
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d in = (loop[i] - loop[(i + n - 1) % n]).normalized();
    const Vector3d out = (loop[(i + 1) % n] - loop[i]).normalized();
    if (in.cross(out).norm() > straight || in.dot(out) < 0.0) corners.push_back(loop[i]);
  }
  return corners;
}

}  // namespace

PatchOutline polygon_outline(std::vector<std::vector<Vector3d>> loops) {
  PatchOutline outline{.loops = std::move(loops)};
  if (outline.loops.empty()) return outline;
  const auto& boundary = outline.loops.front();
  for (const Vector3d& v : boundary) outline.center += v / static_cast<double>(boundary.size());
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const Vector3d a = boundary[i] - outline.center;
    const Vector3d b = boundary[(i + 1) % boundary.size()] - outline.center;
    area += a.cross(b);
    outline.radius = std::max(outline.radius, a.norm());
  }
  outline.normal = area.normalized();
  return outline;
}

std::vector<std::vector<Vector3d>> boundary_loops(const PatchMesh& mesh,
                                                  std::span<const int> elements) {
  std::vector<std::vector<Vector3d>> loops;
  for (const auto& loop : chained(free_edges(mesh, elements))) {
    auto corners = without_straight_corners(loop);
    if (corners.size() >= 3) loops.push_back(std::move(corners));
  }
  return loops;
}

PatchOutline patch_outline(const PatchMesh& mesh, int patch) {
  PatchOutline outline;
  const int facet = mesh.facet_of(patch);
  const bool has_holes = facet >= 0 && mesh.textures && mesh.textures->has_holes(facet);
  if (facet >= 0 && !has_holes && !round_grid_of(mesh, facet)) {
    std::vector<int> elements(mesh.first_element[patch + 1] - mesh.first_element[patch]);
    std::iota(elements.begin(), elements.end(), mesh.first_element[patch]);
    outline = polygon_outline(boundary_loops(mesh, elements));
    // A patch may be in pieces, and polygon_outline sets the radius by the first alone.
    for (const auto& loop : outline.loops) {
      for (const Vector3d& v : loop) {
        outline.radius = std::max(outline.radius, (v - outline.center).norm());
      }
    }
  }
  outline.normal = element_center(mesh, mesh.first_element[patch]).normal;
  return outline;
}

std::vector<PatchOutline> patch_outlines(const PatchMesh& mesh) {
  std::vector<PatchOutline> outlines(static_cast<std::size_t>(mesh.patch_count()));
  parallel_for(mesh.patch_count(), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      outlines[static_cast<std::size_t>(i)] = patch_outline(mesh, i);
  });
  return outlines;
}

}  // namespace lightwell
