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
  /// Distance of an opening behind the lamp's position along the axis, m. The outline lies a
  /// little before it, so that a depth buffer tells it from the body and from a ceiling.
  double place = 0.0;
};

/// Corners of a lamp's opening in order around it, m: 4, or 48 of an ellipse, `place` behind the
/// lamp's position (see LampFace).
std::vector<Eigen::Vector3d> opening_outline(const Lamp& lamp, double place = 0.0);

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

/// Area of a luminaire's opening and of its luminous sides of this height, m^2, projected along the
/// unit vector `way` in the luminaire's own frame. The sides are those of a box, or of a cylinder
/// over an ellipse if the opening is round.
double luminous_area(const LampOpening& opening, double height, const Eigen::Vector3d& way);

/// Least area of an opening seen edge on, as a share of its area: a flat opening has none, but a
/// real one has a rim.
inline constexpr double rim_of_opening = 0.05;

/// Share of the way to a lamp's opening that must be free for the opening to be seen: a ceiling in
/// the plane of the opening, or the holder around a lamp, does not hide the lamp.
inline constexpr double way_before_opening = 0.999;

}  // namespace lightwell
