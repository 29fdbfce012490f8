#include "viewer/export/gltf_parts.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "viewer/export/appearance.h"
#include "viewer/export/fan.h"

namespace lightwell {
namespace {

/// Node of a camera: its matrix turns glTF's camera, along -z with y upwards, to `camera`.
GltfJson camera_node(const BakedModel& model, const Camera& camera, int number) {
  const Eigen::Vector3d back = -(model.to_y_up * camera.direction);
  const Eigen::Vector3d up = model.to_y_up * camera.up;
  const Eigen::Vector3d right = up.cross(back), at = model.to_y_up * camera.position;
  GltfJson matrix = GltfJson::array();
  for (const Eigen::Vector3d& column : {right, up, back}) {
    for (const double x : column) matrix.push_back(x);
    matrix.push_back(0.0);
  }
  for (const double x : at) matrix.push_back(x);
  matrix.push_back(1.0);
  return {{"name", camera.name}, {"camera", number}, {"matrix", std::move(matrix)}};
}

GltfJson camera_lens(const Camera& camera, double scene_size) {
  const double aspect = static_cast<double>(camera.width) / camera.height;
  if (camera.projection == Projection::orthographic) {
    // zfar must be finite and beyond znear.
    const double znear = camera.near_distance;
    return {{"name", camera.name},
            {"type", "orthographic"},
            {"orthographic",
             {{"xmag", 0.5 * camera.view_width},
              {"ymag", 0.5 * camera.view_width / aspect},
              {"znear", znear},
              {"zfar", znear + 1e3 * scene_size}}}};
  }
  const double half_width = std::tan(camera.fov_degrees * std::numbers::pi / 360.0);
  return {{"name", camera.name},
          {"type", "perspective"},
          {"perspective",
           {{"aspectRatio", aspect},
            {"yfov", 2.0 * std::atan(half_width / aspect)},
            {"znear", 1e-3 * scene_size}}}};
}

double extent_of(const BakedModel& model) {
  Eigen::Vector3d low = model.position.front(), high = low;
  for (const Eigen::Vector3d& p : model.position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// Unit of the colours' radiosity. Colours of spectral bands are weighted sums of the bands.
const char* unit_of_radiosity(const BakedModel& model) {
  if (model.relative_units) return "relative";
  return model.bands.wavelengths_nm.empty() ? "W/m^2" : "W/m^2, weighted to linear sRGB";
}

/// Extras of the asset: the quantities of colour 1 and their units, by B = pi L.
GltfJson meaning(const BakedModel& model) {
  const double scale = model.color_scale;
  const auto clipped = (model.radiance * static_cast<float>(scale) > 1.0f).rowwise().any().count();
  const double B = std::numbers::pi / scale;
  return {{"exposure", scale},
          {"radiosity_of_color_1", B},
          {"luminance_of_white", model.bands.lumens_per_watt / scale},
          {"unit_of_radiosity", unit_of_radiosity(model)},
          {"unit_of_illuminance", model.relative_units ? "relative" : "lx"},
          {"unit_of_luminance", model.relative_units ? "relative" : "cd/m^2"},
          {"clipped_vertices", clipped},
          {"vertices", model.vertex_count()},
          {"scene", model.provenance.scene_file},
          {"scene_hash", fmt::format("{:016x}", model.provenance.scene_hash)},
          {"options", model.provenance.options}};
}

void append_chunk_head(std::string& head, std::size_t length, const char* kind) {
  append_bytes(head, static_cast<std::uint32_t>(length));
  head.append(kind, 4);
}

Eigen::Vector3f turned(const BakedModel& model, const Eigen::Vector3d& place) {
  return (model.to_y_up * place).cast<float>();
}

/// The luminaires' faces as triangles; faces share no corners.
struct LampTriangles {
  struct Lamp {
    int number = 0;
    std::size_t first_corner = 0, first_index = 0, index_count = 0;
  };
  std::vector<Lamp> lamps{};
  std::vector<Eigen::Vector3d> corners{};
  std::vector<Eigen::Array3f> radiance{};  // at corners
  std::vector<std::uint32_t> indices{};    // from the lamp's first corner
};

LampTriangles triangles_of_lamps(const BakedModel& model) {
  LampTriangles result;
  for (const BakedLampFace& face : model.lamp_faces) {
    if (result.lamps.empty() || result.lamps.back().number != face.lamp) {
      result.lamps.push_back({.number = face.lamp,
                              .first_corner = result.corners.size(),
                              .first_index = result.indices.size()});
    }
    LampTriangles::Lamp& lamp = result.lamps.back();
    const auto first = static_cast<std::uint32_t>(result.corners.size() - lamp.first_corner);
    const auto count = static_cast<std::uint32_t>(face.outline.size());
    append_fan(first, count, result.indices);
    result.corners.insert(result.corners.end(), face.outline.begin(), face.outline.end());
    result.radiance.insert(result.radiance.end(), count, face.radiance);
    lamp.index_count = result.indices.size() - lamp.first_index;
  }
  return result;
}

}  // namespace

int GltfBuffer::end_view(const char* name, int target, int stride) {
  GltfJson view = {
      {"name", name}, {"buffer", 0}, {"byteOffset", begin_}, {"byteLength", pending()}};
  if (stride > 0) view["byteStride"] = stride;
  if (target > 0) view["target"] = target;
  views_.push_back(std::move(view));
  bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');  // aligns the next view
  begin_ = bytes_.size();
  return static_cast<int>(views_.size()) - 1;
}

int GltfBuffer::add_accessor(int view, int component, const char* type, std::size_t size,
                             std::size_t first, std::size_t count) {
  accessors_.push_back({{"bufferView", view},
                        {"byteOffset", size * first},
                        {"componentType", component},
                        {"count", count},
                        {"type", type}});
  return static_cast<int>(accessors_.size()) - 1;
}

int GltfBuffer::add_positions(int view, const BakedModel& model, std::span<const int> vertices,
                              std::size_t first) {
  std::vector<Eigen::Vector3d> places;
  places.reserve(vertices.size());
  for (const int v : vertices) places.push_back(model.position[v]);
  return add_positions(view, model, places, first);
}

int GltfBuffer::add_positions(int view, const BakedModel& model,
                              std::span<const Eigen::Vector3d> places, std::size_t first) {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array3f high = -low;
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Array3f p = turned(model, place);
    low = low.min(p);
    high = high.max(p);
  }
  const int number = add_accessor(view, gltf_float, "VEC3", 12, first, places.size());
  accessors_.back()["min"] = {low[0], low[1], low[2]};
  accessors_.back()["max"] = {high[0], high[1], high[2]};
  return number;
}

void append_position(std::string& bytes, const BakedModel& model, int vertex) {
  for (const float x : turned(model, model.position[vertex])) append_bytes(bytes, x);
}

void add_lamps(const BakedModel& model, GltfBuffer& buffer, GltfJson& meshes, GltfJson& root) {
  if (model.lamp_faces.empty()) return;
  const LampTriangles triangles = triangles_of_lamps(model);
  for (const Eigen::Vector3d& corner : triangles.corners) {
    for (const float x : turned(model, corner)) append_bytes(buffer.bytes(), x);
  }
  const int positions = buffer.end_view("positions of luminaires", gltf_vertex_data, 12);
  const auto scale = static_cast<float>(model.color_scale);
  for (const Eigen::Array3f& L : triangles.radiance) {
    for (const float l : L) append_bytes(buffer.bytes(), std::clamp(l * scale, 0.0f, 1.0f));
  }
  const int colors = buffer.end_view("colors of luminaires", gltf_vertex_data, 12);
  for (const std::uint32_t index : triangles.indices) append_bytes(buffer.bytes(), index);
  const int indices = buffer.end_view("indices of luminaires", gltf_index_data, 0);

  const auto material = root.contains("materials") ? root["materials"].size() : 0;
  root["materials"].push_back(unlit_material({.name = "luminaires"}));
  for (std::size_t i = 0; i < triangles.lamps.size(); ++i) {
    const LampTriangles::Lamp& lamp = triangles.lamps[i];
    const std::size_t end = i + 1 < triangles.lamps.size() ? triangles.lamps[i + 1].first_corner
                                                           : triangles.corners.size();
    const std::size_t first = lamp.first_corner, count = end - first;
    const std::span<const Eigen::Vector3d> corners(&triangles.corners[first], count);
    GltfJson attributes = {{"POSITION", buffer.add_positions(positions, model, corners, first)}};
    attributes["COLOR_0"] = buffer.add_accessor(colors, gltf_float, "VEC3", 12, first, count);
    const int of_lamp = buffer.add_accessor(indices, gltf_unsigned_int, "SCALAR", 4,
                                            lamp.first_index, lamp.index_count);
    GltfJson primitive = {
        {"attributes", std::move(attributes)}, {"indices", of_lamp}, {"material", material}};
    meshes.push_back({{"name", model.lamp_names[static_cast<std::size_t>(lamp.number)]},
                      {"primitives", GltfJson::array({std::move(primitive)})}});
  }
}

GltfJson unlit_material(const BakedMaterial& material) {
  GltfJson entry = {{"name", material.name},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {1.0, 1.0, 1.0, material.is_glass ? glass_opacity : 1.0}},
                      {"metallicFactor", 0.0},
                      {"roughnessFactor", 1.0}}}};
  entry["extensions"]["KHR_materials_unlit"] = GltfJson::object();
  if (material.is_glass) entry["alphaMode"] = "BLEND";
  return entry;
}

