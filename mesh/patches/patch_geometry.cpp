#include <Eigen/Geometry>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mesh/patches/inset.h"
#include "mesh/patches/parted_topology.h"
#include "mesh/patches/patch_mesh.h"
#include "mesh/patches/round_grid.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Twice the area of a triangle, along the normal.
Vector3d outline_area_vector(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a);
}

Vector3d element_area_vector(const PatchMesh& mesh, int element) {
  const auto& c = mesh.corners[element];
  const Vector3d p0 = mesh.position(c[0]), p1 = mesh.position(c[1]), p2 = mesh.position(c[2]);
  if (c[3] < 0) return outline_area_vector(p0, p1, p2);
  return (p2 - p0).cross(mesh.position(c[3]) - p1);
}

Vector3d mean_of_corners(const PatchMesh& mesh, int element) {
  Vector3d sum = Vector3d::Zero();
  const int n = mesh.corner_count(element);
  for (int i = 0; i < n; ++i) sum += mesh.position(mesh.corners[element][i]);
  return sum / n;
}

const RoundGrid* round_of_element(const PatchMesh& mesh, int element) {
  return round_grid_of(mesh, mesh.facet[element]);
}

// Sets vertex normals: those of the exact shape on round shapes; elsewhere the mean of the
// faces around, weighted by area.
void set_vertex_normals(PatchMesh& mesh, int vertex_count) {
  mesh.vertex_normal.assign(vertex_count, Vector3d::Zero());
  const int patches = mesh.patch_count();
  for (int p = 0; p < patches; ++p) {
    const RoundGrid* grid = round_grid_of(mesh, mesh.facet[mesh.first_element[p]]);
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const Vector3d area = element_area_vector(mesh, e);
      for (int i = 0; i < mesh.corner_count(e); ++i) {
        const int v = mesh.corners[e][i];
        if (grid) {
          mesh.vertex_normal[v] = round_normal(mesh, *grid, p, mesh.position(v));
        } else {
          mesh.vertex_normal[v] += area;
        }
      }
    }
  }
  for (Vector3d& n : mesh.vertex_normal) n.normalize();
}

// True if the face can be added. OpenMesh refuses other faces too, but with a message on standard
// error.
bool fits(const HalfedgeMesh& elements, const std::array<HalfedgeMesh::VertexHandle, 4>& face,
          std::size_t corner_count) {
  if (corner_count < 3) return false;
  for (std::size_t i = 0; i < corner_count; ++i) {
    if (!elements.is_boundary(face[i])) return false;
    const auto edge = elements.find_halfedge(face[i], face[(i + 1) % corner_count]);
    if (edge.is_valid() && !elements.is_boundary(edge)) return false;
  }
  return true;
}

// Silences OpenMesh, which prints why it refuses a face.
class QuietOpenMesh {
 public:
  QuietOpenMesh() { omerr().disable(); }
  ~QuietOpenMesh() { omerr().enable(); }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
};

// Begins a topology of vertices alone.
void begin_topology(PatchMesh& mesh, const std::vector<Vector3d>& positions) {
  mesh.elements->clear();
  // Euler: a connected mesh has one edge less than vertices and faces together, and one more for
  // every hole.
  const std::size_t count = positions.size() + mesh.corners.size();
  mesh.elements->reserve(positions.size(), count + count / 16, mesh.corners.size());
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : positions) {
    mesh.elements->add_vertex({p.x(), p.y(), p.z()});
    box.extend(p);
  }
  mesh.least_inset = box.isEmpty() ? 0.0 : least_inset(box.diagonal().norm());
}

// Adds an element, whose vertices exist; false if it does not fit its neighbours.
bool add_face(PatchMesh& mesh, std::size_t element) {
  std::array<HalfedgeMesh::VertexHandle, 4> face;
  std::size_t n = 0;
  for (const int v : mesh.corners[element]) {
    if (v < 0) break;
    face[n++] = HalfedgeMesh::VertexHandle(v);
  }
  return fits(*mesh.elements, face, n) && mesh.elements->add_face(face.data(), n).is_valid();
}

}  // namespace

PatchPoint element_center(const PatchMesh& mesh, int element) {
  PatchPoint point{.element = element, .position = mean_of_corners(mesh, element)};
  if (const RoundGrid* grid = round_of_element(mesh, element)) {
    point.position = nearest_on(grid->shape, point.position);
    point.normal = round_normal(mesh, *grid, mesh.patch[element], point.position);
  } else {
    point.normal = element_area_vector(mesh, element).normalized();
  }
  return point;
}

void build_topology(PatchMesh& mesh, const std::vector<Vector3d>& positions) {
  begin_topology(mesh, positions);
  const int vertex_count = static_cast<int>(positions.size());
  for (std::size_t e = 0; e < mesh.corners.size(); ++e) {
    for (const int v : mesh.corners[e]) {
      if (v < vertex_count) continue;
      throw std::runtime_error("element " + std::to_string(e) + " of the mesh names vertex " +
                               std::to_string(v) + ", but there are only " +
                               std::to_string(vertex_count));
    }
    if (!add_face(mesh, e)) {
      throw std::runtime_error("element " + std::to_string(e) +
                               " of the mesh does not fit its neighbours: more than two elements "
                               "share an edge, or two run along it in one direction");
    }
  }
  set_vertex_normals(mesh, vertex_count);
}

void build_parted_topology(PatchMesh& mesh, const std::vector<Vector3d>& positions) {
  const QuietOpenMesh quiet;
  begin_topology(mesh, positions);
  int vertex_count = static_cast<int>(positions.size());
  for (std::size_t e = 0; e < mesh.corners.size(); ++e) {
    if (add_face(mesh, e)) continue;
    for (int& v : mesh.corners[e]) {
      if (v < 0) break;
      const auto old = static_cast<std::size_t>(v);
      mesh.elements->add_vertex(mesh.elements->point(HalfedgeMesh::VertexHandle(v)));
      mesh.at_reflex_corner.push_back(mesh.at_reflex_corner[old]);
      v = vertex_count++;
    }
    if (!add_face(mesh, e)) {
      throw std::runtime_error("element " + std::to_string(e) + " of the mesh repeats a corner");
    }
  }
  set_vertex_normals(mesh, vertex_count);
}

std::vector<int> vertex_patches(const PatchMesh& mesh) {
  std::vector<int> patch(mesh.vertex_count(), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) patch[mesh.corners[e][c]] = mesh.patch[e];
  }
  return patch;
}

std::vector<int> vertex_elements(const PatchMesh& mesh) {
  // Refinement leaves areas of a 16th beside each other, and halves some of them.
  constexpr double least_share = 1.0 / 64.0;
  std::vector<double> largest(static_cast<std::size_t>(mesh.vertex_count()), 0.0);
  const auto for_each_corner = [&](auto&& visit) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int c = 0; c < mesh.corner_count(e); ++c) {
        visit(e, mesh.corners[e][c], mesh.element_area[e]);
      }
    }
  };
  for_each_corner([&](int, int v, double area) { largest[v] = std::max(largest[v], area); });
  std::vector<int> element(static_cast<std::size_t>(mesh.vertex_count()), -1);
  for_each_corner([&](int e, int v, double area) {
    if (element[v] < 0 && area >= least_share * largest[v]) element[v] = e;
  });
  return element;
}

}  // namespace lightwell
