#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Share of a polygon's size by which it may leave its plane, and below whose width it has no area
/// worth the name. Coordinates with six decimals keep to it; a radiosity mesh could not tell.
inline constexpr double flatness = 1e-6;

using Loop = std::vector<Eigen::Vector3d>;
/// Texture coordinates at the corners of a loop, as many as it has; or none.
using UvLoop = std::vector<Eigen::Vector2d>;
/// Normals at the corners of a loop, of any length and side, as many as it has; or none.
using NormalLoop = std::vector<Eigen::Vector3d>;

/// A polygon as a file gives it, before it becomes a Facet.
struct Polygon {
  Loop boundary{};
  std::vector<Loop> holes{};
};

/// What keeps a polygon from being used ("has edges 1 and 3 that cross or touch"), or empty.
/// Vertices and edges count from 1; edge i starts at vertex i. A polygon out of its plane is judged
/// as seen along its normal.
std::string fault(const Polygon& polygon);

/// Largest distance of a vertex, holes included, from the boundary's plane (Newell's normal through
/// the centroid) over the boundary's size.
double deviation_from_plane(const Polygon& polygon);

/// Twice the largest distance of a vertex from the vertices' mean.
double size_of(const Loop& loop);

/// Whether a loop has no area worth the name: it is thinner than `flatness` of its size.
bool is_thin(const Loop& loop);

/// Cuts a polygon without holes into triangles of the same orientation by clipping ears (Meisters
/// 1975) as seen along its normal. A quadrilateral is cut along v0-v2 if that diagonal lies inside.
/// The loop may touch itself (a hole joined by a bridge); empty if it crosses itself.
std::vector<std::array<int, 3>> split_into_triangles(const Loop& loop);

/// Texture coordinates over the plane of a loop that has an area: exact at three corners far from
/// each other. Nothing if the others are off by more than 1e-4 and 1e-3 of the coordinates' extent,
/// or if any is not finite.
std::optional<UvMap> uv_map_over(const Loop& loop, const UvLoop& uv);

/// Normals over the plane of a loop that has an area, on its front: where they lie less than 0.2
/// degrees from the plane's throughout, or are none (not finite, without length, within 6 degrees
/// of the plane), nothing; nor if they leave a linear map by more than 0.002.
std::optional<NormalMap> normal_map_over(const Loop& loop, const NormalLoop& normals);

/// Whether a loop's normals say nothing that one NormalMap, or none, does not say as well.
bool is_even(const Loop& loop, const NormalLoop& normals);

/// Collects polygons into a PolygonMesh in which equal positions are one vertex.
class MeshBuilder {
 public:
  /// The polygon must be sound; holes are turned to the winding opposite to the boundary's. `uv`
  /// and `normals` are the boundary's; without what uv_map_over() and normal_map_over() make of
  /// them, the facet has none.
  void add(const Polygon& polygon, const UvLoop& uv = {}, const NormalLoop& normals = {});
  bool empty() const { return mesh_.facets.empty(); }
  const PolygonMesh& mesh() const { return mesh_; }

 private:
  std::vector<int> indices(const Loop& loop);
  int uv_map(const Loop& loop, const UvLoop& uv);
  int normal_map(const Loop& loop, const NormalLoop& normals);
  PolygonMesh mesh_;
  std::map<std::array<double, 3>, int> index_of_;
};

/// What had to be done to the polygons of a mesh file before they could be used.
struct Repairs {
  int split = 0;     ///< not planar, or with a hole joined by a bridge: cut into triangles
  int thin = 0;      ///< without area: dropped
  int crossing = 0;  ///< crossing themselves: dropped

  int dropped() const { return thin + crossing; }
  void add(const Repairs& other) {
    split += other.split;
    thin += other.thin;
    crossing += other.crossing;
  }
  /// One sentence for each count that is not zero.
  std::vector<std::string> notes() const;
};

/// Adds a polygon of a mesh file, repaired where that is possible. It is cut into triangles as well
/// where its texture coordinates or normals are not linear over it.
void add_repaired(MeshBuilder& mesh, Loop loop, Repairs& repairs, UvLoop uv = {},
                  NormalLoop normals = {});

}  // namespace lightwell
