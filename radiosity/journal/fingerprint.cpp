#include "radiosity/journal/fingerprint.h"

#include <cstring>

#include "mesh/patches/patch_mesh.h"
#include "scene/facet_textures.h"

namespace lightwell {

void Fingerprint::add_bytes(std::span<const std::byte> bytes) {
  constexpr std::size_t word = sizeof(std::uint64_t);
  step(bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += word) {
    std::uint64_t next = 0;
    std::memcpy(&next, bytes.data() + at, std::min(word, bytes.size() - at));
    step(next);
  }
}

void Fingerprint::add(const PatchMesh& mesh) {
  add_geometry(mesh);
  add(mesh.reflectance);
  add(mesh.transmittance);
  add(mesh.emission);
  if (mesh.source_scale.size() > 0) add(mesh.source_scale);
}

void Fingerprint::add_geometry(const PatchMesh& mesh) {
  add(mesh.patch);
  add(mesh.facet);
  add(mesh.first_element);
  add(mesh.material);
  add(mesh.is_back);
  add(mesh.area);
  for (const std::array<int, 4>& corners : mesh.corners) {
    add_bytes(std::as_bytes(std::span(corners)));
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d at = mesh.position(v);
    add_bytes(std::as_bytes(std::span(at.data(), 3)));
  }
  if (mesh.textures && mesh.textures->has_holes()) add(mesh.textures->hash_of_holes());
}

}  // namespace lightwell
