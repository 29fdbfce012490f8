#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// The bytes of numbers in glTF's byte order, little-endian.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int k = 0; k < 4; ++k) text += alphabet[bits >> (18 - 6 * k) & 63u];
  }
  for (std::size_t k = 0; k < (3 - bytes.size() % 3) % 3; ++k) text[text.size() - 1 - k] = '=';
  return text;
}

/// A glTF file with a unit square in the xy plane, z = 0, front towards +z: 4 positions (accessor
/// 0) and 6 indices of two triangles (accessor 1). `more` begins with a comma, is added to the root
/// object, and must define scenes and nodes. `primitive` goes into the one primitive of mesh 0.
inline std::string square_gltf(const std::string& more, const std::string& primitive = "",
                               const std::vector<std::uint16_t>& indices = {0, 1, 2, 0, 2, 3}) {
  const std::string data =
      bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + bytes_of(indices);
  const std::string count = std::to_string(indices.size());
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(data.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
         std::to_string(2 * indices.size()) +
         R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5123,"count":)" +
         count +
         R"(,"type":"SCALAR"}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1)" +
         primitive + "}]}]" + more + "}";
}

/// A binary glTF file (.glb) with `json` as its JSON chunk.
inline std::string glb(std::string json) {
  while (json.size() % 4) json += ' ';
  const auto word = [](std::size_t n) {
    return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(n)});
  };
  constexpr std::size_t version = 2, headers = 20;
  return "glTF" + word(version) + word(headers + json.size()) + word(json.size()) + "JSON" + json;
}

}  // namespace lightwell
