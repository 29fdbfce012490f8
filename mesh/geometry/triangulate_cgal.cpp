#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <set>

#include "mesh/geometry/triangulation_backend.h"

namespace lightwell::backend {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

constexpr int unnumbered = -1;

Kernel::Point_2 point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

}  // namespace

PlanarTriangulation delaunay(const std::vector<Eigen::Vector2d>& points,
                             const std::vector<std::array<int, 2>>& constraints) {
  Triangulation delaunay;
  std::vector<Triangulation::Vertex_handle> handles;
  handles.reserve(points.size());
  Triangulation::Face_handle hint{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int before = static_cast<int>(delaunay.number_of_vertices());
    const auto vertex = delaunay.insert(point(points[i]), hint);
    if (static_cast<int>(delaunay.number_of_vertices()) > before) {
      vertex->info() = static_cast<int>(i);
    }
    hint = vertex->face();
    handles.push_back(vertex);
  }
  const std::size_t given = delaunay.number_of_vertices();
  for (const auto& [a, b] : constraints) {
    if (handles[a] != handles[b]) delaunay.insert_constraint(handles[a], handles[b]);
  }

  PlanarTriangulation result{.points = points};
  result.is_as_given = given == points.size() && delaunay.number_of_vertices() == given;
  if (delaunay.number_of_vertices() > given) {
    const std::set<Triangulation::Vertex_handle> known(handles.begin(), handles.end());
    for (const auto& vertex : delaunay.finite_vertex_handles()) {
      if (known.contains(vertex)) continue;
      vertex->info() = static_cast<int>(result.points.size());
      result.points.emplace_back(vertex->point().x(), vertex->point().y());
    }
  }
  int count = 0;
  for (const auto& face : delaunay.all_face_handles()) face->info() = unnumbered;
  for (const auto& face : delaunay.finite_face_handles()) face->info() = count++;
  for (const auto& face : delaunay.finite_face_handles()) {
    auto& triangle = result.triangles.emplace_back();
    auto& neighbor = result.neighbor.emplace_back();
    auto& constrained = result.constrained.emplace_back();
    for (int i = 0; i < 3; ++i) {
      triangle[i] = face->vertex(i)->info();
      neighbor[i] = face->neighbor(i)->info();
      constrained[i] = face->is_constrained(i);
    }
  }
  return result;
}

int side_of_circle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d) {
  return CGAL::side_of_oriented_circle(point(a), point(b), point(c), point(d));
}

}  // namespace lightwell::backend
