#include "radiosity/form_factors/hemicube_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/patches/inset.h"
#include "mesh/patches/round_grid.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Area centroid of a flat element, from its triangles.
Vector3d centroid(const PatchMesh& mesh, int element) {
  const auto& c = mesh.corners[element];
  const Vector3d a = mesh.position(c[0]);
  Vector3d sum = Vector3d::Zero();
  double area = 0.0;
  for (int i = 2; i < mesh.corner_count(element); ++i) {
    const Vector3d b = mesh.position(c[i - 1]), d = mesh.position(c[i]);
    const double part = (b - a).cross(d - a).norm();
    area += part;
    sum += part * (a + b + d) / 3.0;
  }
  return area > 0.0 ? Vector3d(sum / area) : a;
}

bool contains(const PatchMesh& mesh, int element, const Vector3d& normal, const Vector3d& point) {
  // Relative to the element's area: points on an edge are inside.
  constexpr double rounding = 1e-12;
  const int n = mesh.corner_count(element);
  for (int k = 0; k < n; ++k) {
    const Vector3d a = mesh.position(mesh.corners[element][k]);
    const Vector3d b = mesh.position(mesh.corners[element][(k + 1) % n]);
    if (!(normal.dot((b - a).cross(point - a)) >= -rounding * mesh.element_area[element])) {
      return false;
    }
  }
  return true;
}

PatchPoint center_nearest_to(const PatchMesh& mesh, int patch, const Vector3d& point) {
  PatchPoint nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    const PatchPoint center = element_center(mesh, e);
    const double distance = (center.position - point).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = center;
    }
  }
  return nearest;
}

PatchPoint point_on_polygon(const PatchMesh& mesh, int patch) {
  Vector3d middle = Vector3d::Zero();
  double area = 0.0;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    middle += mesh.element_area[e] * centroid(mesh, e);
    area += mesh.element_area[e];
  }
  middle /= area;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    PatchPoint eye_point = element_center(mesh, e);
    if (!contains(mesh, e, eye_point.normal, middle)) continue;
    // Slightly inside the element, as in PatchSampler: the centroid of an L may be its inner
    // corner, where another surface may stand.
    constexpr double least_share = 1e-4;
    eye_point.position = middle + inset_share(mesh, e, least_share) * (eye_point.position - middle);
    return eye_point;
  }
  return center_nearest_to(mesh, patch, middle);
}

PatchPoint point_on_round(const PatchMesh& mesh, int patch, const RoundGrid& grid) {
  Vector3d middle = Vector3d::Zero();
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    middle += mesh.element_area[e] / mesh.area[patch] * element_center(mesh, e).position;
  }
  middle = nearest_on(grid.shape, middle);
  const RoundGridPoint place = round_grid_point(grid, middle);
  const int front = grid.element[place.ring * grid.sectors + place.sector];
  const int element = mesh.is_back[patch] != 0 ? mesh.twin[front] : front;
  if (element >= 0 && mesh.patch[element] == patch) {
    return {
        .element = element, .position = middle, .normal = round_normal(mesh, grid, patch, middle)};
  }
  return center_nearest_to(mesh, patch, middle);
}

// Moves the point from the exact shape onto the flat element.
void drop_onto_element(const PatchMesh& mesh, PatchPoint& eye_point) {
  const auto& c = mesh.corners[eye_point.element];
  const int n = mesh.corner_count(eye_point.element);
  eye_point.position = Vector3d::Zero();
  for (int i = 0; i < n; ++i) eye_point.position += mesh.position(c[i]) / n;
  const Vector3d p0 = mesh.position(c[0]);
  eye_point.normal = (mesh.position(c[1]) - p0).cross(mesh.position(c[2]) - p0).normalized();
}

}  // namespace

HemicubeEye hemicube_eye(const PatchMesh& mesh, int patch, bool on_elements) {
  const RoundGrid* grid = round_grid_of(mesh, mesh.facet[mesh.first_element[patch]]);
  PatchPoint eye_point = grid ? point_on_round(mesh, patch, *grid) : point_on_polygon(mesh, patch);
  HemicubeEye eye{.element = eye_point.element,
                  .facet = mesh.facet[eye_point.element],
                  .inside = grid && sees_itself(grid->shape, mesh.is_back[patch] != 0)};
  if (eye.inside && on_elements) drop_onto_element(mesh, eye_point);
  eye.position = eye_point.position;
  Vector3d x, y;
  tangent_frame(eye_point.normal, x, y);
  const double turn =
      2.0 * std::numbers::pi *
      random_uniform(random_key(static_cast<std::uint64_t>(patch), RandomPurpose::hemicube_turn));
  eye.frame << std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x,
      eye_point.normal;
  return eye;
}

void cast_hemicube(const ElementCaster& caster, const HemicubeEye& eye, const HemicubeCells& cells,
                   std::span<int> items) {
  constexpr int batch = 64;
  std::array<Ray, batch> ray;
  std::array<ElementHit, batch> hit;
  const int n = cells.resolution();
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    for (int row = 0; row < cells.rows(f); ++row) {
      for (int begin = 0; begin < n; begin += batch) {
        const int count = std::min(batch, n - begin);
        const auto size = static_cast<std::size_t>(count);
        for (int k = 0; k < count; ++k) {
          ray[k] = {.origin = eye.position,
                    .direction = eye.frame * cells.direction(f, row, begin + k),
                    .origin_group = eye.facet};
        }
        caster.closest_hits({ray.data(), size}, {hit.data(), size});
        int* item = items.data() + cells.first_cell(f) + row * n + begin;
        for (int k = 0; k < count; ++k) {
          item[k] = hit[k].facet < 0      ? hemicube_item::nothing
                    : hit[k].element >= 0 ? hit[k].element
                                          : hemicube_item::black_back(hit[k].facet);
        }
      }
    }
  }
}

}  // namespace lightwell
