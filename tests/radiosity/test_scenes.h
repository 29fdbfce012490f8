#pragma once

#include <array>
#include <string>

#include "scene/scene.h"

namespace lightwell::test {

inline Material diffuse(const Bands& bands, float rho, float exitance = 0.0f) {
  return {.name = "rho" + std::to_string(rho),
          .reflectance = constant_spectrum(bands, rho),
          .specular = constant_spectrum(bands, 0.0f),
          .emission = constant_spectrum(bands, exitance),
          .one_sided = true};
}

/// A sky of one radiance above the horizon and another below, W/(m^2 sr); z is up.
inline Sky even_sky(const Bands& bands, float above, float below) {
  return {.up = Eigen::Vector3d::UnitZ(),
          .north = Eigen::Vector3d::UnitY(),
          .bright = Eigen::Vector3d::UnitZ(),
          .scale = constant_spectrum(bands, above),
          .ground = constant_spectrum(bands, below)};
}

inline int add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

inline void add_polygon(Scene& scene, const std::string& name, int material,
                        const std::vector<Eigen::Vector3d>& points) {
  PolygonMesh mesh{.vertices = points, .facets = {Facet{}}};
  for (int i = 0; i < static_cast<int>(points.size()); ++i) mesh.facets[0].boundary.push_back(i);
  scene.surfaces.push_back({.name = name, .material = material, .shape = mesh});
}

/// Faces named x0 x1 y0 y1 z0 z1, one surface each, facing inwards (a room) or outwards (a block).
/// `materials` in that order.
inline void add_box(Scene& scene, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                    const std::array<int, 6>& materials, bool inwards) {
  const auto at = [&](int x, int y, int z) {
    return Eigen::Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  // Counter-clockwise seen from inside.
  const std::array<std::vector<Eigen::Vector3d>, 6> faces = {{
      {at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1)},
      {at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)},
      {at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0)},
      {at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1)},
      {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)},
      {at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1)},
  }};
  const std::array<const char*, 6> names = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (int f = 0; f < 6; ++f) {
    auto points = faces[f];
    if (!inwards) points = {points.rbegin(), points.rend()};
    add_polygon(scene, names[f], materials[f], points);
  }
}

/// Grey: what it does not throw back it absorbs.
inline Material mirror(const Bands& bands, float specular) {
  Material mirror = diffuse(bands, 0.0f);
  mirror.specular = constant_spectrum(bands, specular);
  return mirror;
}

inline Material tinted_mirror(const Bands& bands) {
  Material mirror = diffuse(bands, 0.0f);
  mirror.specular << 0.9f, 0.8f, 0.7f;
  return mirror;
}

/// Scatters some of its light and mirrors some.
inline Material polished(const Bands& bands) {
  Material material = diffuse(bands, 0.4f);
  material.specular = constant_spectrum(bands, 0.2f);
  return material;
}

inline Material clear_glass(const Bands& bands) {
  Material glass = diffuse(bands, 0.0f);
  glass.dielectric =
      Dielectric{.index_of_refraction = 1.5f, .tint = constant_spectrum(bands, 0.9f)};
  glass.one_sided = false;
  return glass;
}

/// A closed room where every face has reflectance rho and emits M; with a block inside if asked.
inline Scene furnace(float rho, float M, bool with_block) {
  Scene scene;
  const int m = add_material(scene, diffuse(scene.bands, rho, M));
  const std::array<int, 6> all = {m, m, m, m, m, m};
  add_box(scene, {0, 0, 0}, {1.0, 1.2, 0.9}, all, true);
  if (with_block) add_box(scene, {0.3, 0.4, 0.0}, {0.6, 0.7, 0.5}, all, false);
  return scene;
}

/// The unit cube from inside; its face x0 is a mirror, the others scatter half and shine.
/// `mirror`: what the mirror was added as.
inline Scene room_with_mirror(float specular, int* mirror = nullptr) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f, 1.0f));
  Material material = diffuse(scene.bands, 0.0f);
  material.specular = constant_spectrum(scene.bands, specular);
  const int m = add_material(scene, material);
  if (mirror) *mirror = m;
  add_box(scene, {0, 0, 0}, {1, 1, 1}, {m, wall, wall, wall, wall, wall}, true);
  return scene;
}

}  // namespace lightwell::test
