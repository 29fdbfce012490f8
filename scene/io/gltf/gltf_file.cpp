#include "scene/io/gltf/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "scene/errors.h"
#include "scene/io/gltf/gltf_compressed.h"
#include "scene/io/gltf/gltf_uri.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Sizes of the header and of the head of a chunk of a .glb (glTF 2.0, 4.4).
constexpr std::size_t glb_header = 12, chunk_head = 8;
// Elements of a sparse accessor that names no bytes for the rest, which are zeros.
constexpr std::size_t most_elements_without_bytes = 100'000;
constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Chunks {
  std::string_view json{}, binary{};
};

Chunks split_glb(const std::filesystem::path& path, std::string_view bytes) {
  const auto fail = [&](std::size_t at, const char* problem) {
    throw InputError(fmt::format("{}: byte {}: {}", path.string(), at, problem));
  };
  if (bytes.size() < glb_header + chunk_head) fail(bytes.size(), "the file was cut off");
  if (word_at(bytes, 4) != 2) fail(4, "this is no binary glTF of version 2");
  Chunks chunks;
  for (std::size_t at = glb_header; at + chunk_head <= bytes.size();) {
    const std::size_t length = word_at(bytes, at);
    const std::uint32_t kind = word_at(bytes, at + 4);
    if (length > bytes.size() - at - chunk_head) {
      fail(at, "a chunk is longer than the rest of the file, which was damaged or cut off");
    }
    const std::string_view content = bytes.substr(at + chunk_head, length);
    if (kind == json_chunk && at == glb_header) chunks.json = content;
    if (kind == binary_chunk && chunks.binary.empty()) chunks.binary = content;
    at += chunk_head + length;
  }
  if (chunks.json.empty()) fail(glb_header, "the first chunk is no JSON");
  return chunks;
}

struct Component {
  std::size_t size = 0;
  double largest = 0.0;  // integer that means 1 if normalised; 0 for floats
  double (*read)(const char*) = nullptr;
};

template <typename T>
double read_as(const char* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

Component component_of(std::size_t type) {
  switch (type) {
    case 5120:
      return {1, 127.0, &read_as<std::int8_t>};
    case 5121:
      return {1, 255.0, &read_as<std::uint8_t>};
    case 5122:
      return {2, 32767.0, &read_as<std::int16_t>};
    case 5123:
      return {2, 65535.0, &read_as<std::uint16_t>};
    case 5125:
      return {4, 4294967295.0, &read_as<std::uint32_t>};
    case 5126:
      return {4, 0.0, &read_as<float>};
    default:
      return {};
  }
}

}  // namespace

struct GltfFile::Content {
  explicit Content(const std::filesystem::path& path) : file(path) {}
  TextFile file;
  nlohmann::json json{};
  std::map<std::string, std::vector<JsonObject>, std::less<>> lists{};
  std::vector<std::string> loaded{};              // decoded or loaded buffers
  std::vector<std::string_view> buffers{};        // views into `loaded` or the file
  std::vector<std::string> buffer_faults{};       // by buffer; empty for one that can be used
  std::map<std::size_t, std::string> unpacked{};  // by compressed buffer view
};

// Memory layout of an accessor; element i begins at data + i * stride.
struct GltfFile::Elements {
  const char* data = nullptr;
  std::size_t count = 0, stride = 0;
  Component component{};
  bool normalized = false;
};

GltfFile::GltfFile(const std::filesystem::path& path)
    : path_(path), content_(std::make_unique<Content>(path)) {
  const std::string_view bytes = content_->file.text();
  Chunks chunks{.json = bytes};
  if (bytes.starts_with("glTF")) chunks = split_glb(path, bytes);
  content_->json = parse_json(path, chunks.json);
  root_.emplace(path_, content_->json, "");
  const auto asset = root_->object("asset");
  const std::string version = asset ? asset->string_or("version", "") : "";
  if (!version.starts_with("2.")) {
    root_->fail(fmt::format("this is glTF of version '{}'; version 2.0 is read", version));
  }
  for (const char* list : {"accessors", "buffers", "bufferViews", "cameras", "images", "materials",
                           "meshes", "nodes", "samplers", "scenes", "textures"}) {
    content_->lists.emplace(list, root_->objects(list));
  }
  read_buffers(chunks.binary);
}

GltfFile::~GltfFile() = default;

