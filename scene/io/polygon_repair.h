#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/io/mesh_builder.h"

namespace lightwell {

/// Counts of repairs to the polygons of a mesh file.
struct Repairs {
  int split = 0;      ///< not planar, or with a hole joined by a bridge: cut into triangles
  int thin = 0;       ///< without area: dropped
  int crossing = 0;   ///< crossing themselves: cut into convex_pieces()
  int placeless = 0;  ///< with a vertex whose coordinates are no finite numbers: dropped
  std::string first_placeless{};  ///< names the first of these vertices and its fault

  void add(const Repairs& other);
  /// Counts a polygon that is dropped for a vertex without finite coordinates; `fault` names the
  /// vertex.
  void drop_placeless(const std::string& fault);
  /// One note for each count that is not zero.
  std::vector<std::string> notes() const;
};

/// The first corner of a loop that has no finite coordinates.
std::optional<std::size_t> placeless_corner(const Loop& loop);

/// Adds the convex_pieces() of a polygon. `uv` and `normals` are given at all corners, of the
/// boundary, then of the holes; or empty. False, with nothing added, if the pieces have no area.
bool add_pieces(MeshBuilder& mesh, const Polygon& polygon, const UvLoop& uv = {},
                const NormalLoop& normals = {});

/// Adds a polygon of a mesh file, repaired where possible. A polygon is cut into triangles if it is
/// not planar, if a bridge joins a hole to its boundary, or if its texture coordinates or normals
/// are not linear; and into convex_pieces() if it crosses itself.
void add_repaired(MeshBuilder& mesh, Loop loop, Repairs& repairs, UvLoop uv = {},
                  NormalLoop normals = {});

/// Adds a polygon whose holes may touch or cross its outline, as doors do that stand on a floor:
/// where they do, as convex_pieces(). Without holes as add_repaired() does.
void add_with_holes(MeshBuilder& mesh, Polygon polygon, Repairs& repairs);

}  // namespace lightwell
