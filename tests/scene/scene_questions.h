#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <variant>

#include "scene/scene.h"

namespace lightwell::test {

inline const PolygonMesh& mesh_of(const Scene& scene, std::size_t surface = 0) {
  return std::get<PolygonMesh>(scene.surfaces.at(surface).shape);
}

inline double area_of(const PolygonMesh& mesh) {
  double area = 0.0;
  for (const Facet& facet : mesh.facets) area += facet_area(mesh, facet);
  return area;
}

/// Normal of the surface's first facet.
inline Eigen::Vector3d normal_of(const Scene& scene, std::size_t surface = 0) {
  return facet_normal(mesh_of(scene, surface), mesh_of(scene, surface).facets.at(0));
}

/// True if one of the scene's notes contains `text`.
inline bool has_note(const Scene& scene, const std::string& text) {
  return std::ranges::any_of(
      scene.notes, [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

/// True if one of the scene's losses contains `text`.
inline bool has_loss(const Scene& scene, const std::string& text) {
  return std::ranges::any_of(
      scene.losses, [&](const std::string& loss) { return loss.find(text) != std::string::npos; });
}

/// All notes of a scene, one a line.
inline std::string notes_of(const Scene& scene) {
  std::string all;
  for (const std::string& note : scene.notes) all += note + "\n";
  return all;
}

inline const Material& material_called(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials) {
    if (m.name == name) return m;
  }
  throw std::runtime_error("no material " + name);
}

}  // namespace lightwell::test