void GltfFile::read_buffers(std::string_view binary) {
  const auto& buffers = content_->lists.at("buffers");
  content_->loaded.resize(buffers.size());
  content_->buffers.resize(buffers.size());
  content_->buffer_faults.resize(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    try {
      const std::string uri = buffers[i].string_or("uri", "");
      const bool is_within = uri.empty() && i == 0;
      if (!uri.empty()) content_->loaded[i] = resource(buffers[i], uri);
      const std::string_view bytes = is_within ? binary : content_->loaded[i];
      const std::size_t length = buffers[i].index_or("byteLength", 0);
      // A buffer that was cut off holds what its first bytes hold.
      content_->buffers[i] = bytes.substr(0, length);
      if (length > bytes.size()) {
        buffers[i].fail(fmt::format("needs {} bytes, but there are {}", length, bytes.size()));
      }
    } catch (const LimitError&) {
      throw;
    } catch (const InputError& error) {
      content_->buffer_faults[i] = error.what();
    }
  }
}

std::string GltfFile::resource(const JsonObject& owner, const std::string& uri) const {
  if (uri.starts_with("data:")) {
    auto bytes = decode_data_uri(uri);
    if (!bytes) owner.fail("has data that is not encoded in base64");
    return std::move(*bytes);
  }
  const std::string name = decode_percent(uri);
  if (is_absolute_uri(name)) {
    owner.fail(fmt::format(
        "names '{}', and glTF allows no absolute names; name the file relative to the scene",
        excerpt(name)));
  }
  const auto path = (path_.parent_path() / name).lexically_normal();
  try {
    return TextFile(path).text();
  } catch (const LimitError&) {
    throw;
  } catch (const InputError& error) {
    owner.fail(fmt::format("names a file that cannot be used: {}", error.what()));
  }
}

std::size_t GltfFile::count(const char* list) const {
  return content_->lists.at(list).size();
}

const JsonObject& GltfFile::at(const char* list, std::size_t index,
                               const JsonObject& asking) const {
  const auto& members = content_->lists.at(list);
  if (index < members.size()) return members[index];
  asking.fail(fmt::format("names {}[{}], but there are only {}, counted from 0", list, index,
                          members.size()));
}

// The part of a buffer that `owner`, a buffer view or the extension of one, names.
std::string_view GltfFile::slice(std::size_t buffer, const JsonObject& owner) const {
  at("buffers", buffer, owner);
  const std::string_view bytes = content_->buffers[buffer];
  const std::size_t offset = owner.index_or("byteOffset", 0);
  const std::size_t length = owner.index_or("byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    const std::string& fault = content_->buffer_faults[buffer];
    if (!fault.empty()) throw InputError(fault);
    owner.fail(
        fmt::format("ends at byte {} of a buffer of {} bytes", offset + length, bytes.size()));
  }
  return bytes.substr(offset, length);
}

std::string_view GltfFile::view(std::size_t buffer_view, const JsonObject& asking) const {
  const JsonObject& view = at("bufferViews", buffer_view, asking);
  const auto packed = view.extension("EXT_meshopt_compression");
  if (!packed) return slice(view.index_or("buffer", 0), view);
  auto& unpacked = content_->unpacked;
  const auto known = unpacked.find(buffer_view);
  if (known != unpacked.end()) return known->second;
  // Packed meshes are a fifth to a tenth of plain ones.
  constexpr std::size_t most_times = 32, always = 1u << 24;
  std::size_t room = always;
  for (const std::string_view buffer : content_->buffers) room += most_times * buffer.size();
  for (const auto& [number, bytes] : unpacked) room -= std::min(room, bytes.size());
  std::string bytes = decode_meshopt(*packed, slice(packed->index_or("buffer", 0), *packed), room);
  return unpacked.emplace(buffer_view, std::move(bytes)).first->second;
}

GltfFile::Elements GltfFile::located(const JsonObject& owner, const JsonObject& a,
                                     std::size_t count, std::size_t size) const {
  const auto number = owner.index("bufferView");
  if (!number) owner.fail("has no bufferView, so it has no data");
  const std::string_view bytes = view(*number, owner);
  const std::size_t offset = owner.index_or("byteOffset", 0);
  const std::size_t stride = at("bufferViews", *number, owner).index_or("byteStride", size);
  const bool fits =
      count == 0 || (stride >= size && offset <= bytes.size() && size <= bytes.size() - offset &&
                     count - 1 <= (bytes.size() - offset - size) / stride);
  if (!fits) {
    a.fail(fmt::format("has {} elements, which do not fit into the {} bytes of its bufferView",
                       count, bytes.size()));
  }
  return {.data = bytes.data() + offset, .count = count, .stride = stride};
}

