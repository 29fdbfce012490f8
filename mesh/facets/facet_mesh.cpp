#include "mesh/facets/facet_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/contacts/contact_chains.h"
#include "mesh/facets/free_mesh.h"
#include "mesh/geometry/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Interpolates between two points. A coordinate that both share stays exact, so a wall at x = 1.9
// has no vertex beyond.
Vector3d between(const Vector3d& a, const Vector3d& b, double t) {
  return a + t * (b - a);
}

void make_element(const std::vector<int>& loop, const std::vector<Vector3d>& points,
                  FacetMesh& mesh) {
  const int n = static_cast<int>(loop.size());
  mesh.corners.push_back({0, 1, 2, n == 4 ? 3 : -1});
  mesh.first_element.push_back(1);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.position.push_back(points[loop[i]]);
    mesh.border.push_back({{i, j}, {loop[i], loop[j]}});
  }
}

// Makes a facet that is no larger than an element one element. False if the facet is larger,
// contains lines, or has a bad angle.
bool make_single_element(const FacetPlane& plane, const FacetOutline& outline,
                         const std::vector<Vector3d>& points, FacetMesh& mesh) {
  if (outline.loops.size() != 1 || outline.has_lines()) return false;
  const std::vector<int>& loop = outline.loops.front();
  const int n = static_cast<int>(loop.size());
  if (n != 3 && n != 4) return false;
  std::array<Vector2d, 4> q;
  for (int i = 0; i < n; ++i) q[i] = plane.project(points[loop[i]]);
  // Angles of 11.5 to 168.5 degrees. A rhombus of this sine has the aspect ratio 5 and its halves
  // 3.2 (see ElementShape). Values from 0.05 to 0.5 change at most 9 of the 164 290 front elements
  // of a furnished room.
  constexpr double least_sine = 0.2;
  if (n == 3 && !(cross(q[1] - q[0], q[2] - q[0]) > 0.0)) return false;
  if (n == 4 && !(quad_quality(q[0], q[1], q[2], q[3]) > least_sine)) return false;
  make_element(loop, points, mesh);
  return true;
}

