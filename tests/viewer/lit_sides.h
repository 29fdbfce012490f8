#pragma once

#include "tests/viewer/solved_box.h"

namespace lightwell {

/// A unit square in the plane z = 0 with a front and a back side in the same place.
inline SolvedScene square_of_two_sides(const Eigen::Array3f& front, const Eigen::Array3f& back) {
  SolvedQuads quads;
  const int f = quads.add({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, front);
  const int b = quads.add({{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}}, back);
  SolvedScene solved = quads.solved();
  solved.mesh.twin[f] = b;
  solved.mesh.twin[b] = f;
  solved.mesh.is_back[b] = 1;
  solved.mesh.surface[b] = solved.mesh.surface[f];
  solved.mesh.material[b] = solved.mesh.material[f];
  return solved;
}

inline const Eigen::Array3f dark{0.0f, 0.0f, 0.0f};

/// The scene of solved_box(): names, materials and the camera.
inline Scene box_scene() {
  Scene scene;
  scene.title = "box";
  for (const char* name : {"left", "right", "wall", "floor", "ceiling"}) {
    const int number = static_cast<int>(scene.surfaces.size());
    scene.surfaces.push_back({.name = name, .material = number, .shape = PolygonMesh{}});
    scene.materials.push_back({.name = std::string(name) + " paint",
                               .reflectance = Spectrum::Ones(3),
                               .specular = Spectrum::Zero(3),
                               .emission = Spectrum::Zero(3)});
  }
  scene.cameras = {box_camera()};
  return scene;
}

}  // namespace lightwell
