#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/json_object.h"

namespace lightwell {

/// Bytes of a buffer view from those that EXT_meshopt_compression made of them; `extension` is the
/// view's object of this extension. Throws InputError naming the view where the bytes are damaged
/// or are fewer than its count can come of, and where the result has more than `most` bytes.
std::string decode_meshopt(const JsonObject& extension, std::string_view compressed,
                           std::size_t most);

/// Numbers of the attributes within a mesh of KHR_draco_mesh_compression; -1 for none.
struct DracoAttributes {
  std::int64_t position = -1, normal = -1, uv = -1;
};

/// A triangle mesh, by vertex.
struct DracoMesh {
  std::vector<Eigen::Vector3d> positions{}, normals{};
  std::vector<Eigen::Vector2d> uv{};
  std::vector<int> indices{};  ///< three for each triangle, all below the number of positions
};

/// The mesh that KHR_draco_mesh_compression has packed into `compressed`. Calls `expect` with the
/// number of triangles before any memory is taken for them. Throws InputError naming `primitive`
/// where the bytes are damaged or have other content.
DracoMesh decode_draco(const JsonObject& primitive, std::string_view compressed,
                       const DracoAttributes& attributes,
                       const std::function<void(std::int64_t triangles)>& expect);

}  // namespace lightwell
