#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "scene/io/pov/pov_solids.h"

namespace lightwell {
namespace {

using Corners = std::array<std::size_t, 3>;

/// Lists of a block mesh2.
struct MeshLists {
  Loop vertices{}, normals{}, uv{};
  std::vector<const PovNode*> textures{};
  std::vector<Corners> faces{}, face_normals{}, face_uv{};
  std::vector<int> texture_of{};  // of faces; -1: that of the mesh
};

Loop read_vectors(const PovNode& list) {
  PovCursor cursor(list);
  const std::size_t count = cursor.need_count("number of entries");
  Loop result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(cursor.need_point("entries"));
  return result;
}

std::size_t as_index(double value, const PovNode& list) {
  constexpr double most = 1e9;
  if (!(value > -0.5 && value < most)) list.fail(fmt::format("has the index {:g}", value));
  return static_cast<std::size_t>(std::llround(value));
}

// A triangle is a vector of three indices; numbers behind it choose the texture.
std::vector<Corners> read_triples(const PovNode& list, std::vector<int>* textures) {
  PovCursor cursor(list);
  const std::size_t count = cursor.need_count("number of entries");
  std::vector<Corners> result;
  while (!cursor.at_end() && result.size() < count) {
    const Eigen::Vector3d entry = cursor.need_point("entries");
    result.push_back(
        {as_index(entry[0], list), as_index(entry[1], list), as_index(entry[2], list)});
    int texture = -1;
    for (const PovItem* item = cursor.look(); item && item->vector() && item->vector()->count == 1;
         item = cursor.look()) {
      const double number = cursor.number().value_or(0.0);
      if (texture < 0) texture = static_cast<int>(as_index(number, list));
    }
    if (textures) textures->push_back(texture);
  }
  if (result.size() < count) {
    list.fail(fmt::format("has {} entries, and announces {}", result.size(), count));
  }
  return result;
}

void read_list(const PovNode& list, MeshLists& mesh) {
  const std::string_view word = list.keyword;
  if (word == "vertex_vectors") mesh.vertices = read_vectors(list);
  if (word == "normal_vectors") mesh.normals = read_vectors(list);
  if (word == "uv_vectors") mesh.uv = read_vectors(list);
  if (word == "face_indices") mesh.faces = read_triples(list, &mesh.texture_of);
  if (word == "normal_indices") mesh.face_normals = read_triples(list, nullptr);
  if (word == "uv_indices") mesh.face_uv = read_triples(list, nullptr);
  if (word == "texture_list") {
    for (const PovItem& item : list.items) {
      if (item.node()) mesh.textures.push_back(item.node());
    }
  }
}

const Eigen::Vector3d& entry_of(const Loop& list, std::size_t index, const PovNode& node) {
  if (index >= list.size()) {
    node.fail(fmt::format("names the entry {} of a list of {}", index, list.size()));
  }
  return list[index];
}

}  // namespace

PovSolid read_pov_mesh2(PovCursor& cursor) {
  MeshLists mesh;
  while (const PovNode* list = cursor.look() ? cursor.look()->node() : nullptr) {
    const std::string_view word = list->keyword;
    if (!word.ends_with("_vectors") && !word.ends_with("_indices") && word != "texture_list") break;
    read_list(*list, mesh);
    cursor.next();
  }
  const PovNode& node = cursor.node();
  // Without indices of their own, normals and coordinates go with the vertices.
  if (mesh.face_normals.empty() && !mesh.normals.empty()) mesh.face_normals = mesh.faces;
  if (mesh.face_uv.empty() && !mesh.uv.empty()) mesh.face_uv = mesh.faces;
  std::map<int, PovFacets> by_texture;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const int texture = mesh.texture_of[f];
    const bool is_known = texture >= 0 && static_cast<std::size_t>(texture) < mesh.textures.size();
    PovFacets& facets = by_texture[is_known ? texture : -1];
    Loop& loop = facets.loops.emplace_back();
    NormalLoop& normals = facets.normals.emplace_back();
    UvLoop& uv = facets.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      loop.push_back(entry_of(mesh.vertices, mesh.faces[f][k], node));
      if (f < mesh.face_normals.size()) {
        normals.push_back(entry_of(mesh.normals, mesh.face_normals[f][k], node));
      }
      if (f < mesh.face_uv.size()) {
        const Eigen::Vector3d& at = entry_of(mesh.uv, mesh.face_uv[f][k], node);
        uv.emplace_back(at.x(), 1.0 - at.y());
      }
    }
  }
  PovSolid solid{.is_closed = false};
  for (auto& [texture, facets] : by_texture) {
    solid.pieces.push_back(
        {.shape = std::move(facets),
         .texture = texture < 0 ? nullptr : mesh.textures[static_cast<std::size_t>(texture)]});
  }
  return solid;
}

}  // namespace lightwell
