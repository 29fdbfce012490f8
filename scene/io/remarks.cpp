#include "scene/io/remarks.h"

#include <fmt/format.h>

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::size_t few = 5;  // names in a note

}  // namespace

Remarks::Remark& Remarks::record(std::string_view what, std::string_view name) {
  auto found = numbers_.find(what);
  if (found == numbers_.end()) {
    found = numbers_.emplace(what, remarks_.size()).first;
    remarks_.push_back({.what = std::string(what)});
  }
  Remark& remark = remarks_[found->second];
  if (!remark.known.contains(name)) {
    remark.known.emplace(name);
    remark.names.emplace_back(name);
  }
  return remark;
}

void Remarks::add(std::string_view what, std::string_view name) {
  record(what, name);
}

void Remarks::add_unusable(std::string_view what, std::string_view name, std::string_view why) {
  Remark& remark = record(what, name);
  if (remark.why.empty()) remark.why = why;
}

void Remarks::mention(std::string_view what, std::string_view name) {
  record(what, name).is_loss = false;
}

std::string Remarks::sentence(const Remark& remark, std::size_t listed) {
  std::string sentence = remark.what + ": ";
  const std::size_t count = std::min(listed, remark.names.size());
  for (std::size_t i = 0; i < count; ++i) {
    sentence += fmt::format("{}'{}'", i ? ", " : "", remark.names[i]);
  }
  const std::size_t more = remark.names.size() - count;
  if (more > 0) sentence += fmt::format(" and {} more", more);
  if (remark.why.empty()) return sentence + ".";
  return fmt::format("{}{}: {}.", sentence, remark.names.size() > 1 ? "; the first" : "",
                     remark.why);
}

std::vector<std::string> Remarks::sentences() const {
  std::vector<std::string> result;
  for (const Remark& remark : remarks_) result.push_back(sentence(remark, few));
  return result;
}

void Remarks::report_to(Scene& scene) const {
  for (const Remark& remark : remarks_) {
    scene.notes.push_back(sentence(remark, few));
    if (remark.is_loss) scene.losses.push_back(sentence(remark, remark.names.size()));
  }
}

void add_loss(Scene& scene, const std::string& sentence) {
  scene.notes.push_back(sentence);
  scene.losses.push_back(sentence);
}

void note_repairs(const Repairs& repairs, Scene& scene) {
  for (const std::string& note : repairs.notes()) scene.notes.push_back(note + ".");
  Repairs losses = repairs;
  losses.split = 0;
  for (const std::string& note : losses.notes()) scene.losses.push_back(note + ".");
  scene.dropped_polygons = repairs.thin + repairs.placeless;
}

void fail_without_surfaces(const std::filesystem::path& file, std::string_view problem,
                           const Remarks& remarks) {
  std::string message = fmt::format("{}: {}", file.string(), problem);
  for (const std::string& sentence : remarks.sentences()) message += "; " + sentence;
  throw InputError(message);
}

void remark_pictures_without_uv(const Scene& scene, Remarks& remarks) {
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (!material.shows_picture()) continue;
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const auto has_uv = [](const Facet& facet) { return facet.uv_map >= 0; };
    if (mesh && std::ranges::all_of(mesh->facets, has_uv)) continue;
    if (material.texture || material.emission_texture) {
      remarks.add("Pictures on surfaces without texture coordinates count by their mean colour",
                  surface.name);
    }
    if (material.mask) {
      remarks.add("Masks on surfaces without texture coordinates were left out", surface.name);
    }
    if (material.relief) {
      remarks.add("Relief on surfaces without texture coordinates was left out", surface.name);
    }
  }
}

void drop_unused_uv(Scene& scene) {
  for (Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh || material.shows_picture() || mesh->uv_maps.empty()) continue;
    mesh->uv_maps = {};
    for (Facet& facet : mesh->facets) facet.uv_map = -1;
  }
}

void note_if_dark(Scene& scene) {
  if (!gives_light(scene)) scene.notes.emplace_back("No surface shines, so the scene is dark.");
}

void finish_scene(const Repairs& repairs, Remarks& remarks, Scene& scene) {
  drop_unused_uv(scene);
  remark_pictures_without_uv(scene, remarks);
  remarks.report_to(scene);
  note_repairs(repairs, scene);
  note_if_dark(scene);
  validate(scene);
}

}  // namespace lightwell
