#include "radiosity/form_factors/hemicube_cells.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace lightwell {
namespace {

using std::numbers::pi;

// Form factor of the rectangle [0,x] x [0,y] of the top, odd in x and in y.
double top_corner(double x, double y) {
  const double rx = std::sqrt(1.0 + x * x), ry = std::sqrt(1.0 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * pi);
}

// Form factor of the rectangle [0,y] x [0,z] of a side, y along the horizon; odd in y.
double side_corner(double y, double z) {
  const double rz = std::sqrt(1.0 + z * z);
  return (std::atan(y) - std::atan(y / rz) / rz) / (2.0 * pi);
}

// Running sums along each row of the rectangles between the lines of a grid.
template <class Corner>
std::vector<double> running_sums(int rows, int columns, double first_row_line, Corner corner) {
  const double step = 2.0 / columns;
  std::vector<double> sums;
  sums.reserve(static_cast<std::size_t>(rows) * (columns + 1));
  for (int row = 0; row < rows; ++row) {
    const double low = first_row_line + step * row, high = first_row_line + step * (row + 1);
    const double at_left = corner(-1.0, high) - corner(-1.0, low);
    for (int column = 0; column <= columns; ++column) {
      const double x = -1.0 + step * column;
      sums.push_back(corner(x, high) - corner(x, low) - at_left);
    }
  }
  return sums;
}

double sum_of_cells(const std::vector<double>& sums, int rows, int columns) {
  double sum = 0.0;
  for (int row = 0; row < rows; ++row) {
    sum += sums[static_cast<std::size_t>(row) * (columns + 1) + columns];
  }
  return sum;
}

}  // namespace

HemicubeCells::HemicubeCells(int resolution) : n_(resolution) {
  if (n_ < 2 || n_ > max_resolution || n_ % 2 != 0) {
    throw std::invalid_argument("hemicube resolution " + std::to_string(n_) +
                                ": give an even number of cells from 2 to " +
                                std::to_string(max_resolution));
  }
  top_sums_ = running_sums(n_, n_, -1.0, top_corner);
  side_sums_ = running_sums(n_ / 2, n_, 0.0, side_corner);
  const double all = sum_of_cells(top_sums_, n_, n_) + 4.0 * sum_of_cells(side_sums_, n_ / 2, n_);
  for (double& sum : top_sums_) sum /= all;
  for (double& sum : side_sums_) sum /= all;
}

const HemicubeCells::Face& HemicubeCells::face(int f) {
  static constexpr std::array<Face, face_count> faces = {
      {{0, 1, 2, 1.0}, {1, 2, 0, 1.0}, {1, 2, 0, -1.0}, {0, 2, 1, 1.0}, {0, 2, 1, -1.0}}};
  return faces[f];
}

Eigen::Vector3d HemicubeCells::direction(int f, int row, int column) const {
  Eigen::Vector3d d;
  d[face(f).column_axis] = column_offset() + step() * column;
  d[face(f).row_axis] = row_offset(f) + step() * row;
  d[face(f).outward_axis] = face(f).outward_sign;
  return d;
}

}  // namespace lightwell
