#pragma once

#include "tests/pictures.h"
#include "tests/viewer/lit_sides.h"

namespace lightwell {

/// Reflectances of the left and right half of the wall of PicturedBox, as seen by the camera of
/// solved_box().
inline constexpr float bright_half = 0.9f, dark_half = 0.2f;

/// solved_box() and its scene; the back wall has a texture that is dark on one half, and radiosity
/// by the mean reflectance. The scene lacks polygons for the other walls.
struct PicturedBox {
  PicturedBox() {
    Scene& s = scene;
    PolygonMesh wall{.vertices = {{2, 0, 2}, {0, 0, 2}, {0, 2, 2}, {2, 2, 2}},
                     .facets = {{.boundary = {0, 1, 2, 3}}}};
    s.surfaces[2].shape = std::move(wall);
    put_picture(s, 2, picture_of(2, 1, {bright_half, dark_half}));
    solved.mesh.facet = {1, 2, 0, 3, 4};
    solved.mesh.material[2] = s.surfaces[2].material;
    solved.mesh.reflectance.row(2).setConstant(0.5f * (bright_half + dark_half));
  }
  SolvedScene solved = solved_box();
  Scene scene = box_scene();
};

}  // namespace lightwell
