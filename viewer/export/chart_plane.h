#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace lightwell {

/// The smallest rectangle around points of the plane has a side along one of their hull's edges
/// (Freeman & Shapira 1975): that direction, unit, the rectangle's longer side.
Eigen::Vector2d box_direction(std::span<const Eigen::Vector2d> points);

/// The border of faces laid flat: an edge that one face alone has, which lies on its left.
struct BorderEdge {
  int from = 0, to = 0;  ///< vertices
  int face = 0;
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();  ///< unit
};
std::vector<BorderEdge> border_edges(std::span<const std::array<int, 4>> faces,
                                     std::span<const Eigen::Vector2d> places);

/// A line to cut faces along.
struct CutLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};

/// Where two borders face each other nearer than `gap`: two sides of one line, or of a thin wall
/// that is at least four gaps long. Both lie on different sides of the lines. Empty if there are
/// none.
std::vector<CutLine> narrow_gaps(std::span<const std::array<int, 4>> faces,
                                 std::span<const Eigen::Vector2d> places, double gap);

}  // namespace lightwell
