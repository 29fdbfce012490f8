#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "viewer/export.h"
#include "viewer/write_whole.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

// Numbers that glTF 2.0 gives things.
constexpr int is_float = 5126, is_unsigned_int = 5125;
constexpr int is_vertex_data = 34962, is_index_data = 34963;

/// The binary chunk: what all vertices have of one kind follows one another, so that a part is a
/// stretch of each.
class Buffer {
 public:
  explicit Buffer(const BakedModel& model) : model_(model) {
    const auto scale = static_cast<float>(model.cameras.front().scale);
    for (const Eigen::Vector3d& p : model.position) {
      const Eigen::Vector3f turned = (model.to_y_up * p).cast<float>();
      for (const float x : turned) append_bytes(bytes_, x);
    }
    end_view("positions", is_vertex_data, 12);
    for (Eigen::Index v = 0; v < model.radiance.rows(); ++v) {
      for (const float L : model.radiance.row(v)) {
        append_bytes(bytes_, std::clamp(L * scale, 0.0f, 1.0f));
      }
    }
    end_view("colors", is_vertex_data, 12);
    for (const float lux : model.illuminance) append_bytes(bytes_, lux);
    end_view("illuminance", is_vertex_data, 4);
    for (const BakedPart& part : model.parts) {
      first_index_.push_back((bytes_.size() - begin_) / 4);
      for (const auto& triangle : triangles_of(model, part.first_face, part.face_count)) {
        for (const int v : triangle) {
          append_bytes(bytes_, static_cast<std::uint32_t>(v - part.first_vertex));
        }
      }
    }
    first_index_.push_back((bytes_.size() - begin_) / 4);
    end_view("indices", is_index_data, 0);
  }

  const std::string& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

  Json primitive(std::size_t part_number) {
    const BakedPart& part = model_.parts[part_number];
    Json position = accessor(0, is_float, "VEC3", 12, part.first_vertex, part.vertex_count);
    Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f high = -low;
    for (int v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      const Eigen::Array3f p = (model_.to_y_up * model_.position[v]).cast<float>();
      low = low.min(p);
      high = high.max(p);
    }
    position["min"] = {low[0], low[1], low[2]};
    position["max"] = {high[0], high[1], high[2]};
    const std::size_t first = first_index_[part_number];
    const std::size_t count = first_index_[part_number + 1] - first;
    Json attributes = {{"POSITION", add(std::move(position))}};
    attributes["COLOR_0"] =
        add(accessor(1, is_float, "VEC3", 12, part.first_vertex, part.vertex_count));
    attributes["_ILLUMINANCE"] =
        add(accessor(2, is_float, "SCALAR", 4, part.first_vertex, part.vertex_count));
    const int indices = add(accessor(3, is_unsigned_int, "SCALAR", 4, first, count));
    return {{"attributes", std::move(attributes)},
            {"indices", indices},
            {"material", part.material},
            {"extras", {{"side", part.is_back ? "back" : "front"}}}};
  }

 private:
  void end_view(const char* name, int target, int stride) {
    Json view = {{"name", name},
                 {"buffer", 0},
                 {"byteOffset", begin_},
                 {"byteLength", bytes_.size() - begin_}};
    if (stride > 0) view["byteStride"] = stride;
    view["target"] = target;
    views_.push_back(std::move(view));
    begin_ = bytes_.size();
  }
  static Json accessor(int view, int component, const char* type, std::size_t size,
                       std::size_t first, std::size_t count) {
    return {{"bufferView", view},
            {"byteOffset", size * first},
            {"componentType", component},
            {"count", count},
            {"type", type}};
  }
  int add(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }

  const BakedModel& model_;
  std::string bytes_;
  std::size_t begin_ = 0;
  std::vector<std::size_t> first_index_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

Json materials(const BakedModel& model) {
  Json result = Json::array();
  for (const BakedMaterial& material : model.materials) {
    Json entry = {{"name", material.name},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {1.0, 1.0, 1.0, material.is_glass ? glass_opacity : 1.0}},
                    {"metallicFactor", 0.0},
                    {"roughnessFactor", 1.0}}}};
    entry["extensions"]["KHR_materials_unlit"] = Json::object();
    if (material.is_glass) entry["alphaMode"] = "BLEND";
    result.push_back(std::move(entry));
  }
  return result;
}

