#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "raytrace/pictures/encode_png.h"
#include "viewer/export/export.h"
#include "viewer/export/gltf_parts.h"

namespace lightwell {
namespace {

/// The greatest bound of illuminance of the faces at each vertex, lx; empty if no bounds are known.
std::vector<float> vertex_bounds(const BakedModel& model) {
  if (model.lux_within.empty()) return {};
  std::vector<float> bounds(static_cast<std::size_t>(model.vertex_count()), 0.0f);
  for (int f = 0; f < model.face_count(); ++f) {
    for (int c = 0; c < model.corner_count(f); ++c) {
      float& bound = bounds[static_cast<std::size_t>(model.faces[static_cast<std::size_t>(f)][c])];
      bound = std::max(bound, model.lux_within[static_cast<std::size_t>(f)]);
    }
  }
  return bounds;
}

/// Buffer with one view for each vertex attribute. A part's vertices are consecutive in every view.
class VertexColorBuffer {
 public:
  explicit VertexColorBuffer(const BakedModel& model) : model_(model) {
    std::string& bytes = buffer_.bytes();
    const auto scale = static_cast<float>(model.color_scale);
    for (int v = 0; v < model.vertex_count(); ++v) append_position(bytes, model, v);
    positions_ = buffer_.end_view("positions", gltf_vertex_data, 12);
    for (Eigen::Index v = 0; v < model.radiance.rows(); ++v) {
      Eigen::Array3f L = model.radiance.row(v).transpose();
      if (!model.pictures.empty()) L *= model.picture_gain.row(v).transpose();
      for (const float l : L) append_bytes(bytes, std::clamp(l * scale, 0.0f, 1.0f));
    }
    colors_ = buffer_.end_view("colors", gltf_vertex_data, 12);
    for (const Eigen::Vector2f& place : model.place) {
      for (const float x : place) append_bytes(bytes, x);
    }
    if (!model.place.empty()) places_ = buffer_.end_view("places", gltf_vertex_data, 8);
    for (const float lux : model.illuminance) append_bytes(bytes, lux);
    illuminance_ = buffer_.end_view("illuminance", gltf_vertex_data, 4);
    for (const float within : vertex_bounds(model)) append_bytes(bytes, within);
    if (!model.lux_within.empty()) within_ = buffer_.end_view("within", gltf_vertex_data, 4);
    for (const BakedPart& part : model.parts) {
      first_index_.push_back(buffer_.pending() / 4);
      for (const auto& triangle : triangles_of(model, part.first_face, part.face_count)) {
        for (const int v : triangle) {
          append_bytes(bytes, static_cast<std::uint32_t>(v - part.first_vertex));
        }
      }
    }
    first_index_.push_back(buffer_.pending() / 4);
    indices_ = buffer_.end_view("indices", gltf_index_data, 0);
  }

  GltfBuffer& buffer() { return buffer_; }

  GltfJson primitive(std::size_t part_number) {
    const BakedPart& part = model_.parts[part_number];
    const int first = part.first_vertex, count = part.vertex_count;
    std::vector<int> vertices(static_cast<std::size_t>(count));
    std::iota(vertices.begin(), vertices.end(), first);
    GltfJson attributes = {
        {"POSITION", buffer_.add_positions(positions_, model_, vertices, first)}};
    attributes["COLOR_0"] = buffer_.add_accessor(colors_, gltf_float, "VEC3", 12, first, count);
    attributes["_ILLUMINANCE"] =
        buffer_.add_accessor(illuminance_, gltf_float, "SCALAR", 4, first, count);
    if (!model_.lux_within.empty()) {
      attributes["_ILLUMINANCE_WITHIN"] =
          buffer_.add_accessor(within_, gltf_float, "SCALAR", 4, first, count);
    }
    int material = part.material;
    if (part.picture >= 0) {
      attributes["TEXCOORD_0"] = buffer_.add_accessor(places_, gltf_float, "VEC2", 8, first, count);
      material = static_cast<int>(model_.materials.size()) + part.picture;
    }
    const std::size_t begin = first_index_[part_number], end = first_index_[part_number + 1];
    const int indices =
        buffer_.add_accessor(indices_, gltf_unsigned_int, "SCALAR", 4, begin, end - begin);
    return {{"attributes", std::move(attributes)},
            {"indices", indices},
            {"material", material},
            {"extras", {{"side", part.is_back ? "back" : "front"}}}};
  }

