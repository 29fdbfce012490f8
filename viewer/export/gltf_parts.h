#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "viewer/export/baked_model.h"
#include "viewer/export/write_whole.h"

namespace lightwell {

using GltfJson = nlohmann::ordered_json;

// Numbers that glTF 2.0 gives things.
inline constexpr int gltf_float = 5126, gltf_unsigned_int = 5125;
inline constexpr int gltf_vertex_data = 34962, gltf_index_data = 34963;

/// The binary chunk of a .glb, and what its JSON says of it.
class GltfBuffer {
 public:
  std::string& bytes() { return bytes_; }
  const std::string& bytes() const { return bytes_; }
  /// What was appended since the last view is one; returns its number. `target` and `stride` are
  /// left out where they are 0.
  int end_view(const char* name, int target, int stride);
  /// A stretch of a view: `count` things of `size` bytes from the `first` on; returns its number.
  int add_accessor(int view, int component, const char* type, std::size_t size, std::size_t first,
                   std::size_t count);
  /// The same of three floats each, with the bounds that glTF wants of positions.
  int add_positions(int view, const BakedModel& model, std::span<const int> vertices,
                    std::size_t first);
  /// Bytes since the last view ended.
  std::size_t pending() const { return bytes_.size() - begin_; }

  const GltfJson& views() const { return views_; }
  const GltfJson& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  std::size_t begin_ = 0;
  GltfJson views_ = GltfJson::array(), accessors_ = GltfJson::array();
};

/// In the model's axes of glTF.
void append_position(std::string& bytes, const BakedModel& model, int vertex);

/// Unlit, named, glass as a veil: what shows a model's light as it is.
GltfJson unlit_material(const BakedMaterial& material);

/// `asset`, with what the colours stand for in its extras. A surface of radiance L has radiosity
/// pi L.
GltfJson gltf_asset(const BakedModel& model);

/// Scene, nodes and cameras around meshes that stand in the order of their surfaces.
void add_nodes(const BakedModel& model, GltfJson meshes, GltfJson& root);

/// Writes a .glb of what was collected. Throws std::runtime_error naming the file.
void write_glb(const std::filesystem::path& path, GltfJson root, const GltfBuffer& buffer);

}  // namespace lightwell
