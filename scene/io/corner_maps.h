#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell {

/// Texture coordinates at the corners of a loop, one for each corner; or empty.
using UvLoop = std::vector<Eigen::Vector2d>;
/// Normals at the corners of a loop, of any length and side, one for each corner; or empty.
using NormalLoop = std::vector<Eigen::Vector3d>;

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

/// Unit normals on the front of the loop; empty if a normal is missing or unusable, or if all equal
/// the plane's normal.
NormalLoop bent_normals(const Loop& loop, const NormalLoop& normals);
/// The same map for bent_normals() of a loop; empty if a normal deviates from it by more than
/// 0.002.
std::optional<NormalMap> map_of_unit_normals(const Loop& loop, const NormalLoop& unit);

/// True if a map represents the texture coordinates of a loop, as far as uv_map_over() asks.
bool agrees(const UvMap& map, const Loop& loop, const UvLoop& uv);
/// True if a map represents the unit normals of a loop, each within `tolerance`.
bool agrees(const NormalMap& map, const Loop& loop, const NormalLoop& unit, double tolerance);

}  // namespace lightwell
