#include "scene/sky_patches.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/degree.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Patches in Tregenza's rows, from the horizon to the last below the zenith.
constexpr std::array<int, 7> patches_of_rows = {30, 30, 24, 24, 18, 12, 6};
constexpr int most_subdivision = 8;  // 9217 patches

// Directions all over a cell, each way, for the irradiance of an unobstructed point.
constexpr int fine_steps = 6;

double wrapped_turn(double turns) {
  return turns - std::floor(turns);
}

}  // namespace

SkyPatches::SkyPatches(int subdivision, const Eigen::Vector3d& up, const Eigen::Vector3d& north)
    : row_height_(90.0 / (static_cast<double>(patches_of_rows.size()) * subdivision + 0.5) *
                  degree),
      up_(up),
      north_(north),
      east_(north.cross(up)) {
  if (subdivision < 1 || subdivision > most_subdivision) {
    throw std::invalid_argument(
        fmt::format("the sky's patches are divided by {}; give 1 (145 patches) to {} ({} patches)",
                    subdivision, most_subdivision, 144 * most_subdivision * most_subdivision + 1));
  }
  const int rows = static_cast<int>(patches_of_rows.size()) * subdivision;
  for (int row = 0; row < rows; ++row) {
    const int count = subdivision * patches_of_rows[static_cast<std::size_t>(row / subdivision)];
    add_row(row, count, std::sin(row * row_height_), std::sin((row + 1) * row_height_));
  }
  add_row(rows, 1, std::sin(rows * row_height_), 1.0);
  first_of_row_.push_back(static_cast<int>(cells_.size()));
  const std::size_t dome = cells_.size();
  for (std::size_t i = 0; i < dome; ++i) {
    Cell below = cells_[i];
    below.row = -1 - below.row;
    below.low = -cells_[i].high;
    below.high = -cells_[i].low;
    cells_.push_back(below);
  }
  find_neighbours();
  find_sums();
  fine_.resize(static_cast<Eigen::Index>(cells_.size()) * fine_steps * fine_steps, 3);
  Eigen::Index at = 0;
  for (const Cell& cell : cells_) {
    for (int i = 0; i < fine_steps; ++i) {
      for (int j = 0; j < fine_steps; ++j) {
        fine_.row(at++) = direction(cell, (i + 0.5) / fine_steps, (j + 0.5) / fine_steps);
      }
    }
  }
}

void SkyPatches::add_row(int row, int count, double low, double high) {
  first_of_row_.push_back(static_cast<int>(cells_.size()));
  for (int i = 0; i < count; ++i) {
    cells_.push_back({.row = row,
                      .low = low,
                      .high = high,
                      .begin = wrapped_turn((i - 0.5) / count),
                      .width = 1.0 / count});
  }
}

void SkyPatches::find_neighbours() {
  constexpr double slack = 1e-9;
  neighbours_.resize(cells_.size());
  // Rows are numbered 0, 1 ... upwards and -1, -2 ... downwards from the horizon.
  const auto touches = [&](const Cell& a, const Cell& b) {
    if (std::abs(a.row - b.row) > 1) return false;
    const double a_behind_b = wrapped_turn(a.begin - b.begin),
                 b_behind_a = wrapped_turn(b.begin - a.begin);
    return a_behind_b < b.width + slack || b_behind_a < a.width + slack;
  };
  for (std::size_t a = 0; a < cells_.size(); ++a) {
    for (std::size_t b = 0; b < cells_.size(); ++b) {
      if (a != b && touches(cells_[a], cells_[b])) neighbours_[a].push_back(static_cast<int>(b));
    }
  }
}

