#include "scene/io/remarks.h"

#include <fmt/format.h>

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::size_t listed = 5;

}  // namespace

void Remarks::add(std::string_view what, std::string_view name) {
  auto found = std::find_if(remarks_.begin(), remarks_.end(),
                            [&](const Remark& remark) { return remark.what == what; });
  if (found == remarks_.end()) {
    found = remarks_.insert(remarks_.end(), Remark{.what = std::string(what)});
  }
  const bool is_new = found->names.emplace(name).second;
  if (is_new && found->first.size() < listed) found->first.emplace_back(name);
}

std::vector<std::string> Remarks::sentences() const {
  std::vector<std::string> result;
  for (const Remark& remark : remarks_) {
    std::string sentence = remark.what + ": ";
    for (std::size_t i = 0; i < remark.first.size(); ++i) {
      sentence += fmt::format("{}'{}'", i ? ", " : "", remark.first[i]);
    }
    const std::size_t more = remark.names.size() - remark.first.size();
    if (more > 0) sentence += fmt::format(" and {} more", more);
    result.push_back(sentence + ".");
  }
  return result;
}

void remark_pictures_without_uv(const Scene& scene, Remarks& remarks) {
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (!material.texture && !material.mask) continue;
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const auto has_uv = [](const Facet& facet) { return facet.uv_map >= 0; };
    if (mesh && std::ranges::all_of(mesh->facets, has_uv)) continue;
    if (material.texture) {
      remarks.add("Pictures on surfaces without texture coordinates count by their mean colour",
                  surface.name);
    }
    if (material.mask) {
      remarks.add("Masks on surfaces without texture coordinates were left out", surface.name);
    }
  }
}

void drop_unused_uv(Scene& scene) {
  for (Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh || material.texture || material.mask || mesh->uv_maps.empty()) continue;
    mesh->uv_maps = {};
    for (Facet& facet : mesh->facets) facet.uv_map = -1;
  }
}

void note_if_dark(Scene& scene) {
  if (!gives_light(scene)) scene.notes.emplace_back("No surface shines, so the scene is dark.");
}

}  // namespace lightwell