// Returns the boundary of a four-sided facet as four chains of points, each without its last point.
// Empty if the facet is not four-sided, too oblique for a grid, or divided too unevenly.
std::vector<std::vector<int>> four_sides(const FacetPlane& plane, const std::vector<int>& loop,
                                         const std::vector<Vector3d>& points) {
  const int n = static_cast<int>(loop.size());
  std::vector<Vector2d> q(n);
  for (int i = 0; i < n; ++i) q[i] = plane.project(points[loop[i]]);
  std::vector<int> turns;
  for (int i = 0; i < n; ++i) {
    const Vector2d in = (q[i] - q[(i + n - 1) % n]).normalized();
    const Vector2d out = (q[(i + 1) % n] - q[i]).normalized();
    // Sines: a turn below 1 degree is straight, and corners have angles of 30 to 150 degrees.
    // Measured on rhombi of 5 to 20 elements per edge: at 28 degrees a triangulation has the least
    // angle of a grid with 17 to 46 % fewer elements; at 45 degrees its least angle is 24 to 37.
    constexpr double straight = 0.02, least_sine = 0.5;
    const double sine = cross(in, out);
    if (std::abs(sine) < straight && in.dot(out) > 0.0) continue;
    if (!(sine > least_sine)) return {};  // reflex, or too oblique
    turns.push_back(i);
  }
  if (turns.size() != 4) return {};
  std::vector<std::vector<int>> sides(4);
  for (int s = 0; s < 4; ++s) {
    double shortest = INFINITY, longest = 0.0;
    for (int i = turns[s]; i != turns[(s + 1) % 4]; i = (i + 1) % n) {
      sides[s].push_back(loop[i]);
      const double length = (q[(i + 1) % n] - q[i]).norm();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    // A single short piece on the boundary would make a row of slivers through the whole facet.
    constexpr double uneven = 2.5;
    if (longest > uneven * shortest) return {};
  }
  if (sides[0].size() != sides[2].size() || sides[1].size() != sides[3].size()) return {};
  return sides;
}

// Makes a grid over the unit square, mapped to the facet by the Coons patch of the four sides
// (bilinear where the sides are divided evenly). False if the facet is not suited.
bool make_grid(const FacetPlane& plane, const FacetOutline& outline,
               const std::vector<Vector3d>& points, const FacetSize& size, FacetMesh& mesh) {
  if (outline.loops.size() != 1 || outline.has_lines() || size.graded) return false;
  const auto sides = four_sides(plane, outline.loops.front(), points);
  if (sides.empty()) return false;
  const int nx = static_cast<int>(sides[0].size()), ny = static_cast<int>(sides[1].size());
  // The boundary points of column i or row j; sides 2 and 3 run backwards.
  const auto bottom = [&](int i) { return i < nx ? sides[0][i] : sides[1][0]; };
  const auto right = [&](int j) { return j < ny ? sides[1][j] : sides[2][0]; };
  const auto top = [&](int i) { return i > 0 ? sides[2][nx - i] : sides[3][0]; };
  const auto left = [&](int j) { return j > 0 ? sides[3][ny - j] : sides[0][0]; };
  const auto node = [&](int i, int j) {
    return j == 0 ? bottom(i) : j == ny ? top(i) : i == 0 ? left(j) : i == nx ? right(j) : -1;
  };
  const auto vertex = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      if (const int p = node(i, j); p >= 0) {
        mesh.position.push_back(points[p]);
        continue;
      }
      const double s = static_cast<double>(i) / nx, t = static_cast<double>(j) / ny;
      mesh.position.push_back(between(points[bottom(i)], points[top(i)], t) +
                              (between(points[left(j)], points[right(j)], s) -
                               between(between(points[bottom(0)], points[top(0)], t),
                                       between(points[bottom(nx)], points[top(nx)], t), s)));
    }
  }
  const int k = size.cut.elements_per_edge;
  const int columns = (nx + k - 1) / k, rows = (ny + k - 1) / k;
  // Block c of m covers the cells ceil(c n / m) .. ceil((c + 1) n / m) - 1. With m = ceil(n / k)
  // these are exactly k cells where k divides n.
  const auto block = [](int c, int m, int n) { return (c * n + m - 1) / m; };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      for (int j = block(r, rows, ny); j < block(r + 1, rows, ny); ++j) {
        for (int i = block(c, columns, nx); i < block(c + 1, columns, nx); ++i) {
          const std::array<int, 4> cell{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1),
                                        vertex(i, j + 1)};
          std::array<Vector2d, 4> q;
          for (int v = 0; v < 4; ++v) q[v] = plane.project(mesh.position[cell[v]]);
          // Angles of 20 to 160 degrees. The quality is the scaled Jacobian, of which Verdict
          // accepts 0.3 and more (Stimpson et al. 2007). Values from 0.1 to 0.5 change at most 4 of
          // the 164 290 front elements of a furnished room.
          constexpr double least_sine = 0.35;
          if (!(quad_quality(q[0], q[1], q[2], q[3]) > least_sine)) {
            mesh = {};
            return false;
          }
          mesh.corners.push_back(cell);
        }
      }
      mesh.first_element.push_back(static_cast<int>(mesh.corners.size()));
    }
  }
  const auto add_border = [&](int i, int j, int i2, int j2) {
    mesh.border.push_back({{vertex(i, j), vertex(i2, j2)}, {node(i, j), node(i2, j2)}});
  };
  for (int i = 0; i < nx; ++i) add_border(i, 0, i + 1, 0);
  for (int j = 0; j < ny; ++j) add_border(nx, j, nx, j + 1);
  for (int i = nx; i > 0; --i) add_border(i, ny, i - 1, ny);
  for (int j = ny; j > 0; --j) add_border(0, j, 0, j - 1);
  return true;
}

// True if the elements add up to the polygon. Points within the tolerance of the boundary were made
// part of the boundary, which changes the area.
bool covers(const FacetPlane& plane, const FacetMesh& mesh) {
  if (mesh.corners.empty()) return false;  // a needle has less area than the tolerance allows
  double area = 0.0;
  for (const auto& c : mesh.corners) {
    const Vector3d& a = mesh.position[c[0]];
    for (int i = 1; i < (c[3] < 0 ? 2 : 3); ++i) {
      const Vector3d part = (mesh.position[c[i]] - a).cross(mesh.position[c[i + 1]] - a);
      area += 0.5 * part.dot(plane.normal);
    }
  }
  constexpr double rounding = 1e-9;
  const double moved = plane.weld_tolerance * plane.boundary_length();
  return std::abs(area - plane.area()) <= moved + rounding * plane.area();
}

// True if no element is folded up by points that lie off the plane by the welding tolerance.
bool is_upright(const FacetPlane& plane, const FacetMesh& mesh) {
  for (const auto& c : mesh.corners) {
    const Vector3d& a = mesh.position[c[0]];
    for (int i = 1; i < (c[3] < 0 ? 2 : 3); ++i) {
      const Vector3d part = (mesh.position[c[i]] - a).cross(mesh.position[c[i + 1]] - a);
      constexpr double least_cosine = 0.5;
      if (!(part.dot(plane.normal) > least_cosine * part.norm())) return false;
    }
  }
  return true;
}

