#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace lightwell {

/// Direction, unit, of the longer side of the smallest rectangle around points of the plane. The
/// rectangle has a side along an edge of the points' convex hull (Freeman & Shapira 1975).
Eigen::Vector2d box_direction(std::span<const Eigen::Vector2d> points);

/// Edge that belongs to one face only; the face lies on the left of the edge.
struct BorderEdge {
  int from = 0, to = 0;                                ///< vertices
  int face = 0;                                        ///< index into the faces
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();  ///< unit
};
/// Border edges, longer than 0, of faces laid flat. `faces`: vertices of each, [3] is -1 for a
/// triangle; `places`: position of each vertex.
std::vector<BorderEdge> border_edges(std::span<const std::array<int, 4>> faces,
                                     std::span<const Eigen::Vector2d> places);

/// Line along which faces are parted, by the side on which their centres lie.
struct CutLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit
};

/// Lines between border edges that face each other at a distance below `gap`: the two sides of a
/// seam, or of a thin wall along an edge longer than four gaps. The faces of the two edges lie on
/// different sides of their line. Lengths are in the unit of `places`.
std::vector<CutLine> narrow_gaps(std::span<const std::array<int, 4>> faces,
                                 std::span<const Eigen::Vector2d> places, double gap);

}  // namespace lightwell
