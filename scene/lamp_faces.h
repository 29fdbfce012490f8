#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/lamp.h"

namespace lightwell {

/// A plane face of a luminaire as it is drawn.
struct LampFace {
  /// Convex; counter-clockwise seen from outside, m.
  std::vector<Eigen::Vector3d> outline{};
  /// Mean radiance of an opening over Lamp::intensity, 1/m^2: its flux over pi times its area. 0:
  /// the face is of the body.
  double shine = 0.0;
};

/// Corners of a lamp's opening in order around it, m: 4, or 48 of an ellipse.
std::vector<Eigen::Vector3d> opening_outline(const Lamp& lamp);

/// Ends of a lamp's body along its axis, m from the opening; negative where gamma = 0 points. The
/// body stands behind the opening. Where at least a twentieth of the light leaves to either side,
/// both ends are openings, and the body has its middle at the lamp's position.
struct BodyEnds {
  double low = 0.0, high = 0.0;
};
BodyEnds body_ends(const Lamp& lamp);

/// The faces of a lamp that is `visible`: its opening on each side that gets at least a twentieth
/// of the light, 2 mm in front of the ends of the body, and the body between `ends`.
std::vector<LampFace> lamp_faces(const Lamp& lamp, const BodyEnds& ends);

}  // namespace lightwell