bool is_sound(const FacetPlane& plane, const FacetMesh& mesh) {
  return covers(plane, mesh) && is_upright(plane, mesh);
}

// The smallest sine of all angles of the elements.
double least_sine(const FacetPlane& plane, const FacetMesh& mesh) {
  double least = 1.0;
  for (const auto& c : mesh.corners) {
    const int n = c[3] < 0 ? 3 : 4;
    for (int i = 0; i < n; ++i) {
      const Vector2d at = plane.project(mesh.position[c[i]]);
      const Vector2d a = plane.project(mesh.position[c[(i + 1) % n]]) - at,
                     b = plane.project(mesh.position[c[(i + n - 1) % n]]) - at;
      least = std::min(least, cross(a, b) / (a.norm() * b.norm()));
    }
  }
  return least;
}

// Meshes the facet with contact lines in fewer pieces. False if nothing was joined, or if joined
// lines cross or nearly touch lines that the original ones do not.
bool make_joined(const FacetPlane& plane, const FacetOutline& outline,
                 const std::vector<Vector3d>& points, const FacetSize& size, FacetMesh& mesh) {
  if (outline.contacts.size() < 2) return false;
  const FacetOutline joined = with_joined_contacts(outline, points, size.cut.element_size());
  if (joined.contacts.size() == outline.contacts.size()) return false;
  mesh = free_mesh(plane, joined, points, size);
  if (!is_sound(plane, mesh) || mesh.has_cut_lines) return false;
  constexpr double poor = 0.002;  // sine of a tenth of a degree
  const double least = least_sine(plane, mesh);
  return least >= poor || least >= least_sine(plane, free_mesh(plane, outline, points, size));
}

FacetOutline bare_outline(const FacetPlane& plane) {
  FacetOutline bare;
  for (int l = 0; l < plane.loop_count(); ++l) {
    bare.loops.emplace_back(plane.point.begin() + plane.loop_begin[l],
                            plane.point.begin() + plane.loop_begin[l + 1]);
  }
  return bare;
}

// Meshes a polygon that crosses or overlaps itself.
FacetMesh crossing_mesh(const FacetPlane& plane, FacetOutline outline,
                        const std::vector<Vector3d>& points, const FacetSize& size) {
  outline.crosses_itself = true;
  FacetMesh mesh = free_mesh(plane, outline, points, size);
  mesh.crosses_itself = true;
  return mesh;
}

}  // namespace

double quad_quality(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const std::array<Vector2d, 4> q{a, b, c, d};
  double least = 1.0;
  for (int i = 0; i < 4; ++i) {
    const Vector2d out = q[(i + 1) % 4] - q[i], back = q[(i + 3) % 4] - q[i];
    least = std::min(least, cross(out, back) / std::max(out.norm() * back.norm(), 1e-300));
  }
  return least;
}

FacetMesh mesh_facet(const FacetPlane& plane, const FacetOutline& outline,
                     const std::vector<Vector3d>& points, const FacetSize& size) {
  FacetMesh mesh;
  if (make_single_element(plane, outline, points, mesh)) return mesh;
  if (make_grid(plane, outline, points, size, mesh)) return mesh;
  if (make_joined(plane, outline, points, size, mesh)) return mesh;
  mesh = free_mesh(plane, outline, points, size);
  if (is_sound(plane, mesh)) return mesh;
  if (!outline.creases.empty()) {
    FacetOutline less = outline;
    less.creases.clear();
    mesh = mesh_facet(plane, less, points, size);
    mesh.lacks_creases = true;
    return mesh;
  }
  // The contact lines are given up first, then the points that other facets put on the boundary.
  const FacetOutline bare = bare_outline(plane);
  for (const FacetOutline& less : {FacetOutline{.loops = outline.loops}, bare}) {
    mesh = free_mesh(plane, less, points, size);
    mesh.is_flawed = true;
    if (is_sound(plane, mesh)) return mesh;
  }
  // Elements thinner than the tolerance may lean: their share of the area is smaller than what
  // welding changes. A triangle so thin that no mesh covers it stays one element.
  if (covers(plane, mesh) && !mesh.has_cut_lines) return mesh;
  const bool is_flawed = outline.has_lines() || outline.loops != bare.loops;
  if (plane.is_triangle()) {
    mesh = {};
    make_element(bare.loops.front(), points, mesh);
  } else {
    mesh = crossing_mesh(plane, bare, points, size);
  }
  mesh.is_flawed = is_flawed;
  return mesh;
}

}  // namespace lightwell
