#include "tests/mesh/mesh_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace lightwell::test {

using Eigen::Vector3d;

Material diffuse(const std::string& name, float rho) {
  const Bands bands = rgb_bands();
  Material m;
  m.name = name;
  m.reflectance = constant_spectrum(bands, rho);
  m.specular = constant_spectrum(bands, 0.0f);
  m.emission = constant_spectrum(bands, 0.0f);
  return m;
}

Scene empty_scene() {
  Scene scene;
  scene.materials = {diffuse("grey", 0.5f), diffuse("grey front", 0.5f)};
  scene.materials[1].one_sided = true;
  return scene;
}

PolygonMesh polygon(const Loop& boundary, const std::vector<Loop>& holes) {
  PolygonMesh mesh;
  Facet& facet = mesh.facets.emplace_back();
  const auto add = [&](const Loop& loop, std::vector<int>& indices) {
    for (const Vector3d& p : loop) {
      indices.push_back(static_cast<int>(mesh.vertices.size()));
      mesh.vertices.push_back(p);
    }
  };
  add(boundary, facet.boundary);
  for (const Loop& hole : holes) add(hole, facet.holes.emplace_back());
  return mesh;
}

void add_polygon(Scene& scene, const std::string& name, const Loop& boundary,
                 const std::vector<Loop>& holes, int material) {
  scene.surfaces.push_back({.name = name, .material = material, .shape = polygon(boundary, holes)});
}

void add_sphere(Scene& scene, const std::string& name, const Sphere& sphere, int material) {
  scene.surfaces.push_back({.name = name, .material = material, .shape = sphere});
}

void add_box(Scene& scene, const std::string& name, const Vector3d& low, const Vector3d& high,
             bool one_surface, int material) {
  PolygonMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                              i & 4 ? high.z() : low.z());
  }
  const std::vector<std::vector<int>> faces{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  if (one_surface) {
    for (const auto& f : faces) box.facets.push_back({.boundary = f});
    scene.surfaces.push_back({.name = name, .material = material, .shape = box});
    return;
  }
  for (const auto& f : faces) {
    Loop loop;
    for (int v : f) loop.push_back(box.vertices[v]);
    add_polygon(scene, name + std::to_string(scene.surfaces.size()), loop, {}, material);
  }
}

Scene cornell_box() {
  Scene scene;
  scene.materials = {diffuse("white", 0.73f), diffuse("green", 0.14f), diffuse("red", 0.2f),
                     diffuse("light", 0.0f)};
  scene.materials[3].emission = constant_spectrum(scene.bands, 10.0f);
  const auto mm = [](Loop loop) {
    for (Vector3d& p : loop) p *= 1e-3;
    return loop;
  };
  const auto add = [&](const std::string& name, int material, const Loop& loop,
                       const std::vector<Loop>& holes = {}) {
    std::vector<Loop> scaled;
    for (const Loop& hole : holes) scaled.push_back(mm(hole));
    add_polygon(scene, name, mm(loop), scaled, material);
  };
  add("floor", 0, {{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}});
  add("ceiling", 0, {{0, 548.8, 0}, {556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}},
      {{{343, 548.8, 227}, {213, 548.8, 227}, {213, 548.8, 332}, {343, 548.8, 332}}});
  add("light", 3, {{343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}});
  add("back wall", 0, {{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}});
  add("right wall", 1, {{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}});
  PolygonMesh left;
  left.vertices = mm({{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}});
  left.facets = {{.boundary = {0, 1, 2}}, {.boundary = {0, 2, 3}}};
  scene.surfaces.push_back({.name = "left wall", .material = 2, .shape = left});

  const auto block = [&](const std::string& name, double height, const Loop& base) {
    // `base` runs counter-clockwise seen from above (y up).
    Loop top = base;
    for (Vector3d& p : top) p.y() = height;
    add(name + " top", 0, top);
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      add(name + " side " + std::to_string(i + 1), 0, {base[i], base[j], top[j], top[i]});
    }
  };
  block("short", 165, {{130, 0, 65}, {82, 0, 225}, {240, 0, 272}, {290, 0, 114}});
  block("tall", 330, {{423, 0, 247}, {265, 0, 296}, {314, 0, 456}, {472, 0, 406}});
  return scene;
}

