#include "scene/io/gltf/gltf_compressed.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lightwell {
namespace {

constexpr const char* meshopt_name = "EXT_meshopt_compression";
constexpr const char* draco_name = "KHR_draco_mesh_compression";

[[noreturn]] void fail_damaged(const JsonObject& place, const char* extension) {
  place.fail(fmt::format("is damaged: {} cannot unpack it", extension));
}

// Elements that meshopt has packed: their number, their bytes each, and the way of packing.
struct MeshoptView {
  std::size_t count = 0, stride = 0;
  std::string mode{}, filter{};
};

// Checks what meshopt asserts of its arguments, and that so many elements can come of so few bytes.
void check_meshopt(const JsonObject& extension, const MeshoptView& view, std::size_t bytes) {
  const bool has_vertices = view.mode == "ATTRIBUTES";
  const bool strides_fit = has_vertices
                               ? view.stride >= 4 && view.stride <= 256 && view.stride % 4 == 0
                               : view.stride == 2 || view.stride == 4;
  if (!strides_fit || (view.mode == "TRIANGLES" && view.count % 3 != 0)) {
    extension.fail(fmt::format("has {} elements of {} bytes, which the mode '{}' does not know",
                               view.count, view.stride, view.mode));
  }
  const bool filter_fits =
      view.filter == "NONE" ||
      (has_vertices &&
       ((view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) ||
        (view.filter == "QUATERNION" && view.stride == 8) || view.filter == "EXPONENTIAL"));
  if (!filter_fits) {
    extension.fail(fmt::format("has the filter '{}', which elements of {} bytes do not know",
                               view.filter, view.stride));
  }
  // A column of 16 vertices has two bits at least, a triangle and an index one byte each.
  const std::size_t most = has_vertices               ? bytes * 64 / view.stride
                           : view.mode == "TRIANGLES" ? bytes * 3
                                                      : bytes;
  if (view.count > most) {
    extension.fail(
        fmt::format("has {} elements, more than can come of {} bytes", view.count, bytes));
  }
}

void undo_filter(const MeshoptView& view, std::string& bytes) {
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
}

// Numbers of triangles and points in the head of a mesh, which the library takes memory for before
// it has seen more.
struct DracoCounts {
  std::uint64_t triangles = 0, points = 0;
};

// Reads the head byte by byte; every read is 0 behind the end.
class DracoHead {
 public:
  explicit DracoHead(std::string_view bytes) : bytes_(bytes) {}
  unsigned byte() {
    const unsigned value = at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_]) : 0;
    ++at_;
    return value;
  }
  // A number of seven bits a byte, the lowest first.
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const unsigned part = byte();
      value |= std::uint64_t{part & 0x7f} << shift;
      if (part < 0x80) break;
    }
    return value;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The head of a bitstream of version 2.2, the only one of glTF; empty for other content.
std::optional<DracoCounts> counts_of(std::string_view bytes) {
  constexpr std::string_view magic = "DRACO";
  if (!bytes.starts_with(magic)) return std::nullopt;
  DracoHead head(bytes.substr(magic.size()));
  constexpr unsigned triangular_mesh = 1, sequential = 0;
  const unsigned major = head.byte(), minor = head.byte(), kind = head.byte(), method = head.byte();
  const unsigned flags = head.byte() | head.byte() << 8;
  // Metadata would stand before the counts; glTF has its own.
  if (major != 2 || minor != 2 || kind != triangular_mesh || flags != 0) return std::nullopt;
  DracoCounts counts;
  if (method == sequential) {
    counts.triangles = head.varint();
    counts.points = head.varint();
  } else {
    head.byte();  // the way through the triangles
    counts.points = head.varint();
    counts.triangles = head.varint();
  }
  return counts;
}

template <int size>
std::vector<Eigen::Matrix<double, size, 1>> values_of(const draco::Mesh& mesh, std::int64_t number,
                                                      const JsonObject& primitive) {
  if (number < 0) return {};
  const draco::PointAttribute* attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(number));
  if (!attribute || attribute->num_components() != size) {
    primitive.fail(fmt::format("names the attribute {} of {}, which is none of {} numbers", number,
                               draco_name, size));
  }
  std::vector<Eigen::Matrix<double, size, 1>> values(mesh.num_points());
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    std::array<float, size> value{};
    const auto at = attribute->mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute->size() ||
        !attribute->ConvertValue<float, size>(at, value.data())) {
      fail_damaged(primitive, draco_name);
    }
    for (int c = 0; c < size; ++c) values[i][c] = static_cast<double>(value[c]);
  }
  return values;
}

}  // namespace

std::string decode_meshopt(const JsonObject& extension, std::string_view compressed,
                           std::size_t most) {
  const MeshoptView view{.count = extension.index_or("count", 0),
                         .stride = extension.index_or("byteStride", 0),
                         .mode = extension.string_or("mode", ""),
                         .filter = extension.string_or("filter", "NONE")};
  const bool has_vertices = view.mode == "ATTRIBUTES", has_triangles = view.mode == "TRIANGLES";
  if (!has_vertices && !has_triangles && view.mode != "INDICES") {
    extension.fail(fmt::format("has the mode '{}', which is none", view.mode));
  }
  check_meshopt(extension, view, compressed.size());
  if (view.count * view.stride > most) {
    extension.fail(fmt::format("unpacks to {} bytes, with the other views too many for the file",
                               view.count * view.stride));
  }
  std::string bytes(view.count * view.stride, '\0');
  const auto* from = reinterpret_cast<const unsigned char*>(compressed.data());
  using Decode = int(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  Decode* decode = meshopt_decodeIndexSequence;
  if (has_vertices) decode = meshopt_decodeVertexBuffer;
  if (has_triangles) decode = meshopt_decodeIndexBuffer;
  if (decode(bytes.data(), view.count, view.stride, from, compressed.size()) != 0) {
    fail_damaged(extension, meshopt_name);
  }
  undo_filter(view, bytes);
  return bytes;
}

DracoMesh decode_draco(const JsonObject& primitive, std::string_view compressed,
                       const DracoAttributes& attributes,
                       const std::function<void(std::int64_t triangles)>& expect) {
  const auto counts = counts_of(compressed);
  constexpr std::uint64_t most = 1u << 31;
  if (!counts || counts->triangles >= most || counts->points > 3 * counts->triangles) {
    primitive.fail(fmt::format("has no triangle mesh of {} in version 2.2", draco_name));
  }
  expect(static_cast<std::int64_t>(counts->triangles));
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(compressed.data(), compressed.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) fail_damaged(primitive, draco_name);
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    DracoMesh result{.positions = values_of<3>(*mesh, attributes.position, primitive),
                     .normals = values_of<3>(*mesh, attributes.normal, primitive),
                     .uv = values_of<2>(*mesh, attributes.uv, primitive)};
    result.indices.reserve(std::size_t{3} * mesh->num_faces());
    for (std::uint32_t i = 0; i < mesh->num_faces(); ++i) {
      for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(i))) {
        if (corner.value() >= result.positions.size()) fail_damaged(primitive, draco_name);
        result.indices.push_back(static_cast<int>(corner.value()));
      }
    }
    return result;
  } catch (const std::bad_alloc&) {
    fail_damaged(primitive, draco_name);
  } catch (const std::length_error&) {
    fail_damaged(primitive, draco_name);
  }
}

}  // namespace lightwell
