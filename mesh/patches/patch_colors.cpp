#include "mesh/patches/patch_colors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/geometry/welded_points.h"

namespace lightwell {
namespace {

struct PatchEdge {
  int low = 0, high = 0;  // points in space
  int patch = 0;
};

// The edges of all front elements, sorted by their points: equal edges lie side by side. Points and
// not vertices are compared, because each side of a line where light may jump has vertices of its
// own.
std::vector<PatchEdge> front_edges(const PatchMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (int v = 0; v < mesh.vertex_count(); ++v) box.extend(mesh.position(v));
  const double tolerance = std::max(1e-9 * box.diagonal().norm(), 1e-300);
  WeldedPoints points(tolerance);
  std::vector<int> point(static_cast<std::size_t>(mesh.vertex_count()));
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    point[v] = points.add(mesh.position(v) - box.center(), tolerance);
  }

  std::vector<PatchEdge> edges;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.is_back[mesh.patch[e]]) continue;
    const int n = mesh.corner_count(e);
    for (int i = 0; i < n; ++i) {
      const auto [low, high] =
          std::minmax({point[mesh.corners[e][i]], point[mesh.corners[e][(i + 1) % n]]});
      edges.push_back({low, high, mesh.patch[e]});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const PatchEdge& a, const PatchEdge& b) {
    return std::tie(a.low, a.high, a.patch) < std::tie(b.low, b.high, b.patch);
  });
  return edges;
}

std::vector<std::vector<int>> neighbours(const PatchMesh& mesh) {
  const std::vector<PatchEdge> edges = front_edges(mesh);
  std::vector<std::vector<int>> result(static_cast<std::size_t>(mesh.patch_count()));
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1;
         j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j) {
      const int a = edges[i].patch, b = edges[j].patch;
      if (a == b) continue;
      result[a].push_back(b);
      result[b].push_back(a);
    }
  }
  for (std::vector<int>& of_patch : result) {
    std::sort(of_patch.begin(), of_patch.end());
    of_patch.erase(std::unique(of_patch.begin(), of_patch.end()), of_patch.end());
  }
  return result;
}

}  // namespace

std::vector<int> patch_colors(const PatchMesh& mesh) {
  const auto beside = neighbours(mesh);
  std::vector<int> order(beside.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return beside[a].size() > beside[b].size(); });
  std::vector<int> color(beside.size(), -1);
  std::vector<char> is_taken;
  for (const int p : order) {
    if (mesh.is_back[p]) continue;
    is_taken.assign(beside[p].size() + 1, 0);
    for (const int other : beside[p]) {
      if (color[other] >= 0 && color[other] < static_cast<int>(is_taken.size())) {
        is_taken[color[other]] = 1;
      }
    }
    color[p] = static_cast<int>(std::find(is_taken.begin(), is_taken.end(), 0) - is_taken.begin());
  }
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!mesh.is_back[p]) continue;
    const int front = mesh.twin[mesh.first_element[p]];
    color[p] = front >= 0 ? color[mesh.patch[front]] : 0;
  }
  return color;
}

}  // namespace lightwell
