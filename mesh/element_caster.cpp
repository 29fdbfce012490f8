#include "mesh/element_caster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "mesh/sphere_grid.h"

namespace lightwell {
namespace {

using Eigen::Array4f;
using Eigen::Vector3d;

bool is_front_polygon(const PatchMesh& mesh, int patch) {
  return mesh.is_back[patch] == 0 && sphere_grid_of(mesh, mesh.facet[patch]) == nullptr;
}

// Primitives in RayCaster's order: triangles, quads, spheres. `element_of_primitive` is filled.
CastGeometry cast_geometry(const PatchMesh& mesh, std::vector<int>& element_of_primitive) {
  CastGeometry geometry;
  std::vector<int> number(mesh.vertex_count(), -1);
  const auto vertex = [&](int v) {
    if (number[v] < 0) {
      number[v] = static_cast<int>(geometry.vertices.size());
      geometry.vertices.push_back(mesh.position(v));
    }
    return number[v];
  };
  for (const int corner_count : {3, 4}) {
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (!is_front_polygon(mesh, p)) continue;
      for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
        if (mesh.corner_count(e) != corner_count) continue;
        const auto& c = mesh.corners[e];
        if (corner_count == 3) {
          geometry.triangles.push_back({vertex(c[0]), vertex(c[1]), vertex(c[2])});
        } else {
          geometry.quads.push_back({vertex(c[0]), vertex(c[1]), vertex(c[2]), vertex(c[3])});
        }
        geometry.group.push_back(mesh.facet[p]);
        element_of_primitive.push_back(e);
      }
    }
  }
  for (std::size_t g = 0; g < mesh.sphere_grids.size(); ++g) {
    geometry.spheres.push_back(mesh.sphere_grids[g].sphere);
    geometry.group.push_back(mesh.sphere_grids[g].facet);
    element_of_primitive.push_back(-1 - static_cast<int>(g));
  }
  return geometry;
}

// The ray caster meets a quad as the triangles (0,1,3) and (2,3,1), with u and v linear in each;
// so the point is v0 + a (v1 - v0) + b (v3 - v0), and the bilinear (s, t) of that point solves
//   a = s + (alpha - 1) s t,  b = t + (beta - 1) s t,   v2 - v0 = alpha (v1-v0) + beta (v3-v0).
Array4f quad_weights(const PatchMesh& mesh, const std::array<int, 4>& c, double u, double v) {
  const Vector3d p0 = mesh.position(c[0]);
  const Vector3d x = mesh.position(c[1]) - p0, y = mesh.position(c[3]) - p0,
                 d = mesh.position(c[2]) - p0;
  const double xx = x.squaredNorm(), xy = x.dot(y), yy = y.squaredNorm();
  const double determinant = xx * yy - xy * xy;
  const double alpha = (yy * d.dot(x) - xy * d.dot(y)) / determinant;
  const double beta = (xx * d.dot(y) - xy * d.dot(x)) / determinant;
  double a = u, b = v;
  if (u + v > 1.0) {
    const double w1 = 1.0 - v, w3 = 1.0 - u, w2 = 1.0 - w1 - w3;
    a = w1 + alpha * w2;
    b = w3 + beta * w2;
  }
  // Newton from the parallelogram's answer; a convex quad has one root in the unit square.
  double s = u, t = v;
  constexpr int most_steps = 8;
  constexpr double converged = 1e-9;
  for (int step = 0; step < most_steps; ++step) {
    const double fs = s + (alpha - 1.0) * s * t - a, ft = t + (beta - 1.0) * s * t - b;
    const double ss = 1.0 + (alpha - 1.0) * t, st = (alpha - 1.0) * s;
    const double ts = (beta - 1.0) * t, tt = 1.0 + (beta - 1.0) * s;
    const double det = ss * tt - st * ts;
    const double ds = (tt * fs - st * ft) / det, dt = (ss * ft - ts * fs) / det;
    s -= ds;
    t -= dt;
    if (std::abs(ds) + std::abs(dt) < converged) break;
  }
  s = std::clamp(s, 0.0, 1.0);
  t = std::clamp(t, 0.0, 1.0);
  return Eigen::Array4d((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t).cast<float>();
}

// The same place seen from the other side, whose corners run (0, 3, 2, 1) or (0, 2, 1).
Array4f turned(const Array4f& w, bool is_triangle) {
  return is_triangle ? Array4f(w[0], w[2], w[1], 0.0f) : Array4f(w[0], w[3], w[2], w[1]);
}

ElementHit element_hit(const PatchMesh& mesh, const std::vector<int>& element_of_primitive,
                       const Ray& ray, const Hit& hit) {
  if (hit.primitive < 0) return {};
  ElementHit result{.from_back = hit.from_back, .t = hit.t};
  int element = element_of_primitive[hit.primitive];
  Array4f weights;
  if (element < 0) {
    const SphereGrid& grid = mesh.sphere_grids[-1 - element];
    const SpherePlace place =
        sphere_place(grid, ray.origin + hit.t * ray.direction - grid.sphere.center);
    element = grid.element[place.ring * grid.sectors + place.sector];
    weights = sphere_weights(grid, place);
  } else if (mesh.corner_count(element) == 3) {
    weights = {1.0f - hit.u - hit.v, hit.u, hit.v, 0.0f};
  } else {
    weights = quad_weights(mesh, mesh.corners[element], hit.u, hit.v);
  }
  result.facet = mesh.facet[mesh.patch[element]];
  result.element = hit.from_back ? mesh.twin[element] : element;
  if (result.element >= 0) {
    result.weights = hit.from_back ? turned(weights, mesh.corner_count(element) == 3) : weights;
  }
  return result;
}

}  // namespace

ElementCaster::ElementCaster(const PatchMesh& mesh)
    : mesh_(mesh), caster_(cast_geometry(mesh, element_of_primitive_)) {}

void ElementCaster::closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  assert(rays.size() == hits.size());
  constexpr std::size_t batch = 64;  // fits the stack and the first-level cache
  std::array<Hit, batch> buffer;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t count = std::min(batch, rays.size() - begin);
    caster_.closest_hits(rays.subspan(begin, count), std::span(buffer).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      hits[begin + i] = element_hit(mesh_, element_of_primitive_, rays[begin + i], buffer[i]);
    }
  }
}

Spectrum interpolate(const PatchMesh& mesh, const BandArray& vertex_values, const ElementHit& hit) {
  Spectrum value = Spectrum::Zero(vertex_values.cols());
  if (hit.element < 0) return value;
  const auto& c = mesh.corners[hit.element];
  for (int i = 0; i < mesh.corner_count(hit.element); ++i) {
    value += hit.weights[i] * vertex_values.row(c[i]).transpose();
  }
  return value;
}

}  // namespace lightwell
