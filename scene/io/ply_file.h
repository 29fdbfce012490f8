#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lightwell {

/// Vertices and polygons of a mesh file without materials. Normals and texture coordinates belong
/// to vertices: as many as positions, or none.
struct IndexedPolygons {
  std::vector<Eigen::Vector3d> positions{}, normals{};
  std::vector<Eigen::Vector2d> uv{};  ///< v points up
  std::vector<std::vector<std::uint32_t>> polygons{};
};

/// Reads a PLY file (Turk 1994, version 1.0): ascii or binary, of either byte order; elements
/// `vertex`, `face` and `tristrips`, of which others are skipped. Texture coordinates are s and t,
/// u and v, or texture_u and texture_v. Polygons may name vertices that there are not. Memory is
/// taken as the file goes on, never by what it claims. Throws InputError naming file, line or
/// element, and the fault.
IndexedPolygons read_ply_file(const std::filesystem::path& path);

}  // namespace lightwell