Scene terrain(int n) {
  Scene scene = empty_scene();
  PolygonMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      // Ridges of several sizes, and random steps from point to point that are aligned with no
      // frame.
      const double jitter = std::sin(12.9898 * i + 78.233 * j) * 43758.5453;
      const double z = 0.1 * std::sin(9 * x) * std::cos(7 * y) + 0.02 * std::sin(40 * x + 31 * y) +
                       0.3 / n * (jitter - std::floor(jitter));
      mesh.vertices.emplace_back(x, y, z);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      mesh.facets.push_back({.boundary = {a, b, c}});
      mesh.facets.push_back({.boundary = {a, c, d}});
    }
  }
  scene.surfaces.push_back({.name = "terrain", .material = 0, .shape = mesh});
  return scene;
}

namespace {

// True if two elements have an edge in common, compared by position: the ends may be split
// vertices.
bool share_an_edge(const PatchMesh& mesh, int e, int f) {
  int same_place = 0;
  for (int i = 0; i < mesh.corner_count(e); ++i) {
    for (int j = 0; j < mesh.corner_count(f); ++j) {
      if (mesh.position(mesh.corners[e][i]) == mesh.position(mesh.corners[f][j])) ++same_place;
    }
  }
  return same_place >= 2;
}

void expect_patches_connected(const PatchMesh& mesh) {
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int first = mesh.first_element[p], count = mesh.first_element[p + 1] - first;
    ASSERT_GT(count, 0) << "patch " << p << " has no elements";
    if (mesh.facet_of(p) < 0) continue;  // crumbs of many facets may share one
    std::vector<char> seen(count, 0);
    std::vector<int> open{first};
    seen[0] = 1;
    int reached = 1;
    while (!open.empty()) {
      const int e = open.back();
      open.pop_back();
      for (int f = first; f < first + count; ++f) {
        if (seen[f - first] || !share_an_edge(mesh, e, f)) continue;
        seen[f - first] = 1;
        ++reached;
        open.push_back(f);
      }
    }
    ASSERT_EQ(reached, count) << "patch " << p << " of facet " << mesh.facet_of(p)
                              << " is not connected";
  }
}

std::vector<Vector3d> corner_positions(const PatchMesh& mesh, int e) {
  std::vector<Vector3d> q;
  for (int i = 0; i < mesh.corner_count(e); ++i) q.push_back(mesh.position(mesh.corners[e][i]));
  return q;
}

void expect_twins_agree(const PatchMesh& mesh) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int t = mesh.twin[e];
    if (t < 0) continue;
    ASSERT_EQ(mesh.twin[t], e);
    ASSERT_NE(mesh.is_back[mesh.patch[t]], mesh.is_back[mesh.patch[e]]);
    ASSERT_EQ(mesh.facet[t], mesh.facet[e]);
    ASSERT_EQ(mesh.element_area[t], mesh.element_area[e]);
    const PatchPoint a = element_center(mesh, e), b = element_center(mesh, t);
    ASSERT_NEAR((a.position - b.position).norm(), 0.0, 1e-12 * (1.0 + a.position.norm()));
    ASSERT_NEAR(a.normal.dot(b.normal), -1.0, 1e-9);
    for (int c : mesh.corners[e]) {
      if (c < 0) continue;
      ASSERT_EQ(std::count(mesh.corners[t].begin(), mesh.corners[t].end(), c), 0)
          << "the two sides share a vertex";
    }
  }
}

}  // namespace

int Numbers::below(int n) {
  state_ = state_ * 1664525u + 1013904223u;
  return static_cast<int>((state_ >> 8) % static_cast<std::uint32_t>(n));
}

double Numbers::between(double low, double high) {
  return low + (high - low) * below(1 << 20) / 0x1p20;
}

int add_lamp(Scene& scene) {
  Material lamp = diffuse("lamp", 0.0f);
  lamp.emission = constant_spectrum(scene.bands, 1.0f);
  scene.materials.push_back(lamp);
  return static_cast<int>(scene.materials.size()) - 1;
}

