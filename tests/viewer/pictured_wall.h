#pragma once

#include "tests/pictures.h"
#include "tests/viewer/lit_sides.h"

namespace lightwell {

/// Of the wall below: rho of its left and right half as the camera of solved_box() sees them.
inline constexpr float bright_half = 0.9f, dark_half = 0.2f;

/// solved_box() whose wall at the end shows a picture that is dark on one half, so that its light
/// is that of their mean; and its scene. The other walls have no polygon.
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
