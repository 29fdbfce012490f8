#include "radiosity/sky/sky_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "scene/parallel.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Number of a square along the Hilbert curve (Hilbert 1891) over a grid of 2^k squares each way.
int on_hilbert_curve(int size, int x, int y) {
  int distance = 0;
  for (int s = size / 2; s > 0; s /= 2) {
    const int right = (x & s) != 0, up = (y & s) != 0;
    distance += s * s * ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = size - 1 - x;
        y = size - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return distance;
}

// The point (u, v) of a cell in axes of north, east and up. The rings have equal height, so that
// all cells have the same solid angle and the horizon lies between two rings.
Eigen::Vector3d dome_direction(int cell, double u, double v) {
  constexpr int around = SkyCells::around;
  static const std::array<Eigen::Vector2d, around> middles = [] {
    std::array<Eigen::Vector2d, around> columns;
    for (int i = 0; i < around; ++i) {
      const double phi = 2.0 * pi * (i + 0.5) / around;
      columns[static_cast<std::size_t>(i)] = {std::cos(phi), std::sin(phi)};
    }
    return columns;
  }();
  // The azimuth is turned from the middle of the column, by 2.8 degrees at most: the Taylor series
  // are exact to 1e-13.
  const Eigen::Vector2d& middle = middles[static_cast<std::size_t>(cell % around)];
  const double turn = 2.0 * pi * (u - 0.5) / around, t2 = turn * turn;
  const double cosine = 1.0 + t2 * (-1.0 / 2 + t2 * (1.0 / 24 - t2 / 720));
  const double sine = turn * (1.0 + t2 * (-1.0 / 6 + t2 * (1.0 / 120 - t2 / 5040)));
  const double z = -1.0 + 2.0 * (cell / around + v) / SkyCells::rings;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * (cosine * middle.x() - sine * middle.y()),
          r * (sine * middle.x() + cosine * middle.y()), z};
}

// Directions of a grid of n x n squares in one cell, a row for each: the middles of the squares, or
// the corners of the cell for n = 2.
template <int n>
using CellDirections = Eigen::Matrix<float, n * n, 3>;

// The directions of all cells.
template <int n>
std::vector<CellDirections<n>> dome_grid() {
  std::vector<CellDirections<n>> grid(SkyCells::count);
  const auto at = [](int i) { return n == 2 ? static_cast<double>(i) : (i + 0.5) / n; };
  for (int c = 0; c < static_cast<int>(SkyCells::count); ++c) {
    for (int i = 0; i < n * n; ++i) {
      grid[static_cast<std::size_t>(c)].row(i) =
          dome_direction(c, at(i % n), at(i / n)).template cast<float>().transpose();
    }
  }
  return grid;
}

}  // namespace

SkyCells::SkyCells(const Sky& sky, int bands) {
  axes_ << sky.north, sky.north.cross(sky.up), sky.up;
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [](int a, int b) {
    return on_hilbert_curve(around, a % around, a / around) <
           on_hilbert_curve(around, b % around, b / around);
  });
  radiance_.resize(static_cast<std::size_t>(count) * fine * fine);
  row_cdf_.resize(static_cast<std::size_t>(count) * fine);
  column_cdf_.resize(radiance_.size());
  colour_ = BandArray::Ones(count, bands);
  middle_.resize(count, 3);
  vector_.resize(count, 3);
  parallel_for(count, 16, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) tabulate(sky, c);
  });
}

Eigen::Vector3d SkyCells::direction(int cell, double u, double v) const {
  return axes_ * dome_direction(cell, u, v);
}

void SkyCells::tabulate(const Sky& sky, int c) {
  constexpr int in_cell = fine * fine;
  constexpr double fine_angle = 4.0 * pi / (static_cast<double>(count) * in_cell);
  const int across = sky.kind == SkyKind::map ? 4 : 1;  // samples of a square, each way
  const Eigen::Index bands = colour_.cols();
  double& power = power_[static_cast<std::size_t>(c)];
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(bands);
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  const std::size_t first = static_cast<std::size_t>(c) * in_cell;
  for (int i = 0; i < in_cell; ++i) {
    const int row = i / fine, column = i % fine;
    Eigen::ArrayXd L = Eigen::ArrayXd::Zero(bands);
    for (int k = 0; k < across * across; ++k) {
      const double u = (column + (k % across + 0.5) / across) / fine;
      const double v = (row + (k / across + 0.5) / across) / fine;
      L += sky_radiance(sky, direction(c, u, v)).cast<double>() / (across * across);
    }
    radiance_[first + static_cast<std::size_t>(i)] = static_cast<float>(L.mean());
    vector += L.mean() * fine_angle * direction(c, (column + 0.5) / fine, (row + 0.5) / fine);
    sum += L * fine_angle;
  }
  middle_.row(c) = direction(c, 0.5, 0.5).cast<float>().transpose();
  vector_.row(c) = vector.cast<float>().transpose();
  power = sum.mean();
  if (power > 0.0) colour_.row(c) = (sum / sum.mean()).cast<float>().transpose();
  double rows = 0.0;
  for (int row = 0; row < fine; ++row) {
    double columns = 0.0;
    for (int column = 0; column < fine; ++column) {
      const std::size_t at = first + static_cast<std::size_t>(row * fine + column);
      columns += static_cast<double>(radiance_[at]);
      column_cdf_[at] = static_cast<float>(columns);
    }
    rows += columns;
    row_cdf_[static_cast<std::size_t>(c * fine + row)] = static_cast<float>(rows);
  }
}