Scene boxes_under_a_lamp(std::uint32_t seed) {
  Numbers numbers(seed);
  Scene scene = empty_scene();
  const int lamp = add_lamp(scene);
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const double x = numbers.between(0.1, 0.7), y = numbers.between(0.1, 0.7);
  const double height = seed % 3 == 0 ? 0.75 : numbers.between(0.5, 1.0);
  add_polygon(
      scene, "lamp",
      {{x, y, height}, {x, y + 0.2, height}, {x + 0.15, y + 0.2, height}, {x + 0.2, y, height}}, {},
      lamp);
  const bool on_lattice = seed % 2 == 0;
  const int count = 1 + numbers.below(4);
  for (int b = 0; b < count; ++b) {
    Vector3d low, extent;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = on_lattice ? numbers.below(7) / 8.0 : numbers.between(0.0, 0.8);
      extent[axis] = on_lattice ? (1 + numbers.below(3)) / 8.0 : numbers.between(0.05, 0.4);
    }
    if (numbers.below(2) == 0) low.z() = 0.0;
    add_box(scene, "box", low, low + extent, numbers.below(2) == 0);
  }
  if (seed % 5 == 0) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.0 + seed, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (Surface& surface : scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v = turn * v;
    }
  }
  return scene;
}

Scene triangle_ball(int n, int material) {
  PolygonMesh mesh;
  const int rings = n / 2;
  mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
  for (int j = 1; j < rings; ++j) {
    const double theta = std::numbers::pi * j / rings;
    for (int i = 0; i < n; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / n;
      mesh.vertices.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
    }
  }
  const auto at = [&](int j, int i) {
    return j == 0 ? 0 : j == rings ? 1 : 2 + (j - 1) * n + i % n;
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < n; ++i) {
      if (j > 0) mesh.facets.push_back({.boundary = {at(j, i), at(j + 1, i), at(j, i + 1)}});
      if (j + 1 < rings) {
        mesh.facets.push_back({.boundary = {at(j, i + 1), at(j + 1, i), at(j + 1, i + 1)}});
      }
    }
  }
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "ball", .material = material, .shape = std::move(mesh)});
  return scene;
}

void expect_consistent(const PatchMesh& mesh) {
  const int elements = mesh.element_count(), patches = mesh.patch_count();
  ASSERT_GT(patches, 0);
  ASSERT_EQ(static_cast<int>(mesh.first_element.size()), patches + 1);
  ASSERT_EQ(mesh.first_element.front(), 0);
  ASSERT_EQ(mesh.first_element.back(), elements);
  ASSERT_EQ(static_cast<int>(mesh.elements->n_faces()), elements);
  ASSERT_EQ(static_cast<int>(mesh.elements->n_vertices()), mesh.vertex_count());
  ASSERT_EQ(mesh.element_area.size(), elements);
  ASSERT_TRUE((mesh.element_area > 0.0).all());
  ASSERT_TRUE((mesh.area > 0.0).all());
  for (int p = 0; p < patches; ++p) {
    double sum = 0.0;
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      ASSERT_EQ(mesh.patch[e], p);
      sum += mesh.element_area[e];
    }
    ASSERT_NEAR(sum, mesh.area[p], 1e-12 * mesh.area[p]);
  }
  std::vector<char> used(mesh.vertex_count(), 0);
  for (int e = 0; e < elements; ++e) {
    auto it = mesh.elements->cfv_iter(HalfedgeMesh::FaceHandle(e));
    std::vector<int> of_face;
    for (; it.is_valid(); ++it) of_face.push_back(it->idx());
    std::vector<int> flat(mesh.corners[e].begin(), mesh.corners[e].begin() + mesh.corner_count(e));
    for (int v : flat) used[v] = 1;
    std::rotate(of_face.begin(), std::find(of_face.begin(), of_face.end(), flat[0]), of_face.end());
    ASSERT_EQ(of_face, flat);
    const Vector3d normal = element_center(mesh, e).normal;
    for (int v : flat) ASSERT_GT(normal.dot(mesh.vertex_normal[v]), 0.0);
  }
  for (char u : used) ASSERT_TRUE(u) << "a vertex belongs to no element";
  for (const Vector3d& n : mesh.vertex_normal) ASSERT_NEAR(n.norm(), 1.0, 1e-12);
  expect_patches_connected(mesh);
  expect_twins_agree(mesh);
}

double side_area(const PatchMesh& mesh, int facet, bool back) {
  double sum = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool is_back = mesh.is_back[mesh.patch[e]] != 0;
    if (mesh.facet[e] == facet && is_back == back) sum += mesh.element_area[e];
  }
  return sum;
}

