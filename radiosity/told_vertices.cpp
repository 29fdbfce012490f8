#include "radiosity/told_vertices.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace lightwell {

void tell(std::span<const ToldVertex> told, BandArray& values) {
  for (const ToldVertex& t : told) {
    values.row(t.vertex).setZero();
    for (int i = 0; i < t.end_count(); ++i) values.row(t.vertex) += values.row(t.ends[i]);
    values.row(t.vertex) /= static_cast<float>(t.end_count());
  }
}

std::vector<double> vertex_areas(const PatchMesh& mesh) {
  std::vector<double> area(mesh.vertex_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) area[mesh.corners[e][c]] += mesh.element_area[e] / n;
  }
  return area;
}

void share_rays(std::span<const double> area, int rays, std::span<GatherPoint> points) {
  std::vector<double> sorted(area.begin(), area.end());
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const double total = std::accumulate(sorted.begin(), sorted.end(), 0.0);
  double typical = 0.0, larger = 0.0;
  constexpr double about_half = 0.47;  // no share that elements of a grid add up to
  for (std::size_t i = 0; i < sorted.size() && larger < about_half * total; ++i) {
    typical = sorted[i];
    larger += sorted[i];
  }
  for (GatherPoint& point : points) point.rays = rays;
  if (!(typical > 0.0)) return;
  for (std::size_t v = 0; v < points.size(); ++v) {
    // sqrt(area / typical), to a power of two. It changes between the areas that a grid's vertices
    // have, halves and quarters, so that rounding does not decide.
    constexpr double between = 0.45;
    const double halvings = -0.5 * std::log2(std::max(area[v] / typical, 1e-6));
    const int shift = std::clamp(static_cast<int>(std::floor(halvings + between)), -1, 3);
    points[v].rays = shift < 0 ? 2 * rays : std::max(1, rays >> shift);
  }
}

void share_rays(const PatchMesh& mesh, std::span<const ToldVertex> told, int rays,
                std::span<GatherPoint> points) {
  std::vector<double> area = vertex_areas(mesh);
  for (auto t = told.rbegin(); t != told.rend(); ++t) {
    for (int i = 0; i < t->end_count(); ++i) area[t->ends[i]] += area[t->vertex] / t->end_count();
    area[t->vertex] = 0.0;
  }
  share_rays(area, rays, points);
  for (const ToldVertex& t : told) points[t.vertex].rays = 0;
}

}  // namespace lightwell