/// A node turned so that it looks along -z with y upwards.
Json camera_node(const BakedModel& model, const Camera& camera, int number) {
  const Eigen::Vector3d back = -(model.to_y_up * camera.direction);
  const Eigen::Vector3d up = model.to_y_up * camera.up;
  const Eigen::Vector3d right = up.cross(back), at = model.to_y_up * camera.position;
  Json matrix = Json::array();
  for (const Eigen::Vector3d& column : {right, up, back}) {
    for (const double x : column) matrix.push_back(x);
    matrix.push_back(0.0);
  }
  for (const double x : at) matrix.push_back(x);
  matrix.push_back(1.0);
  return {{"name", camera.name}, {"camera", number}, {"matrix", std::move(matrix)}};
}

Json camera_lens(const Camera& camera, double scene_size) {
  const double aspect = static_cast<double>(camera.width) / camera.height;
  const double half_width = std::tan(camera.fov_degrees * std::numbers::pi / 360.0);
  return {{"name", camera.name},
          {"type", "perspective"},
          {"perspective",
           {{"aspectRatio", aspect},
            {"yfov", 2.0 * std::atan(half_width / aspect)},
            {"znear", 1e-3 * scene_size}}}};
}

double size_of(const BakedModel& model) {
  Eigen::Vector3d low = model.position.front(), high = low;
  for (const Eigen::Vector3d& p : model.position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// Of many bands the colours are weighted sums.
const char* unit_of_radiosity(const BakedModel& model) {
  if (model.relative_units) return "relative";
  return model.bands.wavelengths_nm.empty() ? "W/m^2" : "W/m^2, weighted to linear sRGB";
}

/// What the colours stand for. A surface of radiance L has radiosity pi L.
Json meaning(const BakedModel& model) {
  const double scale = model.cameras.front().scale;
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

/// Nodes, meshes and cameras.
void add_content(const BakedModel& model, Buffer& buffer, Json& root) {
  Json nodes = Json::array(), meshes = Json::array(), cameras = Json::array();
  std::map<int, std::size_t> mesh_of;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const BakedPart& part = model.parts[p];
    const auto [at, is_new] = mesh_of.try_emplace(part.surface, meshes.size());
    if (is_new) {
      nodes.push_back({{"name", part.name}, {"mesh", meshes.size()}});
      meshes.push_back({{"name", part.name}, {"primitives", Json::array()}});
    }
    meshes[at->second]["primitives"].push_back(buffer.primitive(p));
  }
  const double size = size_of(model);
  for (const BakedCamera& baked : model.cameras) {
    if (!model.cameras_are_given) break;
    nodes.push_back(camera_node(model, baked.camera, static_cast<int>(cameras.size())));
    cameras.push_back(camera_lens(baked.camera, size));
  }
  Json roots = Json::array();
  for (std::size_t n = 0; n < nodes.size(); ++n) roots.push_back(n);
  root["scene"] = 0;
  root["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
  if (!model.title.empty()) root["scenes"][0]["name"] = model.title;
  root["nodes"] = std::move(nodes);
  root["meshes"] = std::move(meshes);
  if (!cameras.empty()) root["cameras"] = std::move(cameras);
}

void append_chunk_head(std::string& head, std::size_t length, const char* kind) {
  append_bytes(head, static_cast<std::uint32_t>(length));
  head.append(kind, 4);
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const BakedModel& model) {
  Buffer buffer(model);
  Json root;
  root["asset"] = {{"version", "2.0"},
                   {"generator", fmt::format("Lightwell {}", model.provenance.version)},
                   {"extras", meaning(model)}};
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  add_content(model, buffer, root);
  root["materials"] = materials(model);
  root["accessors"] = buffer.accessors();
  root["bufferViews"] = buffer.views();
  root["buffers"] = Json::array({{{"byteLength", buffer.bytes().size()}}});

  // Names come from anybody's files: what is not UTF-8 is replaced.
  std::string json = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t heads = 12 + 8 + 8;
  const std::size_t length = heads + json.size() + buffer.bytes().size();
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
  append_chunk_head(binary_head, buffer.bytes().size(), "BIN\0");
  write_whole(path, {head, json, binary_head, buffer.bytes()});
}

}  // namespace lightwell