 private:
  const BakedModel& model_;
  GltfBuffer buffer_;
  int positions_ = 0, colors_ = 0, places_ = 0, illuminance_ = 0, within_ = 0, indices_ = 0;
  std::vector<std::size_t> first_index_;
};

/// One mesh for each surface.
GltfJson meshes_of(const BakedModel& model, VertexColorBuffer& buffer) {
  GltfJson meshes = GltfJson::array();
  std::map<int, std::size_t> mesh_of;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const BakedPart& part = model.parts[p];
    const auto [at, is_new] = mesh_of.try_emplace(part.surface, meshes.size());
    if (is_new) meshes.push_back({{"name", part.name}, {"primitives", GltfJson::array()}});
    meshes[at->second]["primitives"].push_back(buffer.primitive(p));
  }
  return meshes;
}

/// Wrapping and filtering of a picture by the numbers of WebGL.
GltfJson sampler_of(const DrawnPicture& picture) {
  constexpr int nearest = 9728, linear = 9729, nearest_mipmap_linear = 9986, linear_mipmap = 9987;
  const auto wrap = [](TextureWrap how) {
    constexpr int repeat = 10497, mirror = 33648, clamp = 33071;
    return how == TextureWrap::clamp ? clamp : how == TextureWrap::mirror ? mirror : repeat;
  };
  return {{"wrapS", wrap(picture.wrap[0])},
          {"wrapT", wrap(picture.wrap[1])},
          {"magFilter", picture.is_smooth ? linear : nearest},
          {"minFilter", picture.is_smooth ? linear_mipmap : nearest_mipmap_linear}};
}

/// Adds an image, a sampler, a texture and a material for each picture. A picture belongs to one
/// material of the scene.
void add_gltf_pictures(const BakedModel& model, GltfBuffer& buffer, GltfJson& root) {
  for (std::size_t p = 0; p < model.pictures.size(); ++p) {
    const DrawnPicture& picture = model.pictures[p];
    buffer.bytes() += encode_png(picture.width, picture.height, picture.rgba);
    root["images"].push_back(
        {{"bufferView", buffer.end_view("picture", 0, 0)}, {"mimeType", "image/png"}});
    root["samplers"].push_back(sampler_of(picture));
    root["textures"].push_back({{"source", p}, {"sampler", p}});
    const auto part = std::ranges::find(model.parts, static_cast<int>(p), &BakedPart::picture);
    const BakedMaterial of_part = part == model.parts.end()
                                      ? BakedMaterial{}
                                      : model.materials[static_cast<std::size_t>(part->material)];
    GltfJson material = unlit_material(of_part);
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", p}};
    if (picture.has_holes) material["alphaMode"] = "MASK";
    root["materials"].push_back(std::move(material));
  }
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const BakedModel& model) {
  VertexColorBuffer buffer(model);
  GltfJson root;
  root["asset"] = gltf_asset(model);
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  GltfJson meshes = meshes_of(model, buffer);
  for (const BakedMaterial& material : model.materials) {
    root["materials"].push_back(unlit_material(material));
  }
  add_gltf_pictures(model, buffer.buffer(), root);
  add_lamps(model, buffer.buffer(), meshes, root);
  add_nodes(model, std::move(meshes), root);
  write_glb(path, std::move(root), buffer.buffer());
}

}  // namespace lightwell
