#pragma once

#include <fmt/format.h>

#include <utility>

#include "scene/scene.h"

namespace lightwell {

/// A scene without surfaces; material 0 is one-sided and reflects half.
inline Scene grey_scene() {
  Scene scene;
  Material grey;
  grey.name = "grey";
  grey.reflectance = constant_spectrum(scene.bands, 0.5f);
  grey.specular = grey.emission = constant_spectrum(scene.bands, 0.0f);
  grey.one_sided = true;
  scene.materials = {grey};
  return scene;
}

inline void add_rectangle(Scene& scene, int material, const Eigen::Vector3d& corner,
                          const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  scene.surfaces.push_back(
      {.name = fmt::format("face {}", scene.surfaces.size()),
       .material = material,
       .shape = PolygonMesh{.vertices = {corner, corner + u, corner + u + v, corner + v},
                            .facets = {{.boundary = {0, 1, 2, 3}}}}});
}

/// Adds a box of material 0 with its lowest corner at `low`; `inwards`: a room, whose faces are
/// seen from inside.
inline void add_box(Scene& scene, const Eigen::Vector3d& low, const Eigen::Vector3d& size,
                    bool inwards) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      Eigen::Vector3d corner = low, u = Eigen::Vector3d::Zero(), v = u;
      corner[axis] += side * size[axis];
      u[(axis + 1) % 3] = size[(axis + 1) % 3];
      v[(axis + 2) % 3] = size[(axis + 2) % 3];
      if ((side == 0) != inwards) std::swap(u, v);
      add_rectangle(scene, 0, corner, u, v);
    }
  }
}

}  // namespace lightwell
