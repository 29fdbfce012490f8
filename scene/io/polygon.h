#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Tolerance, relative to a polygon's size, of the distance of vertices from its plane, and least
/// width of a polygon with an area. Coordinates with six decimals satisfy the tolerance; its effect
/// on a radiosity mesh is invisible.
inline constexpr double flatness = 1e-6;

using Loop = std::vector<Eigen::Vector3d>;
/// Texture coordinates at the corners of a loop, one for each corner; or empty.
using UvLoop = std::vector<Eigen::Vector2d>;
/// Normals at the corners of a loop, of any length and side, one for each corner; or empty.
using NormalLoop = std::vector<Eigen::Vector3d>;

/// A polygon of a file before its conversion to a Facet.
struct Polygon {
  Loop boundary{};
  std::vector<Loop> holes{};
};

/// Describes the first fault of a polygon ("has edges 1 and 3 that cross or touch"); empty for a
/// valid one. Vertices and edges count from 1; edge i starts at vertex i. A non-planar polygon is
/// tested in projection along its normal.
std::string fault(const Polygon& polygon);

/// Largest distance of a vertex, holes included, from the boundary's plane (Newell's normal through
/// the centroid), divided by the boundary's size.
double deviation_from_plane(const Polygon& polygon);

/// Twice the largest distance of a vertex from the vertices' mean.
double size_of(const Loop& loop);

/// True if a loop is thinner than `flatness` of its size.
bool is_thin(const Loop& loop);

/// Triangulates a polygon without holes by ear clipping (Meisters 1975) in projection along its
/// normal; triangles keep the orientation. A quadrilateral is cut along v0-v2 if that diagonal lies
/// inside. The loop may touch itself (a hole joined by a bridge). Empty if the loop crosses itself.
std::vector<std::array<int, 3>> split_into_triangles(const Loop& loop);

/// Linear map of texture coordinates over the plane of a loop with an area, exact at three corners
/// far from each other. Empty if another corner deviates by more than 1e-4 + 1e-3 times the extent
/// of the coordinates, or if a coordinate is not finite.
std::optional<UvMap> uv_map_over(const Loop& loop, const UvLoop& uv);

/// Linear map of normals over the plane of a loop with an area, on the loop's front. Empty if:
/// - all normals lie within 0.2 degrees of the plane's normal;
/// - a normal is missing, not finite, of length 0, or within 6 degrees of the plane;
/// - a unit normal deviates from the linear map by more than 0.002.
std::optional<NormalMap> normal_map_over(const Loop& loop, const NormalLoop& normals);

/// True if one NormalMap, or none, represents a loop's normals.
bool is_even(const Loop& loop, const NormalLoop& normals);

/// Collects polygons into a PolygonMesh in which equal positions are one vertex.
class MeshBuilder {
 public:
  /// Adds a valid polygon. Holes get the winding opposite to the boundary's. `uv` and `normals` are
  /// given at the boundary's corners; the facet has a map where uv_map_over() and normal_map_over()
  /// find one.
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

/// Counts of repairs to the polygons of a mesh file.
struct Repairs {
  int split = 0;     ///< not planar, or with a hole joined by a bridge: cut into triangles
  int thin = 0;      ///< without area: dropped
  int crossing = 0;  ///< crossing themselves: cut into convex_pieces()

  void add(const Repairs& other) {
    split += other.split;
    thin += other.thin;
    crossing += other.crossing;
  }
  /// One note for each count that is not zero.
  std::vector<std::string> notes() const;
};

/// Adds the convex_pieces() of a polygon. `uv` and `normals` are given at all corners, of the
/// boundary, then of the holes; or empty. False, with nothing added, if the pieces have no area.
bool add_pieces(MeshBuilder& mesh, const Polygon& polygon, const UvLoop& uv = {},
                const NormalLoop& normals = {});

/// Adds a polygon of a mesh file, repaired where possible. A polygon is cut into triangles if it is
/// not planar, if a bridge joins a hole to its boundary, or if its texture coordinates or normals
/// are not linear; and into convex_pieces() if it crosses itself.
void add_repaired(MeshBuilder& mesh, Loop loop, Repairs& repairs, UvLoop uv = {},
                  NormalLoop normals = {});

}  // namespace lightwell
