#include "scene/io/placed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/convex_cut.h"

namespace lightwell {
namespace {

// Sides of a round shape: the outline of a disk stays within 0.5 % of its radius.
constexpr int rings = 16;

Eigen::Vector2d on_circle(int side, double radius) {
  const double angle = 2.0 * std::numbers::pi * (side % round_sides) / round_sides;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Loop loop_of(const PolygonMesh& mesh, const std::vector<int>& indices) {
  Loop loop;
  for (const int v : indices) loop.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return loop;
}

}  // namespace

std::vector<Loop> rectangle_loops() {
  return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
}

std::vector<Loop> cube_loops() {
  // Bits of a corner's number: x, y, z = 1.
  constexpr std::array<std::array<int, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  std::vector<Loop> loops;
  for (const auto& face : faces) {
    Loop loop;
    for (const int corner : face) {
      loop.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Loop> disk_loops() {
  // n triangles of area r^2 sin(2 pi / n) / 2 add up to pi.
  const double turn = 2.0 * std::numbers::pi / round_sides;
  const double radius = std::sqrt(turn / std::sin(turn));
  Loop loop;
  for (int i = 0; i < round_sides; ++i) {
    const Eigen::Vector2d p = on_circle(i, radius);
    loop.emplace_back(p.x(), p.y(), 0.0);
  }
  return {loop};
}

std::vector<Loop> cone_loops(double radius, double top_radius, double height) {
  // With radii scaled by k, n trapezia have the area n k (r + R) sin(pi/n) sqrt(h^2 + (k (R - r)
  // cos(pi/n))^2). Equating that area to pi (r + R) sqrt(h^2 + (R - r)^2) gives a quadratic
  // equation in k^2.
  const double half = std::numbers::pi / round_sides, hh = height * height;
  const double dd = (top_radius - radius) * (top_radius - radius);
  const double d = dd * std::cos(half) * std::cos(half);
  const double c = half * half * (hh + dd) / (std::sin(half) * std::sin(half));
  const double k = std::sqrt(2.0 * c / (hh + std::sqrt(hh * hh + 4.0 * d * c)));
  std::vector<Loop> loops;
  for (int i = 0; i < round_sides; ++i) {
    const auto point = [&](int side, double r, double z) -> Eigen::Vector3d {
      const Eigen::Vector2d p = on_circle(side, k * r);
      return {p.x(), p.y(), z};
    };
    Loop loop = {point(i, radius, 0.0)};
    if (radius > 0.0) loop.push_back(point(i + 1, radius, 0.0));
    loop.push_back(point(i + 1, top_radius, height));
    if (top_radius > 0.0) loop.push_back(point(i, top_radius, height));
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<NormalLoop> cone_normals(const std::vector<Loop>& loops, double radius,
                                     double top_radius, double height) {
  std::vector<NormalLoop> normals;
  for (const Loop& loop : loops) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : loop) middle += p;
    NormalLoop& of_loop = normals.emplace_back();
    for (const Eigen::Vector3d& p : loop) {
      // The tip of a cone has a normal in each direction; a facet there takes that of its middle.
      const Eigen::Vector2d out = (p.head<2>().norm() > 0.0 ? p : middle).head<2>().normalized();
      of_loop.emplace_back(out.x() * height, out.y() * height, radius - top_radius);
    }
  }
  return normals;
}

Polygon ring_polygon(double inner, double outer) {
  const auto scaled = [](double radius) {
    Loop loop = disk_loops().front();
    for (Eigen::Vector3d& p : loop) p *= radius;
    return loop;
  };
  Polygon ring{.boundary = scaled(outer)};
  if (inner > 0.0) ring.holes.push_back(scaled(inner));
  return ring;
}

std::vector<Loop> sphere_loops() {
  std::vector<Loop> loops;
  double area = 0.0;
  const auto point = [](int ring, int side) {
    const double latitude = std::numbers::pi * (static_cast<double>(ring) / rings - 0.5);
    // Poles lie exactly on the axis, so that the triangles there share one vertex.
    const bool is_pole = ring == 0 || ring == rings;
    const Eigen::Vector2d p = on_circle(side, is_pole ? 0.0 : std::cos(latitude));
    return Eigen::Vector3d(p.x(), p.y(), std::sin(latitude));
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < round_sides; ++i) {
      Loop loop = {point(ring, i)};
      if (ring > 0) loop.push_back(point(ring, i + 1));
      loop.push_back(point(ring + 1, i + 1));
      if (ring + 1 < rings) loop.push_back(point(ring + 1, i));
      area += area_vector(loop).norm();
      loops.push_back(std::move(loop));
    }
  }
  const double scale = std::sqrt(4.0 * std::numbers::pi / area);
  for (Loop& loop : loops) {
    for (Eigen::Vector3d& p : loop) p *= scale;
  }
  return loops;
}

bool keeps_angles(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d gram = transform.linear().transpose() * transform.linear();
  const double scale = gram.trace() / 3.0;
  constexpr double exactly = 1e-6;
  return (gram - scale * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= exactly * scale;
}

PolygonMesh placed_loops(const std::vector<Loop>& loops, const Eigen::Affine3d& transform,
                         bool flip, Repairs& repairs, const std::vector<UvLoop>& uv,
                         const std::vector<NormalLoop>& normals) {
  const Eigen::Matrix3d turn = normal_transform(transform);
  const bool turned = (transform.linear().determinant() < 0.0) != flip;
  MeshBuilder mesh;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Loop loop = loops[i];
    UvLoop of_loop = uv.empty() ? UvLoop{} : uv[i];
    NormalLoop normals_there = normals.empty() ? NormalLoop{} : normals[i];
    for (Eigen::Vector3d& p : loop) p = transform * p;
    for (Eigen::Vector3d& n : normals_there) n = turn * n;
    if (turned) {
      std::reverse(loop.begin(), loop.end());
      std::reverse(of_loop.begin(), of_loop.end());
      std::reverse(normals_there.begin(), normals_there.end());
    }
    add_repaired(mesh, std::move(loop), repairs, std::move(of_loop), std::move(normals_there));
  }
  return mesh.mesh();
}

Eigen::Matrix3d normal_transform(const Eigen::Affine3d& transform) {
  const auto& m = transform.linear();
  Eigen::Matrix3d cofactors;
  for (int c = 0; c < 3; ++c) cofactors.col(c) = m.col((c + 1) % 3).cross(m.col((c + 2) % 3));
  return cofactors;
}

void drop_normals(PolygonMesh& mesh) {
  mesh.normal_maps = {};
  for (Facet& facet : mesh.facets) facet.normal_map = -1;
}

void turn_over(PolygonMesh& mesh) {
  for (Facet& facet : mesh.facets) {
    std::reverse(facet.boundary.begin(), facet.boundary.end());
    for (auto& hole : facet.holes) std::reverse(hole.begin(), hole.end());
  }
}

bool is_closed(const PolygonMesh& mesh) {
  std::vector<std::pair<int, int>> forwards, backwards;
  for (const Facet& facet : mesh.facets) {
    for (std::size_t i = 0; i < facet.boundary.size(); ++i) {
      const int a = facet.boundary[i], b = facet.boundary[(i + 1) % facet.boundary.size()];
      forwards.emplace_back(a, b);
      backwards.emplace_back(b, a);
    }
  }
  std::ranges::sort(forwards);
  std::ranges::sort(backwards);
  return forwards == backwards && std::ranges::adjacent_find(forwards) == forwards.end();
}

PolygonMesh placed_mesh(PolygonMesh mesh, const Eigen::Affine3d& transform, bool flip,
                        bool mirror_turns, Repairs& repairs) {
  const bool is_mirrored = transform.linear().determinant() < 0.0;
  const bool turned = (mirror_turns && is_mirrored) != flip;
  if (!turned && transform.matrix().isIdentity(0.0)) return mesh;
  if (!keeps_angles(transform)) {
    // Facets planar within the tolerance may exceed it after the transformation.
    std::vector<Loop> loops;
    std::vector<UvLoop> uv;
    std::vector<NormalLoop> normals;
    for (const Facet& facet : mesh.facets) {
      loops.push_back(loop_of(mesh, facet.boundary));
      NormalLoop& normals_there = normals.emplace_back();
      if (facet.normal_map >= 0) {
        const NormalMap& map = mesh.normal_maps[static_cast<std::size_t>(facet.normal_map)];
        for (const Eigen::Vector3d& p : loops.back()) normals_there.push_back(map.at(p));
      }
      UvLoop& of_loop = uv.emplace_back();
      if (facet.uv_map < 0) continue;
      const UvMap& map = mesh.uv_maps[static_cast<std::size_t>(facet.uv_map)];
      for (const Eigen::Vector3d& p : loops.back()) of_loop.push_back(map.at(p));
    }
    return placed_loops(loops, transform, flip != (!mirror_turns && is_mirrored), repairs, uv,
                        normals);
  }
  const Eigen::Affine3d back = transform.inverse();
  for (UvMap& map : mesh.uv_maps) {
    map.offset += map.gradient * back.translation();
    map.gradient = map.gradient * back.linear();
  }
  const Eigen::Matrix3d turn =
      transform.linear() / std::cbrt(std::abs(transform.linear().determinant()));
  for (NormalMap& map : mesh.normal_maps) {
    map.offset = turn * (map.offset + map.gradient * back.translation());
    map.gradient = turn * map.gradient * back.linear();
  }
  for (Eigen::Vector3d& p : mesh.vertices) p = transform * p;
  if (turned) turn_over(mesh);
  const auto thin = std::erase_if(
      mesh.facets, [&](const Facet& facet) { return is_thin(loop_of(mesh, facet.boundary)); });
  repairs.thin += static_cast<int>(thin);
  return mesh;
}

}  // namespace lightwell
