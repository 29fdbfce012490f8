#include "mesh/geometry/welded_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/sampling.h"

namespace lightwell {
namespace {

using WeldCell = std::array<std::int64_t, 3>;

std::uint64_t cell_key(const WeldCell& c) {
  return random_key(static_cast<std::uint64_t>(c[0]), static_cast<std::uint64_t>(c[1]),
                    static_cast<std::uint64_t>(c[2]));
}

WeldCell weld_cell(const Eigen::Vector3d& p, double cell_size) {
  WeldCell cell;
  for (int c = 0; c < 3; ++c) cell[c] = static_cast<std::int64_t>(std::floor(p[c] / cell_size));
  return cell;
}

}  // namespace

int WeldedPoints::add(const Eigen::Vector3d& point, double radius) {
  radius = std::min(radius, tolerance_);
  // Cells are twice the tolerance wide, so a point's neighbours lie in at most two cells along each
  // axis.
  const double cell_size = 2.0 * tolerance_;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(tolerance_);
  const WeldCell low = weld_cell(point - reach, cell_size),
                 high = weld_cell(point + reach, cell_size);
  int nearest = -1;
  double nearest_distance = 0.0;
  for (std::int64_t x = low[0]; x <= high[0]; ++x) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        const auto cell = first_in_cell_.find(cell_key({x, y, z}));
        if (cell == first_in_cell_.end()) continue;
        for (int i = cell->second; i >= 0; i = next_in_cell_[i]) {
          const double distance = (points_[i] - point).norm();
          if (distance > std::min(radius, radius_[i])) continue;
          if (nearest < 0 || distance < nearest_distance ||
              (distance == nearest_distance && i < nearest)) {
            nearest = i;
            nearest_distance = distance;
          }
        }
      }
    }
  }
  if (nearest >= 0) return nearest;

  const int id = size();
  points_.push_back(point);
  radius_.push_back(radius);
  const auto [cell, is_new] = first_in_cell_.try_emplace(cell_key(weld_cell(point, cell_size)), id);
  next_in_cell_.push_back(is_new ? -1 : cell->second);
  cell->second = id;
  return id;
}

void WeldedPoints::keep_first(int count) {
  for (int i = size() - 1; i >= count; --i) {
    // The last point heads the list of its cell.
    const auto cell = first_in_cell_.find(cell_key(weld_cell(points_.back(), 2.0 * tolerance_)));
    if (next_in_cell_.back() < 0) {
      first_in_cell_.erase(cell);
    } else {
      cell->second = next_in_cell_.back();
    }
    points_.pop_back();
    radius_.pop_back();
    next_in_cell_.pop_back();
  }
}

}  // namespace lightwell
