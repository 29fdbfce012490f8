#pragma once

#include <optional>
#include <vector>

#include "scene/io/corner_maps.h"
#include "scene/io/polygon.h"

namespace lightwell {

/// A shape before its placement, as polygons.
struct MgfShape {
  std::vector<Loop> loops{};
  std::vector<NormalLoop> normals{};  ///< one for each loop, or empty
  bool is_inward = false;
};

/// A sphere of radius 1 about the origin that is seen from within.
MgfShape mgf_bubble();

/// A torus about z between the radii `inner` and `outer`, 0 <= inner < outer.
MgfShape mgf_torus(double inner, double outer, bool is_inward);

/// A polygon and its copy at the distance `length`, with fronts outside. A positive length goes in
/// behind the polygon, which stays a front. Empty for a prism without volume.
std::optional<MgfShape> mgf_prism(Loop base, double length);

}  // namespace lightwell
