#pragma once

#include <vector>

#include "scene/io/corner_maps.h"
#include "scene/io/polygon.h"

namespace lightwell {

/// Quadrilaterals of a torus about z, and its normals at their corners.
struct TorusLoops {
  std::vector<Loop> loops{};
  std::vector<NormalLoop> normals{};
};

/// A torus between the radii `inner` and `outer`, 0 <= inner < outer: 32 facets around and 16
/// across, with corners on the round shape.
TorusLoops torus_loops(double inner, double outer);

}  // namespace lightwell
