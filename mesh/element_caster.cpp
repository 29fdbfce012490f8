#include "mesh/element_caster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "mesh/sphere_grid.h"
#include "scene/facet_textures.h"

namespace lightwell {
namespace {

using Eigen::Array4f;
using Eigen::Vector3d;

bool is_front_polygon(const PatchMesh& mesh, int patch) {
  const int facet = mesh.facet[mesh.first_element[patch]];
  return mesh.is_back[patch] == 0 && sphere_grid_of(mesh, facet) == nullptr;
}

// (alpha, beta) of QuadShape.
Eigen::Vector2d shape_of_quad(const PatchMesh& mesh, const std::array<int, 4>& c) {
  const Vector3d p0 = mesh.position(c[0]);
  const Vector3d x = mesh.position(c[1]) - p0, y = mesh.position(c[3]) - p0,
                 d = mesh.position(c[2]) - p0;
  const double xx = x.squaredNorm(), xy = x.dot(y), yy = y.squaredNorm();
  const double determinant = xx * yy - xy * xy;
  return {(yy * d.dot(x) - xy * d.dot(y)) / determinant,
          (xx * d.dot(y) - xy * d.dot(x)) / determinant};
}

// The ray caster meets a quad as the triangles (0,1,3) and (2,3,1), with u and v linear in each; so
// the point is v0 + a (v1 - v0) + b (v3 - v0), and the bilinear (s, t) of that point solves
//   a = s + (alpha - 1) s t,  b = t + (beta - 1) s t,   v2 - v0 = alpha (v1-v0) + beta (v3-v0).
Array4f quad_weights(double alpha, double beta, double u, double v) {
  constexpr double parallelogram = 1e-6;
  if (std::abs(alpha - 1.0) + std::abs(beta - 1.0) < parallelogram) {
    return Eigen::Array4d((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v).cast<float>();
  }
  double a = u, b = v;
  if (u + v > 1.0) {
    const double w1 = 1.0 - v, w3 = 1.0 - u, w2 = 1.0 - w1 - w3;
    a = w1 + alpha * w2;
    b = w3 + beta * w2;
  }
  // Newton from the parallelogram's answer; a convex quad has one root in the unit square.
  double s = u, t = v;
  constexpr int most_steps = 8;
  constexpr double converged = 1e-7;  // of the element; the next step would square it
  for (int step = 0; step < most_steps; ++step) {
    const double fs = s + (alpha - 1.0) * s * t - a, ft = t + (beta - 1.0) * s * t - b;
    if (std::abs(fs) + std::abs(ft) < converged) break;
    const double ss = 1.0 + (alpha - 1.0) * t, st = (alpha - 1.0) * s;
    const double ts = (beta - 1.0) * t, tt = 1.0 + (beta - 1.0) * s;
    const double det = ss * tt - st * ts;
    s -= (tt * fs - st * ft) / det;
    t -= (ss * ft - ts * fs) / det;
  }
  s = std::clamp(s, 0.0, 1.0);
  t = std::clamp(t, 0.0, 1.0);
  return Eigen::Array4d((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t).cast<float>();
}

// The same place seen from the other side, whose corners run (0, 3, 2, 1) or (0, 2, 1).
Array4f turned(const Array4f& w, bool is_triangle) {
  return is_triangle ? Array4f(w[0], w[2], w[1], 0.0f) : Array4f(w[0], w[3], w[2], w[1]);
}

}  // namespace

ElementCaster::ElementCaster(const PatchMesh& mesh)
    : mesh_(mesh),
      caster_(cast_geometry(mesh, elements_, quad_shapes_)),
      triangles_(caster_.triangle_count()),
      polygons_(triangles_ + caster_.quad_count()),
      hidden_(static_cast<std::size_t>(mesh.element_count()), 0) {
  for (int primitive = 0; primitive < polygons_; ++primitive) {
    hidden_[elements_[primitive]] =
        static_cast<std::uint8_t>((caster_.is_hidden(primitive, false) ? 1 : 0) |
                                  (caster_.is_hidden(primitive, true) ? 2 : 0));
  }
}

int ElementCaster::hidden_elements(int patch) const {
  const bool is_back = mesh_.is_back[patch] != 0;
  int count = 0;
  for (int e = mesh_.first_element[patch]; e < mesh_.first_element[patch + 1]; ++e) {
    count += is_hidden(is_back ? mesh_.twin[e] : e, is_back) ? 1 : 0;
  }
  return count;
}

// Primitives in RayCaster's order: triangles, quads, spheres.
CastGeometry ElementCaster::cast_geometry(const PatchMesh& mesh, std::vector<int>& elements,
                                          std::vector<QuadShape>& quad_shapes) {
  CastGeometry geometry;
  std::vector<int> number(mesh.vertex_count(), -1);
  const auto vertex = [&](int v) {
    if (number[v] < 0) {
      number[v] = static_cast<int>(geometry.vertices.size());
      geometry.vertices.push_back(mesh.position(v));
    }
    return number[v];
  };
  const auto add = [&](int element, int facet) {
    geometry.group.push_back(facet);
    elements.push_back(element);
  };
  const bool any_holes = mesh.textures && mesh.textures->has_holes();
  if (any_holes) {
    geometry.is_hole = [textures = mesh.textures](int facet, const Vector3d& point) {
      return textures->is_hole(facet, point);
    };
  }
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
          const Eigen::Vector2f shape = shape_of_quad(mesh, c).cast<float>();
          quad_shapes.push_back({shape.x(), shape.y()});
        }
        add(e, mesh.facet[e]);
        if (any_holes) geometry.has_holes.push_back(mesh.textures->has_holes(mesh.facet[e]));
      }
    }
  }
  for (std::size_t g = 0; g < mesh.sphere_grids.size(); ++g) {
    geometry.spheres.push_back(mesh.sphere_grids[g].sphere);
    add(static_cast<int>(g), mesh.sphere_grids[g].facet);
  }
  return geometry;
}

