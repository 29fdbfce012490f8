#pragma once

#include <cstddef>
#include <vector>

#include "scene/io/numbered_scene.h"

namespace lightwell {

/// Polygons in arrays, as programs that make geometry hold them.
struct PolygonArrays {
  std::vector<Eigen::Vector3d> vertices{};  ///< m
  /// Indices into `vertices`, one polygon after another, counter-clockwise seen from the front.
  std::vector<int> corners{};
  /// Polygon p has the corners first[p] .. first[p + 1] - 1: one entry more than polygons.
  std::vector<std::size_t> first{};
  std::vector<int> surface{};  ///< of each polygon, an index into Scene::surfaces
  /// Texture coordinates of each vertex, (0, 0) the picture's top left corner; empty: none.
  std::vector<Eigen::Vector2d> uv{};
  /// Normals of each vertex, of any length, for smooth shading; empty: none.
  std::vector<Eigen::Vector3d> normals{};
};

/// Gives the surfaces of `scene`, which have names and materials, the polygons of the arrays. A row
/// is a polygon of the arrays. Polygons are repaired as those of mesh files are, surfaces without a
/// polygon that has an area are left out, and names become plain text; notes and losses of the
/// scene say so.
///
/// Throws InputError
///   - if the arrays do not fit each other, or name a vertex or surface that does not exist;
///   - if a coordinate is not finite, or no polygon has an area;
///   - as validate() does.
NumberedScene scene_of_polygons(Scene scene, const PolygonArrays& polygons);

/// The surfaces of a scene as triangles, for programs that know nothing else. Facets are
/// triangulated; a facet with holes is cut into convex pieces first. Spheres and frustums become 32
/// facets around, of the same area. No vertices are shared.
PolygonArrays scene_triangles(const Scene& scene);

}  // namespace lightwell