// The integrals of directions over each cell in closed form, and how far cells reach.
void SkyPatches::find_sums() {
  const auto count = static_cast<Eigen::Index>(cells_.size());
  sums_.resize(count, 3);
  middles_.resize(count, 3);
  reaches_.resize(count);
  // int sqrt(1 - s^2) ds, of the sine s of altitude.
  const auto level = [](double s) {
    return 0.5 * (s * std::sqrt(std::max(0.0, 1.0 - s * s)) + std::asin(s));
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    const double first = 2.0 * pi * cell.begin, last = first + 2.0 * pi * cell.width;
    sums_.row(i) =
        (level(cell.high) - level(cell.low)) * ((std::sin(last) - std::sin(first)) * north_ +
                                                (std::cos(first) - std::cos(last)) * east_) +
        0.5 * (cell.high * cell.high - cell.low * cell.low) * (last - first) * up_;
    // The cap about the zenith, and that below, lie about the vertical.
    const bool is_cap = cell.width == 1.0;
    middles_.row(i) = is_cap ? Eigen::Vector3d(std::copysign(1.0, cell.low + cell.high) * up_)
                             : direction(cell, 0.5, 0.5);
    double least = 1.0;  // cosine to the farthest corner
    for (const double v : {0.0, 1.0}) {
      for (const double u : {0.0, 1.0}) {
        if (is_cap && std::abs(v == 0.0 ? cell.low : cell.high) == 1.0) continue;
        least = std::min(least, middles_.row(i).dot(direction(cell, u, v).transpose()));
      }
    }
    // No point of a cell is farther from its middle than its corners; the rest is for rounding.
    constexpr double rounding = 1e-9;
    reaches_[i] = std::sqrt(std::max(0.0, 1.0 - least * least)) + rounding;
  }
}

int SkyPatches::cell_of(const Eigen::Vector3d& direction) const {
  const double sine = direction.dot(up_);
  const double altitude = std::asin(std::clamp(std::abs(sine), 0.0, 1.0));
  const int rows = static_cast<int>(first_of_row_.size()) - 2;  // less the cap
  const int row = std::min(static_cast<int>(altitude / row_height_), rows);
  const auto first = first_of_row_[static_cast<std::size_t>(row)];
  const int count = first_of_row_[static_cast<std::size_t>(row) + 1] - first;
  const double turns =
      wrapped_turn(std::atan2(direction.dot(east_), direction.dot(north_)) / (2.0 * pi));
  const int column = static_cast<int>(std::floor(turns * count + 0.5)) % count;
  return first + column + (sine < 0.0 ? dome_count() : 0);
}

Eigen::Vector3d SkyPatches::direction(const Cell& cell, double u, double v) const {
  const double sine = cell.low + v * (cell.high - cell.low);
  const double azimuth = 2.0 * pi * (cell.begin + u * cell.width);
  return std::sqrt(std::max(0.0, 1.0 - sine * sine)) *
             (std::cos(azimuth) * north_ + std::sin(azimuth) * east_) +
         sine * up_;
}

Eigen::Vector3d SkyPatches::direction(int cell, double u, double v) const {
  return direction(cells_[static_cast<std::size_t>(cell)], u, v);
}

double SkyPatches::solid_angle(int cell) const {
  const Cell& at = cells_[static_cast<std::size_t>(cell)];
  return 2.0 * pi * at.width * (at.high - at.low);
}

Eigen::ArrayXd SkyPatches::irradiances(const Eigen::Vector3d& normal) const {
  constexpr int each = fine_steps * fine_steps;
  const Eigen::ArrayXd whole = (sums_ * normal).array();
  const Eigen::ArrayXd height = (middles_ * normal).array();
  Eigen::ArrayXd E(cell_count());
  for (int cell = 0; cell < cell_count(); ++cell) {
    if (std::abs(height[cell]) > reaches_[cell]) {
      E[cell] = std::max(0.0, whole[cell]);
      continue;
    }
    const auto fine = fine_.middleRows(Eigen::Index{cell} * each, each);
    E[cell] = solid_angle(cell) * (fine * normal).array().max(0.0).mean();
  }
  return E;
}

}  // namespace lightwell
