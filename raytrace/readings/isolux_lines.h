#pragma once

#include <Eigen/Core>
#include <vector>

#include "raytrace/readings/lux_grid.h"

namespace lightwell {

/// A line along which illuminance has one value.
struct Isoline {
  double lux = 0.0;
  std::vector<Eigen::Vector2d> points{};  ///< m, along u and v from the grid's corner
  bool is_closed = false;                 ///< the last point is joined to the first
};

/// Lines of equal illuminance between the points of a grid, by marching squares: illuminance is
/// linear along the edges between neighbouring points. Squares with a point missing have no lines.
/// In an ambiguous square (two opposite corners above the value, two below) the mean of the corners
/// decides.
std::vector<Isoline> isolux_lines(const LuxGrid& grid, const Eigen::ArrayXd& lux, double value);

/// Values for the lines of a plan between `least` and `greatest`, at most `most` of them: from the
/// scale of EN 12464-1 (20, 30, 50, 75, 100, 150, 200, 300, 500, 750, 1000, ... lx), or round even
/// steps where fewer than three of the scale lie between the two. Empty if the two differ by less
/// than 1 %.
std::vector<double> isolux_values(double least, double greatest, int most = 8);

}  // namespace lightwell
