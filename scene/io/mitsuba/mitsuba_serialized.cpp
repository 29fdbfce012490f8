#include "scene/io/mitsuba/mitsuba_serialized.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/default_material.h"
#include "scene/io/scene_size.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::uint16_t serialized_magic = 0x041c;
constexpr std::uint16_t oldest_version = 3, latest_version = 4;
constexpr std::size_t header_size = 4;  // magic and version

// Bits of a mesh's flags.
constexpr std::uint32_t has_normals = 0x0001, has_uv = 0x0002, has_colors = 0x0008,
                        is_flat = 0x0010, is_double = 0x2000;

template <typename T>
T value_at(std::string_view bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

[[noreturn]] void fail_serialized(const std::filesystem::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

// The compressed bytes of mesh `number`. Meshes after the first are found by a table at the end of
// the file: the position of every mesh, then their number.
std::string_view bytes_of_mesh(const std::filesystem::path& path, std::string_view file,
                               int number) {
  const auto check = [&](std::size_t at) {
    if (at + header_size > file.size()) fail_serialized(path, "the file was cut off");
    const auto magic = value_at<std::uint16_t>(file, at);
    const auto version = value_at<std::uint16_t>(file, at + 2);
    if (magic != serialized_magic || version < oldest_version || version > latest_version) {
      fail_serialized(path, fmt::format("byte {} begins no mesh of version 3 or 4", at));
    }
    return version;
  };
  const std::uint16_t version = check(0);
  if (number == 0) return file;
  const std::size_t entry = version == latest_version ? 8 : 4;
  const std::size_t count =
      file.size() < 8 ? 0 : value_at<std::uint32_t>(file, file.size() - sizeof(std::uint32_t));
  if (number < 0 || static_cast<std::size_t>(number) >= count) {
    fail_serialized(
        path, fmt::format("mesh {} is asked for, but there are {}, counted from 0", number, count));
  }
  if (count > (file.size() - sizeof(std::uint32_t)) / entry) {
    fail_serialized(path, fmt::format("the file is too short for {} meshes", count));
  }
  const std::size_t place =
      file.size() - sizeof(std::uint32_t) - entry * (count - static_cast<std::size_t>(number));
  const std::uint64_t at =
      entry == 8 ? value_at<std::uint64_t>(file, place) : value_at<std::uint32_t>(file, place);
  if (at > file.size()) fail_serialized(path, "the position of a mesh lies beyond the file");
  check(static_cast<std::size_t>(at));
  return file.substr(static_cast<std::size_t>(at));
}

// Reads a zlib stream value by value.
class Inflated {
 public:
  Inflated(const std::filesystem::path& path, std::string_view bytes)
      : path_(path), compressed_size_(bytes.size()) {
    // zlib does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    left_ = bytes.size();
    if (inflateInit(&stream_) != Z_OK) fail_serialized(path_, "zlib cannot be started");
  }
  ~Inflated() { inflateEnd(&stream_); }
  Inflated(const Inflated&) = delete;
  Inflated& operator=(const Inflated&) = delete;

  template <typename T>
  T value() {
    T result{};
    read(&result, sizeof result);
    return result;
  }

  // `count` numbers of single or double precision.
  std::vector<double> numbers(std::uint64_t count, bool as_double) {
    std::vector<double> result;
    constexpr std::size_t most = 4096;
    std::array<double, most> doubles;
    std::array<float, most> floats;
    for (std::uint64_t done = 0; done < count;) {
      const auto next = static_cast<std::size_t>(std::min<std::uint64_t>(most, count - done));
      if (as_double) {
        read(doubles.data(), next * sizeof(double));
        result.insert(result.end(), doubles.begin(), doubles.begin() + next);
      } else {
        read(floats.data(), next * sizeof(float));
        result.insert(result.end(), floats.begin(), floats.begin() + next);
      }
      done += next;
    }
    return result;
  }

  // Checks a count of the file before memory is taken: deflate compresses 1032 to 1 at most.
  void check_count(std::uint64_t count, std::size_t bytes_each, const char* what) const {
    constexpr double most_ratio = 1032.0;
    if (static_cast<double>(count) * static_cast<double>(bytes_each) >
        most_ratio * static_cast<double>(compressed_size_)) {
      fail_serialized(path_, fmt::format("the file is too short for {} {}; it was damaged or cut "
                                         "off",
                                         count, what));
    }
  }

 private:
  void read(void* to, std::size_t size) {
    stream_.next_out = static_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(size);
    while (stream_.avail_out > 0) {
      if (stream_.avail_in == 0) {
        constexpr std::size_t most = 1 << 30;  // zlib counts in 32 bits
        stream_.avail_in = static_cast<uInt>(std::min(left_, most));
        left_ -= stream_.avail_in;
      }
      const int state = inflate(&stream_, Z_NO_FLUSH);
      if (state == Z_STREAM_END && stream_.avail_out == 0) return;
      if (state != Z_OK) {
        fail_serialized(path_, "its compressed data end early; the file was damaged or cut off");
      }
    }
  }

  const std::filesystem::path& path_;
  std::size_t compressed_size_ = 0, left_ = 0;
  z_stream stream_{};
};

struct SerializedMesh {
  std::string name{};
  std::vector<double> positions{}, normals{}, uv{};  // 3, 3 and 2 numbers per vertex, or none
  std::vector<std::array<std::uint32_t, 3>> triangles{};
};

SerializedMesh read_mesh(const std::filesystem::path& path, std::string_view bytes) {
  const auto version = value_at<std::uint16_t>(bytes, 2);
  Inflated from(path, bytes.substr(header_size));
  SerializedMesh mesh;
  const auto flags = from.value<std::uint32_t>();
  if (version == latest_version) {
    constexpr std::size_t longest_name = 4096;
    for (char c = from.value<char>(); c != 0; c = from.value<char>()) {
      mesh.name += c;
      if (mesh.name.size() > longest_name) fail_serialized(path, "the name of a mesh does not end");
    }
  }
  const auto vertices = from.value<std::uint64_t>(), triangles = from.value<std::uint64_t>();
  const bool as_double = (flags & is_double) != 0;
  const std::size_t number = as_double ? sizeof(double) : sizeof(float);
  from.check_count(vertices, 3 * number, "vertices");
  from.check_count(triangles, 3 * sizeof(std::uint32_t), "triangles");
  if (triangles > static_cast<std::uint64_t>(most_triangles)) {
    throw LimitError(fmt::format("{}: a mesh of {} triangles is more than the {} that are read",
                                 path.string(), triangles, most_triangles));
  }
  if (vertices > UINT32_MAX) fail_serialized(path, "the mesh has too many vertices");
  mesh.positions = from.numbers(3 * vertices, as_double);
  if (flags & has_normals) mesh.normals = from.numbers(3 * vertices, as_double);
  if (flags & has_uv) mesh.uv = from.numbers(2 * vertices, as_double);
  if (flags & has_colors) from.numbers(3 * vertices, as_double);
  if (flags & is_flat) mesh.normals.clear();
  for (std::uint64_t t = 0; t < triangles; ++t) {
    auto& triangle = mesh.triangles.emplace_back();
    for (std::uint32_t& corner : triangle) {
      corner = from.value<std::uint32_t>();
      if (corner < vertices) continue;
      fail_serialized(path, fmt::format("triangle {} names vertex {}, but there are only {}", t,
                                        corner, vertices));
    }
  }
  return mesh;
}

}  // namespace

Scene read_serialized_file(const std::filesystem::path& path, int number, MeshMaterials materials,
                           FilePolygons& polygons, MeshFronts fronts) {
  const TextFile file(path);
  const SerializedMesh from = read_mesh(path, bytes_of_mesh(path, file.text(), number));
  polygons.has_normals = fronts == MeshFronts::from_normals && !from.normals.empty();
  MeshBuilder builder;
  for (const auto& triangle : from.triangles) {
    Loop loop;
    UvLoop uv;
    NormalLoop normals;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : triangle) {
      const std::size_t at = v;
      const double* const p = &from.positions[3 * at];
      loop.emplace_back(p[0], p[1], p[2]);
      if (materials == MeshMaterials::with_uv && !from.uv.empty()) {
        uv.emplace_back(from.uv[2 * at], 1.0 - from.uv[2 * at + 1]);
      }
      if (from.normals.empty()) continue;
      const double* const n = &from.normals[3 * at];
      normals.emplace_back(n[0], n[1], n[2]);
      sum += normals.back();
    }
    if (const auto corner = placeless_corner(loop)) {
      polygons.repairs.drop_placeless(
          fmt::format("{}: vertex {} is not finite", path.string(), triangle[*corner]));
      ++polygons.count;
      continue;
    }
    if (polygons.has_normals && area_vector(loop).dot(sum) < 0.0) {
      std::ranges::reverse(loop);
      std::ranges::reverse(uv);
      std::ranges::reverse(normals);
    }
    add_repaired(builder, std::move(loop), polygons.repairs, std::move(uv), std::move(normals));
    polygons.of_facet.resize(builder.mesh().facets.size(), polygons.count++);
  }
  if (builder.empty()) fail_without_area(path, polygons.repairs);
  Scene scene{.file = path, .title = path.stem().string()};
  scene.materials.push_back(default_material(scene.bands));
  scene.surfaces.push_back(
      {.name = from.name.empty() ? path.stem().string() : from.name, .shape = builder.mesh()});
  validate(scene);
  return scene;
}

}  // namespace lightwell
