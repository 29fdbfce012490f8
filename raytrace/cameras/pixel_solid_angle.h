#pragma once

#include "scene/camera.h"

namespace lightwell {

/// Solid angle that pixel (x, y) of a camera's picture shows, sr: the part of the pixel within the
/// circle of a fisheye; 0 where nothing is shown, and for orthographic pictures, whose rays are
/// parallel. The solid angles of a picture add up to what the picture shows.
///
/// - Perspectives and faces of cubes: the quadrilateral of the corners' directions (Van Oosterom &
///   Strackee 1983). The edges of distorted pixels count as straight.
/// - Fisheyes: by Stokes, the integral of (1 - cos theta) d phi around the pixel.
/// - Panoramas: longitude times the difference of the sines of elevation.
double pixel_solid_angle(const Camera& camera, int x, int y);

}  // namespace lightwell
