#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "scene/bands.h"
#include "scene/sky.h"

namespace lightwell {

/// The whole sphere of directions about a scene, cut into cells of equal solid angle (5.6 degrees
/// wide), with the radiance of a Sky without its sun. Within each cell a grid of 0.7 degrees holds
/// the radiance; maps are averaged over the grid's squares.
class SkyCells {
 public:
  static constexpr int around = 64, rings = 32;
  static constexpr int count = around * rings;

  explicit SkyCells(const Sky& sky, int bands);

  /// A direction, and its density within the cell, 1/sr, in proportion to radiance.
  struct Sample {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double density = 0.0;
  };
  /// The direction for random numbers (u, v) in [0,1)^2.
  Sample sample(int cell, double u, double v) const;
  /// The cell that holds a unit direction.
  int cell_of(const Eigen::Vector3d& direction) const;
  /// Density of sample()'s directions at a unit direction of the cell, 1/sr.
  double density(int cell, const Eigen::Vector3d& direction) const;
  /// The unit direction of the point (u, v) of a cell, in [0,1]^2.
  Eigen::Vector3d direction(int cell, double u, double v) const;

  /// int L dw over the cell, W/m^2, mean of the bands.
  double power(int cell) const { return power_[static_cast<std::size_t>(cell)]; }
  /// Radiance of each band over the mean of the bands.
  Eigen::ArrayXd colour(int cell) const { return colour_.row(cell).transpose().cast<double>(); }
  double colour(int cell, int band) const { return static_cast<double>(colour_(cell, band)); }
  /// int L cos dw over the part of each cell above the horizon of a unit normal, W/m^2, mean of the
  /// bands.
  Eigen::ArrayXf irradiances(const Eigen::Vector3f& normal) const;
  /// Irradiance of an unobstructed point, W/m^2 per band: to 1e-4, and to 1e-6 for a uniform sky or
  /// a horizontal surface.
  Spectrum unobstructed(const Eigen::Vector3d& normal) const;

  /// All cells in the order of a Hilbert curve: equal steps along the curve are spread evenly over
  /// the sphere, as equal steps along rings are not.
  const std::array<int, count>& order() const { return order_; }

 private:
  static constexpr int fine = 8;  // squares of the grid within a cell, each way
  // Coordinates of a unit direction on the grid of cells: column and row, with the place within.
  Eigen::Vector2d place_of(const Eigen::Vector3d& direction) const;
  void tabulate(const Sky& sky, int c);
  float cut_irradiance(int c, const Eigen::Vector3f& normal, float whole) const;

  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // columns: north, east, up
  std::array<double, count> power_{};
  Eigen::MatrixX3f middle_{};  // unit, of each cell
  Eigen::MatrixX3f vector_{};  // int L w dw over each cell, W/m^2, mean of the bands
  std::array<int, count> order_{};
  std::vector<float> radiance_{};    // of the fine grid, cell after cell, mean of the bands
  std::vector<float> row_cdf_{};     // of the rows of each cell's fine grid
  std::vector<float> column_cdf_{};  // within each of these rows
  BandArray colour_{};               // cells x bands
};

}  // namespace lightwell
