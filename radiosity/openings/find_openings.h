#pragma once

#include <Eigen/Core>
#include <vector>

#include "radiosity/journal/run_control.h"
#include "scene/scene.h"

namespace lightwell {

/// A rectangle between an edge and the surface nearest to it, through which light may pass: a piece
/// of the slit beside a door, of the gap under it, or of a window.
struct Opening {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< metres
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();   ///< half-axis along the edge, metres
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();  ///< half-axis across the opening, metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, along x across

  double area() const { return 4.0 * along.norm() * across.norm(); }  ///< m^2
};

/// The openings beside the edges of a scene's polygons, however narrow they are.
///
/// From points P of an edge, balls that touch P grow in directions perpendicular to the edge, until
/// they touch a second point Q of a surface (the shrinking balls of Ma, Bae & Choi 2012, which find
/// the medial axis). Where P and Q lie opposite each other on the ball, the segment PQ crosses an
/// opening at its narrowest place, since the ball is empty. At a concave edge no ball fits.
///
/// Openings are at most a tenth of the scene's diagonal wide and at least 5e-6 of it. Only the
/// 4096 longest edges are looked at, and those longer than 0.2 % of the diagonal. Clear surfaces
/// leave light through and are looked through; surfaces that move are left out. The processes of
/// `run` share the edges; no journal keeps them. Throws Interrupted when progress says stop.
std::vector<Opening> find_openings(const Scene& scene, const RunControl& run = {});

}  // namespace lightwell
