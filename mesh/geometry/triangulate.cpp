#include "mesh/geometry/triangulate.h"

#include <algorithm>
#include <numeric>

#include "mesh/geometry/triangulation_backend.h"

namespace lightwell {
namespace {

// Makes the triangulation unique. Four points on a circle have two Delaunay triangulations, and
// the choice of a library depends on the order of its work or on where in memory its faces lie.
// Flips keep the diagonal that ends in the lowest-numbered of the four points, so all points on a
// circle are joined as a fan from the lowest.
class CocircularFans {
 public:
  explicit CocircularFans(PlanarTriangulation& mesh) : mesh_(mesh) {}

  void settle() {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
        for (int i = 0; i < 3; ++i) {
          if (!is_wrong(t, i)) continue;
          flip(t, i);
          has_changed = true;
        }
      }
    }
  }

 private:
  int opposite(int triangle, int neighbor) const {
    const auto& around = mesh_.neighbor[triangle];
    return static_cast<int>(std::find(around.begin(), around.end(), neighbor) - around.begin());
  }

  bool is_wrong(int t, int i) const {
    const int u = mesh_.neighbor[t][i];
    if (u < 0 || mesh_.constrained[t][i]) return false;
    const int a = mesh_.triangles[t][i], b = mesh_.triangles[t][(i + 1) % 3],
              c = mesh_.triangles[t][(i + 2) % 3], d = mesh_.triangles[u][opposite(u, t)];
    if (std::min(b, c) < std::min(a, d)) return false;
    return backend::side_of_circle(mesh_.points[a], mesh_.points[b], mesh_.points[c],
                                   mesh_.points[d]) == 0;
  }

  // Flips the edge b-c: (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c).
  void flip(int t, int i) {
    const int u = mesh_.neighbor[t][i], k = opposite(u, t);
    const auto at = [](int corner) { return corner % 3; };
    const int a = mesh_.triangles[t][i], b = mesh_.triangles[t][at(i + 1)],
              c = mesh_.triangles[t][at(i + 2)], d = mesh_.triangles[u][k];
    const int past_ca = mesh_.neighbor[t][at(i + 1)], past_ab = mesh_.neighbor[t][at(i + 2)];
    const int past_bd = mesh_.neighbor[u][at(k + 1)], past_dc = mesh_.neighbor[u][at(k + 2)];
    const bool fixed_ca = mesh_.constrained[t][at(i + 1)],
               fixed_ab = mesh_.constrained[t][at(i + 2)];
    const bool fixed_bd = mesh_.constrained[u][at(k + 1)],
               fixed_dc = mesh_.constrained[u][at(k + 2)];
    if (past_ca >= 0) mesh_.neighbor[past_ca][opposite(past_ca, t)] = u;
    if (past_bd >= 0) mesh_.neighbor[past_bd][opposite(past_bd, u)] = t;
    mesh_.triangles[t] = {a, b, d};
    mesh_.neighbor[t] = {past_bd, u, past_ab};
    mesh_.constrained[t] = {fixed_bd, false, fixed_ab};
    mesh_.triangles[u] = {a, d, c};
    mesh_.neighbor[u] = {past_dc, past_ca, t};
    mesh_.constrained[u] = {fixed_dc, fixed_ca, false};
  }

  PlanarTriangulation& mesh_;
};

// Rotates each triangle to begin with its lowest corner, then sorts the triangles by their corners.
void put_in_order(PlanarTriangulation& mesh) {
  const std::size_t n = mesh.triangles.size();
  for (std::size_t t = 0; t < n; ++t) {
    auto& corner = mesh.triangles[t];
    const auto turn = std::min_element(corner.begin(), corner.end()) - corner.begin();
    std::rotate(corner.begin(), corner.begin() + turn, corner.end());
    std::rotate(mesh.neighbor[t].begin(), mesh.neighbor[t].begin() + turn, mesh.neighbor[t].end());
    std::rotate(mesh.constrained[t].begin(), mesh.constrained[t].begin() + turn,
                mesh.constrained[t].end());
  }
  std::vector<int> order(n), number(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return mesh.triangles[a] < mesh.triangles[b]; });
  for (std::size_t k = 0; k < n; ++k) number[order[k]] = static_cast<int>(k);
  PlanarTriangulation sorted{.points = std::move(mesh.points), .is_as_given = mesh.is_as_given};
  for (const int t : order) {
    sorted.triangles.push_back(mesh.triangles[t]);
    sorted.constrained.push_back(mesh.constrained[t]);
    auto& around = sorted.neighbor.emplace_back(mesh.neighbor[t]);
    for (int& neighbor : around) neighbor = neighbor < 0 ? neighbor : number[neighbor];
  }
  mesh = std::move(sorted);
}

}  // namespace

PlanarTriangulation triangulate(const std::vector<Eigen::Vector2d>& points,
                                const std::vector<std::array<int, 2>>& constraints) {
  PlanarTriangulation result = backend::delaunay(points, constraints);
  CocircularFans(result).settle();
  put_in_order(result);
  return result;
}

}  // namespace lightwell