// The elements of `dense`, which may lack data, and instead of some those that `sparse` lists.
std::string GltfFile::substituted(const JsonObject& sparse, std::size_t size,
                                  const Elements& dense) const {
  std::string packed(dense.count * size, '\0');
  if (dense.data) {
    for (std::size_t i = 0; i < dense.count; ++i) {
      std::memcpy(packed.data() + i * size, dense.data + i * dense.stride, size);
    }
  }
  const auto places = sparse.object("indices"), values = sparse.object("values");
  if (!places || !values) sparse.fail("lacks 'indices' or 'values'");
  const Component component = component_of(places->index_or("componentType", 0));
  if (component.size == 0) places->fail("has a componentType that does not exist");
  const std::size_t count = sparse.index_or("count", 0);
  const Elements at = located(*places, sparse, count, component.size);
  const Elements from = located(*values, sparse, count, size);
  for (std::size_t i = 0; i < count; ++i) {
    const double place = component.read(at.data + i * at.stride);
    if (!(place >= 0.0 && place < static_cast<double>(dense.count) && place == std::floor(place))) {
      sparse.fail(fmt::format("index {} is {}, but there are {} elements", i, place, dense.count));
    }
    std::memcpy(packed.data() + static_cast<std::size_t>(place) * size, from.data + i * from.stride,
                size);
  }
  return packed;
}

GltfFile::Elements GltfFile::elements(std::size_t accessor, std::string_view type,
                                      const JsonObject& asking, std::string& store) const {
  const JsonObject& a = at("accessors", accessor, asking);
  if (a.string_or("type", "") != type) a.fail(fmt::format("must be of type {}", type));
  const Component component = component_of(a.index_or("componentType", 0));
  if (component.size == 0) a.fail("has a componentType that does not exist");
  const std::size_t size = component.size * (type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1);
  const std::size_t count = a.index_or("count", 0);
  const auto sparse = a.object("sparse");
  Elements result{.count = count, .stride = size};
  if (!sparse || a.has("bufferView")) {
    result = located(a, a, count, size);
  } else if (count > most_elements_without_bytes) {
    a.fail(fmt::format("has {} elements without a bufferView; at most {} are read", count,
                       most_elements_without_bytes));
  }
  if (sparse) {
    store = substituted(*sparse, size, result);
    result.data = store.data();
    result.stride = size;
  }
  result.component = component;
  result.normalized = a.boolean_or("normalized", false) && component.largest > 0.0;
  return result;
}

template <int size>
std::vector<Eigen::Matrix<double, size, 1>> GltfFile::tuples(std::size_t accessor,
                                                             const JsonObject& asking) const {
  std::string store;
  const Elements from = elements(accessor, size == 3 ? "VEC3" : "VEC2", asking, store);
  std::vector<Eigen::Matrix<double, size, 1>> result(from.count);
  for (std::size_t i = 0; i < from.count; ++i) {
    for (std::size_t c = 0; c < size; ++c) {
      const double x = from.component.read(from.data + i * from.stride + c * from.component.size);
      result[i][static_cast<int>(c)] =
          from.normalized ? std::max(x / from.component.largest, -1.0) : x;
    }
  }
  return result;
}

std::vector<Eigen::Vector3d> GltfFile::vectors(std::size_t accessor,
                                               const JsonObject& asking) const {
  return tuples<3>(accessor, asking);
}

std::vector<Eigen::Vector2d> GltfFile::pairs(std::size_t accessor, const JsonObject& asking) const {
  return tuples<2>(accessor, asking);
}

std::vector<int> GltfFile::indices(std::size_t accessor, std::size_t limit,
                                   const JsonObject& asking) const {
  std::string store;
  const Elements from = elements(accessor, "SCALAR", asking, store);
  std::vector<int> result(from.count);
  for (std::size_t i = 0; i < from.count; ++i) {
    const double index = from.component.read(from.data + i * from.stride);
    if (!(index >= 0.0 && index < static_cast<double>(limit) && index == std::floor(index))) {
      at("accessors", accessor, asking)
          .fail(fmt::format("index {} is {}, but there are {} vertices", i, index, limit));
    }
    result[i] = static_cast<int>(index);
  }
  return result;
}

template <class Read>
auto GltfFile::read_texture(std::size_t texture, const JsonObject& asking, Read read) const
    -> decltype(read(std::string_view(), std::string())) {
  const auto source = at("textures", texture, asking).index("source");
  if (!source) return std::nullopt;  // the source is in an extension, in a format of its own
  const JsonObject& image = at("images", *source, asking);
  const std::string called = fmt::format("{}: {}", path_.string(), image.place());
  if (const auto number = image.index("bufferView")) return read(view(*number, image), called);
  const std::string uri = image.string_or("uri", "");
  if (uri.empty()) image.fail("has neither a uri nor a bufferView");
  return read(resource(image, uri), called);
}

std::optional<PictureMean> GltfFile::texture_mean(std::size_t texture, PictureCode code,
                                                  const JsonObject& asking) const {
  return read_texture(texture, asking, [&](std::string_view bytes, const std::string& called) {
    return picture_mean(bytes, code, called);
  });
}

std::optional<Picture> GltfFile::texture_picture(std::size_t texture, PictureCode code,
                                                 const JsonObject& asking) const {
  return read_texture(texture, asking, [&](std::string_view bytes, const std::string& called) {
    return read_picture(bytes, code, called);
  });
}

}  // namespace lightwell
