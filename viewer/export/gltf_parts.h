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

// Component types and buffer targets of glTF 2.0.
inline constexpr int gltf_float = 5126, gltf_unsigned_int = 5125;
inline constexpr int gltf_vertex_data = 34962, gltf_index_data = 34963;

/// Binary chunk of a .glb, with the buffer views and accessors that describe the chunk in JSON.
class GltfBuffer {
 public:
  std::string& bytes() { return bytes_; }
  const std::string& bytes() const { return bytes_; }
  /// Makes a view of all bytes appended since the last view; returns the view's number. `target`
  /// and `stride` (bytes) are omitted from the JSON where 0.
  int end_view(const char* name, int target, int stride);
  /// Adds an accessor for `count` items of `size` bytes of a view, from item `first`; returns the
  /// accessor's number. `component` and `type` are glTF's component type and "SCALAR", "VEC2", ...
  int add_accessor(int view, int component, const char* type, std::size_t size, std::size_t first,
                   std::size_t count);
  /// Adds an accessor for the positions of `vertices`, with the bounds that glTF requires; returns
  /// the accessor's number. The view holds three floats a vertex; item `first` is vertices[0].
  int add_positions(int view, const BakedModel& model, std::span<const int> vertices,
                    std::size_t first);
  /// The same for places of the scene's axes.
  int add_positions(int view, const BakedModel& model, std::span<const Eigen::Vector3d> places,
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

/// Appends a vertex's position as three floats, m, in glTF's axes.
void append_position(std::string& bytes, const BakedModel& model, int vertex);

/// Material that shows vertex colours and textures without shading (KHR_materials_unlit). Glass is
/// blended with opacity glass_opacity.
GltfJson unlit_material(const BakedMaterial& material);

/// The JSON object `asset`. Its extras give the exposure, and the radiosity and the luminance of
/// colour 1.
GltfJson gltf_asset(const BakedModel& model);

/// Adds a mesh for each luminaire that is drawn, called after it, with the colours of its faces,
/// and one material for all to `root`. Materials that come later change no number.
void add_lamps(const BakedModel& model, GltfBuffer& buffer, GltfJson& meshes, GltfJson& root);

/// Adds scene, nodes, meshes and the scene's cameras to `root`: a node for each mesh.
void add_nodes(const BakedModel& model, GltfJson meshes, GltfJson& root);

/// Writes a .glb of `root` and `buffer`. Throws std::runtime_error naming the file if writing fails
/// or the content exceeds 4 GiB.
void write_glb(const std::filesystem::path& path, GltfJson root, const GltfBuffer& buffer);

}  // namespace lightwell
