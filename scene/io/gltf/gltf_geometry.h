#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/gltf/gltf_file.h"

namespace lightwell {

/// Vertices of a primitive in its own coordinates, and their order.
struct GltfGeometry {
  std::vector<Eigen::Vector3d> positions{};
  std::vector<Eigen::Vector3d> normals{};  ///< by vertex, or empty
  std::vector<Eigen::Vector2d> uv{};       ///< by vertex, or empty
  std::optional<std::vector<int>> indices{};

  std::size_t corners() const { return indices ? indices->size() : positions.size(); }
  std::size_t vertex(std::size_t corner) const {
    return indices ? static_cast<std::size_t>((*indices)[corner]) : corner;
  }
};

/// Reads a primitive, plain or packed by KHR_draco_mesh_compression. `uv_set` names the set of
/// texture coordinates ("TEXCOORD_0"); empty for none. Calls `expect` with the number of triangles
/// of a packed mesh before it is unpacked. Throws InputError naming the faulty object.
GltfGeometry read_geometry(const GltfFile& file, const JsonObject& primitive,
                           const JsonObject& attributes, const std::string& uv_set,
                           const std::function<void(std::int64_t triangles)>& expect);

}  // namespace lightwell