GltfJson gltf_asset(const BakedModel& model) {
  return {{"version", "2.0"},
          {"generator", fmt::format("Lightwell {}", model.provenance.version)},
          {"extras", meaning(model)}};
}

void add_nodes(const BakedModel& model, GltfJson meshes, GltfJson& root) {
  GltfJson nodes = GltfJson::array(), cameras = GltfJson::array();
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    nodes.push_back({{"name", meshes[m]["name"]}, {"mesh", m}});
  }
  const double size = extent_of(model);
  for (const BakedCamera& baked : model.cameras) {
    if (!model.cameras_are_given) break;
    nodes.push_back(camera_node(model, baked.camera, static_cast<int>(cameras.size())));
    cameras.push_back(camera_lens(baked.camera, size));
  }
  GltfJson roots = GltfJson::array();
  for (std::size_t n = 0; n < nodes.size(); ++n) roots.push_back(n);
  root["scene"] = 0;
  root["scenes"] = GltfJson::array({{{"nodes", std::move(roots)}}});
  if (!model.title.empty()) root["scenes"][0]["name"] = model.title;
  root["nodes"] = std::move(nodes);
  root["meshes"] = std::move(meshes);
  if (!cameras.empty()) root["cameras"] = std::move(cameras);
}

void write_glb(const std::filesystem::path& path, GltfJson root, const GltfBuffer& buffer) {
  const std::string& bytes = buffer.bytes();
  root["accessors"] = buffer.accessors();
  root["bufferViews"] = buffer.views();
  root["buffers"] = GltfJson::array({{{"byteLength", bytes.size()}}});

  // Names come from the user's files: bytes that are not UTF-8 are replaced.
  std::string json = root.dump(-1, ' ', false, GltfJson::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t heads = 12 + 8 + 8;
  const std::size_t length = heads + json.size() + bytes.size();
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw std::runtime_error(
        fmt::format("{}: a .glb holds at most 4 GiB, but this model takes {:.1f}; write .ply",
                    path.string(), static_cast<double>(length) / (1u << 30)));
  }
  std::string head = "glTF";
  append_bytes(head, std::uint32_t{2});
  append_bytes(head, static_cast<std::uint32_t>(length));
  append_chunk_head(head, json.size(), "JSON");
  std::string binary_head;
  append_chunk_head(binary_head, bytes.size(), "BIN\0");
  write_whole(path, {head, json, binary_head, bytes});
}

}  // namespace lightwell
