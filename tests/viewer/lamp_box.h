#pragma once

#include "tests/viewer/lit_sides.h"

namespace lightwell {

/// A closed room [0,2]^3 whose walls all have E = 1 W/m^2 of white.
inline SolvedScene even_room() {
  SolvedQuads quads;
  const Eigen::Array3f one = Eigen::Array3f::Ones();
  quads.add({{{2, 0, 0}, {2, 0, 2}, {2, 2, 2}, {2, 2, 0}}}, one);
  quads.add({{{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}}}, one);
  quads.add({{{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}}, one);
  quads.add({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}}, one);
  quads.add({{{0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}}}, one);
  quads.add({{{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}}}, one);
  return quads.solved();
}

/// A luminaire with an opening of 0.5 m x 0.5 m that shines down, -y, in a cone of 60 degrees, and
/// a body 0.2 m high above it.
inline Lamp pendant(const Eigen::Vector3d& position) {
  Lamp lamp{.name = "pendant",
            .position = position,
            .axes = lamp_axes(-Eigen::Vector3d::UnitY()),
            .intensity = constant_spectrum(rgb_bands(), 10.0f),
            .shape = SpotCone{.inner = 1.0, .outer = 1.0}};
  lamp.opening = {.along_c0 = 0.5, .along_c90 = 0.5};
  lamp.body = {.along_c0 = 0.6, .along_c90 = 0.6, .height = 0.2};
  return lamp;
}

}  // namespace lightwell