int hanging_vertices(const PatchMesh& mesh) {
  // Vertices are hashed in cells of the longest edge, so that an edge is compared only with the
  // cells around its ends.
  double longest = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto q = corner_positions(mesh, e);
    for (std::size_t i = 0; i < q.size(); ++i) {
      longest = std::max(longest, (q[i] - q[(i + 1) % q.size()]).norm());
    }
  }
  using Cell = std::array<long, 3>;
  const auto cell_of = [&](const Vector3d& p) {
    return Cell{std::lround(p.x() / longest), std::lround(p.y() / longest),
                std::lround(p.z() / longest)};
  };
  std::map<Cell, std::vector<int>> cells;
  for (int v = 0; v < mesh.vertex_count(); ++v) cells[cell_of(mesh.position(v))].push_back(v);
  // Facets that overlap have inner vertices and edges of their own. Only lines where a facet ends,
  // or is cut, must agree with everything there. An edge is inner if the element across has an end
  // of it in common, or belongs to the same patch (both ends may be split reflex corners).
  using PointKey = std::array<double, 3>;
  const auto place = [&](int v) {
    const Vector3d p = mesh.position(v);
    return PointKey{p.x(), p.y(), p.z()};
  };
  std::map<std::pair<PointKey, PointKey>, std::vector<HalfedgeMesh::HalfedgeHandle>> edges_at;
  for (auto h : mesh.elements->halfedges()) {
    if (!mesh.elements->face_handle(h).is_valid()) continue;
    const PointKey a = place(mesh.elements->from_vertex_handle(h).idx());
    const PointKey b = place(mesh.elements->to_vertex_handle(h).idx());
    edges_at[std::minmax(a, b)].push_back(h);
  }
  const auto patch_of = [&](HalfedgeMesh::HalfedgeHandle h) {
    return mesh.patch[mesh.elements->face_handle(h).idx()];
  };
  const auto facet_of = [&](HalfedgeMesh::HalfedgeHandle h) {
    return mesh.facet[mesh.elements->face_handle(h).idx()];
  };
  const auto is_inner_edge = [&](HalfedgeMesh::HalfedgeHandle h) {
    const auto from = mesh.elements->from_vertex_handle(h), to = mesh.elements->to_vertex_handle(h);
    const auto& there = edges_at[std::minmax(place(from.idx()), place(to.idx()))];
    return std::any_of(there.begin(), there.end(), [&](auto other) {
      if (other == h || facet_of(other) != facet_of(h)) return false;
      return patch_of(other) == patch_of(h) || mesh.elements->to_vertex_handle(other) == from ||
             mesh.elements->from_vertex_handle(other) == to;
    });
  };
  std::vector<std::set<int>> facets_of(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      facets_of[mesh.corners[e][i]].insert(mesh.facet[e]);
    }
  }
  std::set<std::array<double, 3>> hanging;
  for (auto h : mesh.elements->halfedges()) {
    const auto face = mesh.elements->face_handle(h);
    if (!face.is_valid()) continue;
    const int facet = mesh.facet[face.idx()];
    const bool is_inner = is_inner_edge(h);
    const Vector3d a = mesh.position(mesh.elements->from_vertex_handle(h).idx());
    const Vector3d d = mesh.position(mesh.elements->to_vertex_handle(h).idx()) - a;
    const Cell home = cell_of(a + 0.5 * d);
    for (long x = home[0] - 1; x <= home[0] + 1; ++x) {
      for (long y = home[1] - 1; y <= home[1] + 1; ++y) {
        for (long z = home[2] - 1; z <= home[2] + 1; ++z) {
          const auto cell = cells.find({x, y, z});
          if (cell == cells.end()) continue;
          for (int v : cell->second) {
            if (is_inner && !facets_of[v].contains(facet)) continue;
            const Vector3d p = mesh.position(v), w = p - a;
            const double t = d.dot(w) / d.squaredNorm();
            if (t > 1e-6 && t < 1 - 1e-6 && (w - t * d).norm() < 1e-9 * longest) {
              hanging.insert({p.x(), p.y(), p.z()});
            }
          }
        }
      }
    }
  }
  return static_cast<int>(hanging.size());
}

double smallest_angle(const PatchMesh& mesh) {
  double least = 180.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto q = corner_positions(mesh, e);
    const std::size_t n = q.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3d u = q[(i + 1) % n] - q[i], v = q[(i + n - 1) % n] - q[i];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
    }
  }
  return least;
}

}  // namespace lightwell::test
