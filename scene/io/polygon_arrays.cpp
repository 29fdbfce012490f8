#include "scene/io/polygon_arrays.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "scene/errors.h"
#include "scene/io/clean_names.h"
#include "scene/io/crossing_polygon.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/remarks.h"
#include "scene/io/round_facets.h"

namespace lightwell {
namespace {

void check_arrays(const Scene& scene, const PolygonArrays& polygons) {
  const std::size_t count = polygons.surface.size();
  bool fits = polygons.first.size() == count + 1 && polygons.first.front() == 0 &&
              polygons.first.back() == polygons.corners.size();
  for (std::size_t p = 0; fits && p < count; ++p) {
    fits = polygons.first[p] <= polygons.first[p + 1];
  }
  const std::size_t points = polygons.vertices.size();
  fits = fits && (polygons.uv.empty() || polygons.uv.size() == points) &&
         (polygons.normals.empty() || polygons.normals.size() == points);
  if (!fits) {
    throw InputError(
        fmt::format("the arrays of {} polygons do not fit each other: the first corners must begin "
                    "at 0, not decrease, and end at the {} corners, and every vertex needs texture "
                    "coordinates and a normal, or none has them",
                    count, polygons.corners.size()));
  }
  for (std::size_t v = 0; v < polygons.vertices.size(); ++v) {
    if (polygons.vertices[v].allFinite()) continue;
    throw InputError(
        fmt::format("vertex {} has a coordinate that is not a finite number; remove the polygons "
                    "that use it, or give it a place",
                    v));
  }
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t c = polygons.first[p]; c < polygons.first[p + 1]; ++c) {
      const int v = polygons.corners[c];
      if (v >= 0 && static_cast<std::size_t>(v) < polygons.vertices.size()) continue;
      throw InputError(fmt::format("face {} names vertex {}, but there are {}, counted from 0", p,
                                   v, polygons.vertices.size()));
    }
    const int s = polygons.surface[p];
    if (s >= 0 && static_cast<std::size_t>(s) < scene.surfaces.size()) continue;
    throw InputError(fmt::format("face {} is of surface {}, but there are {}, counted from 0", p, s,
                                 scene.surfaces.size()));
  }
}

// Facets of each surface, and the polygon that each facet is of.
struct Built {
  std::vector<MeshBuilder> meshes{};
  std::vector<std::vector<int>> polygon{};
  Repairs repairs{};
};

Built build_meshes(std::size_t surfaces, const PolygonArrays& polygons) {
  Built built{.meshes = std::vector<MeshBuilder>(surfaces),
              .polygon = std::vector<std::vector<int>>(surfaces)};
  for (std::size_t p = 0; p < polygons.surface.size(); ++p) {
    const auto s = static_cast<std::size_t>(polygons.surface[p]);
    Loop loop;
    UvLoop uv;
    NormalLoop normals;
    for (std::size_t c = polygons.first[p]; c < polygons.first[p + 1]; ++c) {
      const auto v = static_cast<std::size_t>(polygons.corners[c]);
      loop.push_back(polygons.vertices[v]);
      if (!polygons.uv.empty()) uv.push_back(polygons.uv[v]);
      if (!polygons.normals.empty()) normals.push_back(polygons.normals[v]);
    }
    add_repaired(built.meshes[s], std::move(loop), built.repairs, std::move(uv),
                 std::move(normals));
    built.polygon[s].resize(built.meshes[s].mesh().facets.size(), static_cast<int>(p));
  }
  return built;
}

// Adds a convex loop as a fan of triangles.
void add_fan(const Loop& loop, int surface, PolygonArrays& triangles) {
  for (std::size_t c = 1; c + 1 < loop.size(); ++c) {
    for (const Eigen::Vector3d& p : {loop[0], loop[c], loop[c + 1]}) {
      triangles.corners.push_back(static_cast<int>(triangles.vertices.size()));
      triangles.vertices.push_back(p);
    }
    triangles.first.push_back(triangles.corners.size());
    triangles.surface.push_back(surface);
  }
}

Loop positions(const PolygonMesh& mesh, const std::vector<int>& loop) {
  Loop points;
  for (const int v : loop) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return points;
}

void add_facet(const PolygonMesh& mesh, const Facet& facet, int surface, PolygonArrays& triangles) {
  Polygon polygon{.boundary = positions(mesh, facet.boundary)};
  for (const auto& hole : facet.holes) polygon.holes.push_back(positions(mesh, hole));
  if (polygon.holes.empty()) {
    const auto parts = split_into_triangles(polygon.boundary);
    for (const auto& [a, b, c] : parts) {
      const auto at = [&](int i) { return polygon.boundary[static_cast<std::size_t>(i)]; };
      add_fan({at(a), at(b), at(c)}, surface, triangles);
    }
    if (!parts.empty()) return;
  }
  Loop all = polygon.boundary;
  for (const Loop& hole : polygon.holes) all.insert(all.end(), hole.begin(), hole.end());
  for (const auto& piece : convex_pieces(polygon)) {
    Loop loop;
    for (const PieceCorner& corner : piece) loop.push_back(corner.of(all));
    add_fan(loop, surface, triangles);
  }
}

void add_sphere(const Sphere& sphere, int surface, PolygonArrays& triangles) {
  for (Loop loop : sphere_loops()) {
    for (Eigen::Vector3d& p : loop) p = sphere.center + sphere.radius * p;
    add_fan(loop, surface, triangles);
  }
}

}  // namespace

NumberedScene scene_of_polygons(Scene scene, const PolygonArrays& polygons) {
  check_arrays(scene, polygons);
  Built built = build_meshes(scene.surfaces.size(), polygons);
  NumberedScene numbered;
  numbered.rows.resize(polygons.surface.size());
  std::vector<Surface> kept;
  Remarks remarks;
  clean_names(scene);
  for (std::size_t p = 0; p < numbered.rows.size(); ++p) {
    numbered.rows[p].name = scene.surfaces[static_cast<std::size_t>(polygons.surface[p])].name;
  }
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    Surface& surface = scene.surfaces[s];
    if (built.meshes[s].empty()) {
      remarks.add("Surfaces without a face that has an area were left out", surface.name);
      continue;
    }
    for (const int p : built.polygon[s]) numbered.row_of_facet.push_back(p);
    surface.shape = built.meshes[s].mesh();
    kept.push_back(std::move(surface));
  }
  if (kept.empty()) {
    throw InputError("no face has an area; give at least one with three corners that differ");
  }
  scene.surfaces = std::move(kept);
  note_repairs(built.repairs, scene);
  remarks.report_to(scene);
  validate(scene);
  numbered.scene = std::move(scene);
  return numbered;
}

PolygonArrays scene_triangles(const Scene& scene) {
  PolygonArrays triangles{.first = {0}};
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const SurfaceShape& shape = scene.surfaces[s].shape;
    const int number = static_cast<int>(s);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) add_sphere(*sphere, number, triangles);
    const auto* frustum = std::get_if<Frustum>(&shape);
    const PolygonMesh round = frustum ? facets_of(*frustum) : PolygonMesh();
    const auto* mesh = frustum ? &round : std::get_if<PolygonMesh>(&shape);
    if (!mesh) continue;
    for (const Facet& facet : mesh->facets) add_facet(*mesh, facet, number, triangles);
  }
  return triangles;
}

}  // namespace lightwell