template <bool with_weights>
ElementHit ElementCaster::element_hit(const Ray& ray, const Hit& hit) const {
  if (hit.primitive < 0) return {};
  ElementHit result{.facet = hit.group,
                    .element = elements_[hit.primitive],
                    .from_back = hit.from_back,
                    .t = hit.t};
  const bool is_polygon = hit.primitive < polygons_;
  bool is_triangle = hit.primitive < triangles_;
  if (!with_weights && is_polygon) {
    // Nothing more to find out.
  } else if (is_triangle) {
    result.weights = {1.0f - hit.u - hit.v, hit.u, hit.v, 0.0f};
  } else if (is_polygon) {
    const QuadShape& shape = quad_shapes_[static_cast<std::size_t>(hit.primitive - triangles_)];
    result.weights = quad_weights(shape.alpha, shape.beta, hit.u, hit.v);
  } else {
    const SphereGrid& grid = mesh_.sphere_grids[result.element];
    const SpherePlace place =
        sphere_place(grid, ray.origin + hit.t * ray.direction - grid.sphere.center);
    result.element = grid.element[place.ring * grid.sectors + place.sector];
    result.weights = sphere_weights(grid, place);
    is_triangle = place.ring == 0 || place.ring == grid.rings - 1;
  }
  if (!hit.from_back) return result;
  result.element = mesh_.twin[result.element];
  if (!with_weights) return result;
  result.weights =
      result.element < 0 ? Array4f(Array4f::Zero()) : turned(result.weights, is_triangle);
  return result;
}

template <bool with_weights>
void ElementCaster::cast(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  assert(rays.size() == hits.size());
  constexpr std::size_t batch = 64;  // fits the stack and the first-level cache
  std::array<Hit, batch> buffer;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t count = std::min(batch, rays.size() - begin);
    caster_.closest_hits(rays.subspan(begin, count), std::span(buffer).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      hits[begin + i] = element_hit<with_weights>(rays[begin + i], buffer[i]);
    }
  }
}

void ElementCaster::closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  cast<true>(rays, hits);
}

void ElementCaster::closest_elements(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  cast<false>(rays, hits);
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