SkyCells::Sample SkyCells::sample(int cell, double u, double v) const {
  // The entry of a running sum that x in [0,1) falls into; x becomes the place within the entry.
  // Returns the entry and its step.
  const auto pick = [](const float* cdf, double& x) {
    const double wanted = x * static_cast<double>(cdf[fine - 1]);
    const auto limit = static_cast<float>(wanted);
    int at = 0;  // without branches, which would be guessed wrong
    for (int i = 0; i + 1 < fine; ++i) at += cdf[i] <= limit ? 1 : 0;
    const double low = at == 0 ? 0.0 : static_cast<double>(cdf[at - 1]);
    const double step = static_cast<double>(cdf[at]) - low;
    x = step > 0.0 ? std::clamp((wanted - low) / step, 0.0, 1.0) : 0.5;
    return std::pair(at, step);
  };
  const auto c = static_cast<std::size_t>(cell);
  const int row = pick(row_cdf_.data() + c * fine, v).first;
  const std::size_t first_of_row = (c * fine + static_cast<std::size_t>(row)) * fine;
  const auto [column, L] = pick(column_cdf_.data() + first_of_row, u);
  return {.direction = direction(cell, (column + u) / fine, (row + v) / fine),
          .density = L / power_[c]};
}

Eigen::Vector2d SkyCells::place_of(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d d = axes_.transpose() * direction;
  const double turn = std::atan2(d.y(), d.x()) / (2.0 * pi);
  return {around * (turn < 0.0 ? turn + 1.0 : turn), 0.5 * rings * (d.z() + 1.0)};
}

int SkyCells::cell_of(const Eigen::Vector3d& direction) const {
  const Eigen::Vector2d place = place_of(direction);
  return std::clamp(static_cast<int>(place.y()), 0, rings - 1) * around +
         std::clamp(static_cast<int>(place.x()), 0, around - 1);
}

double SkyCells::density(int cell, const Eigen::Vector3d& direction) const {
  const Eigen::Vector2d place = place_of(direction);
  const auto step = [](double along, int first) {
    return std::clamp(static_cast<int>((along - first) * fine), 0, fine - 1);
  };
  const int column = step(place.x(), cell % around), row = step(place.y(), cell / around);
  const auto c = static_cast<std::size_t>(cell);
  const std::size_t at = c * fine * fine + static_cast<std::size_t>(row * fine + column);
  return power_[c] > 0.0 ? static_cast<double>(radiance_[at]) / power_[c] : 0.0;
}

// int L cos dw over the part of a cell that the horizon may cut.
float SkyCells::cut_irradiance(int c, const Eigen::Vector3f& normal, float whole) const {
  // Made once, for all points.
  static const std::vector<CellDirections<2>> corners = dome_grid<2>();
  static const std::vector<CellDirections<fine>> middles = dome_grid<fine>();
  const auto cell = static_cast<std::size_t>(c);
  const Eigen::Vector3f n = axes_.transpose().cast<float>() * normal;
  constexpr float rounding = 1e-6f;
  if (!((corners[cell] * n).minCoeff() < -rounding)) return whole;
  constexpr double fine_angle = 4.0 * pi / (static_cast<double>(count) * fine * fine);
  const Eigen::Map<const Eigen::Array<float, fine * fine, 1>> L(radiance_.data() +
                                                                cell * fine * fine);
  const float sum = ((middles[cell] * n).array().max(0.0f) * L).sum();
  return static_cast<float>(static_cast<double>(sum) * fine_angle);
}

Eigen::ArrayXf SkyCells::irradiances(const Eigen::Vector3f& normal) const {
  const Eigen::ArrayXf height = (middle_ * normal).array();
  Eigen::ArrayXf E = (vector_ * normal).array();
  // Sines of the largest angle between a cell's middle and its corners; the rings at the poles
  // reach 20 degrees down.
  constexpr float sine_of_reach = 0.087f, sine_at_pole = 0.36f;
  for (int c = 0; c < count; ++c) {
    const bool is_at_pole = c < around || c >= count - around;
    const float reach = is_at_pole ? sine_at_pole : 1.5f * sine_of_reach;
    if (height[c] > reach) continue;
    const bool is_dark = !(power_[static_cast<std::size_t>(c)] > 0.0);
    E[c] = height[c] < -reach || is_dark ? 0.0f : cut_irradiance(c, normal, E[c]);
  }
  return E;
}

Spectrum SkyCells::unobstructed(const Eigen::Vector3d& normal) const {
  const Eigen::ArrayXf of_cells = irradiances(normal.cast<float>());
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(colour_.cols());
  for (int c = 0; c < count; ++c) {
    if (of_cells[c] > 0.0f) E += static_cast<double>(of_cells[c]) * colour(c);
  }
  return E.cast<float>();
}

}  // namespace lightwell
