#include "mesh/geometry/facet_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

template <class Visit>
void for_each_loop(const Facet& facet, Visit&& visit) {
  visit(facet.boundary);
  for (const auto& hole : facet.holes) visit(hole);
}

// Joining the two ends of an edge, or the two sides of a needle, would make a facet vanish. So the
// welding radius of a corner is at most these shares of the corner's shortest edge and of the
// thickness of its facets.
constexpr double weld_share_of_edge = 1e-3;
constexpr double weld_share_of_thickness = 0.1;

void add_loop(FacetPlane& plane, const std::vector<int>& loop, const std::vector<int>& welded,
              const WeldedPoints& points) {
  const int begin = plane.corner_count();
  for (int v : loop) {
    if (plane.corner_count() > begin && plane.point.back() == welded[v]) continue;
    plane.point.push_back(welded[v]);
  }
  while (plane.corner_count() > begin + 1 && plane.point.back() == plane.point[begin]) {
    plane.point.pop_back();
  }
  for (int i = begin; i < plane.corner_count(); ++i) plane.corner.push_back(points[plane.point[i]]);
  plane.loop_begin.push_back(plane.corner_count());
}

// Returns the edge direction that, with its perpendicular, carries most of the boundary's length;
// the first edge wins ties. In a right triangle the direction is that of a leg, not of the
// hypotenuse.
Vector3d frame_direction(const FacetPlane& plane) {
  constexpr double aligned = 0.01;  // radians
  Vector3d best = Vector3d::Zero();
  double best_length = 0.0;
  int tried = 0;
  plane.for_each_edge([&](int i, int j) {
    constexpr int most_tried = 64;  // a disk of many edges has no direction worth the search
    if (++tried > most_tried) return;
    const Vector3d d = (plane.corner[j] - plane.corner[i]).normalized();
    const Vector3d across = plane.normal.cross(d);
    double length = 0.0;
    plane.for_each_edge([&](int a, int b) {
      const Vector3d e = plane.corner[b] - plane.corner[a];
      const double l = e.norm();
      if (std::min(std::abs(e.dot(d)), std::abs(e.dot(across))) < aligned * l) length += l;
    });
    constexpr double clearly = 1.0 + 1e-9;
    if (length > clearly * best_length) {
      best_length = length;
      best = d;
    }
  });
  return best;
}

void set_frame(FacetPlane& plane) {
  const int boundary = plane.loop_begin[1];
  // The mean is taken relative to a corner, so a coordinate that all corners share stays exact.
  Vector3d mean = Vector3d::Zero();
  for (int i = 0; i < boundary; ++i) mean += (plane.corner[i] - plane.corner[0]) / boundary;
  plane.origin = plane.corner[0] + mean;
  const Vector3d along = frame_direction(plane);
  plane.axis_x = (along - along.dot(plane.normal) * plane.normal).normalized();
  plane.axis_y = plane.normal.cross(plane.axis_x);
  for (const Vector3d& p : plane.corner) {
    plane.xy.push_back(plane.project(p));
    plane.box.extend(p);
  }
}

}  // namespace

std::vector<double> weld_radii(const PolygonMesh& mesh, double tolerance) {
  std::vector<double> radius(mesh.vertices.size(), tolerance);
  for (const Facet& facet : mesh.facets) {
    double boundary = 0.0;
    for_each_loop(facet, [&](const std::vector<int>& loop) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int a = loop[i], b = loop[(i + 1) % loop.size()];
        const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
        if (!(length > 0.0)) continue;
        boundary += length;
        radius[a] = std::min(radius[a], weld_share_of_edge * length);
        radius[b] = std::min(radius[b], weld_share_of_edge * length);
      }
    });
    const double thickness = 2.0 * facet_area(mesh, facet) / boundary;
    for_each_loop(facet, [&](const std::vector<int>& loop) {
      for (int v : loop) radius[v] = std::min(radius[v], weld_share_of_thickness * thickness);
    });
  }
  return radius;
}

double FacetPlane::area() const {
  double twice = 0.0;
  for_each_edge([&](int i, int j) { twice += xy[i].x() * xy[j].y() - xy[j].x() * xy[i].y(); });
  return 0.5 * twice;
}

double FacetPlane::boundary_length() const {
  double length = 0.0;
  for_each_edge([&](int i, int j) { length += (xy[j] - xy[i]).norm(); });
  return length;
}

double segment_distance(const Vector2d& q, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double squared = d.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(d.dot(q - a) / squared, 0.0, 1.0) : 0.0;
  return (q - a - t * d).norm();
}

bool FacetPlane::contains(const Vector2d& q, double tolerance) const {
  bool on_boundary = false, inside = false;
  for_each_edge([&](int i, int j) {
    const Vector2d &a = xy[i], &b = xy[j];
    if (segment_distance(q, a, b) <= tolerance) on_boundary = true;
    if ((a.y() > q.y()) != (b.y() > q.y())) {
      const double x = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > q.x()) inside = !inside;
    }
  });
  return on_boundary || inside;
}

bool FacetPlane::winds_round(const Vector2d& q) const {
  std::vector<int> winding(static_cast<std::size_t>(loop_count()), 0);
  for (std::size_t l = 0; l < winding.size(); ++l) {
    const auto begin = static_cast<std::size_t>(loop_begin[l]),
               end = static_cast<std::size_t>(loop_begin[l + 1]);
    for (std::size_t i = begin; i < end; ++i) {
      const Vector2d &a = xy[i], &b = xy[i + 1 < end ? i + 1 : begin];
      if ((a.y() > q.y()) == (b.y() > q.y())) continue;
      const double x = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > q.x()) winding[l] += b.y() > a.y() ? 1 : -1;
    }
  }
  return winding[0] != 0 &&
         std::all_of(winding.begin() + 1, winding.end(), [](int w) { return w == 0; });
}

std::vector<FacetPlane> facet_planes(const Scene& scene, WeldedPoints& points) {
  std::vector<FacetPlane> planes;
  int number = 0;
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[s].shape);
    if (!mesh) {
      ++number;
      continue;
    }
    const std::vector<double> radius = weld_radii(*mesh, points.tolerance());
    std::vector<int> welded(mesh->vertices.size(), -1);
    for (const Facet& facet : mesh->facets) {
      FacetPlane plane{.facet = number++,
                       .surface = s,
                       .normal = facet_normal(*mesh, facet),
                       .weld_tolerance = points.tolerance()};
      for_each_loop(facet, [&](const std::vector<int>& loop) {
        for (int v : loop) {
          if (welded[v] < 0) welded[v] = points.add(mesh->vertices[v], radius[v]);
        }
        add_loop(plane, loop, welded, points);
      });
      set_frame(plane);
      planes.push_back(std::move(plane));
    }
  }
  return planes;
}

}  // namespace lightwell
