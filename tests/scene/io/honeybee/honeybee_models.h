#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::honeybee_models {

using nlohmann::json;

/// A Face3D with a corner and two edges.
inline json rectangle(const std::array<double, 3>& corner, const std::array<double, 3>& u,
                      const std::array<double, 3>& v) {
  json boundary = json::array();
  for (const auto& [a, b] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
    json point = json::array();
    for (std::size_t k = 0; k < 3; ++k) point.push_back(corner[k] + a * u[k] + b * v[k]);
    boundary.push_back(point);
  }
  return {{"type", "Face3D"}, {"boundary", boundary}};
}

/// An object that faces the outside.
inline json object(const std::string& name, const json& geometry,
                   const json& radiance = json::object()) {
  return {{"identifier", name},
          {"geometry", geometry},
          {"properties", {{"radiance", radiance}}},
          {"boundary_condition", {{"type", "Outdoors"}}}};
}

/// A face of a room, of a face_type.
inline json face(const std::string& name, const std::string& type, const json& geometry,
                 const json& radiance = json::object()) {
  json result = object(name, geometry, radiance);
  result["face_type"] = type;
  return result;
}

/// A room of 4 x 3 x 2.5 m. Its southern wall has a window of 2 x 1 m, and a door of 0.8 x 2 m that
/// stands on the floor.
inline json room() {
  json south = face("south", "Wall", rectangle({0, 0, 0}, {4, 0, 0}, {0, 0, 2.5}));
  south["apertures"] =
      json::array({object("window", rectangle({0.5, 0, 1}, {2, 0, 0}, {0, 0, 1}))});
  south["doors"] = json::array({object("door", rectangle({3, 0, 0}, {0.8, 0, 0}, {0, 0, 2}))});
  return {{"identifier", "room"},
          {"properties", {{"radiance", json::object()}}},
          {"faces",
           {south, face("north", "Wall", rectangle({4, 3, 0}, {-4, 0, 0}, {0, 0, 2.5})),
            face("west", "Wall", rectangle({0, 3, 0}, {0, -3, 0}, {0, 0, 2.5})),
            face("east", "Wall", rectangle({4, 0, 0}, {0, 3, 0}, {0, 0, 2.5})),
            face("floor", "Floor", rectangle({0, 3, 0}, {4, 0, 0}, {0, -3, 0})),
            face("ceiling", "RoofCeiling", rectangle({0, 0, 2.5}, {4, 0, 0}, {0, 3, 0}))}}};
}

/// A model of rooms, without modifiers.
inline json model(const json& rooms = json::array({room()})) {
  return {{"type", "Model"},
          {"identifier", "model"},
          {"rooms", rooms},
          {"properties", {{"radiance", {{"modifiers", json::array()}}}}}};
}

/// The scene that a model is read as.
inline Scene read(const json& of) {
  const TemporaryFolder folder;
  return read_scene(folder.write("model.hbjson", of.dump()));
}

/// The material of a surface.
inline const Material& material_of(const Scene& scene, const std::string& surface) {
  for (const Surface& s : scene.surfaces) {
    if (s.name == surface) return scene.materials[static_cast<std::size_t>(s.material)];
  }
  throw std::runtime_error("no surface " + surface);
}

}  // namespace lightwell::honeybee_models
