#include "scene/io/stf/stf_openings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "scene/degree.h"

namespace lightwell {
namespace {

constexpr double least_size = 1e-4;  // m; smaller openings have no area

// Distance of a point in plan from a wall, m, and the place of the nearest point along the wall.
struct NearWall {
  double distance = std::numeric_limits<double>::infinity();
  double along = 0.0;
};

NearWall near_wall(const StfPlan& plan, std::size_t wall, const Eigen::Vector2d& point) {
  const Eigen::Vector2d start = plan.corner(wall), way = plan.corner(wall + 1) - start;
  const double length = way.norm();
  const double along = std::clamp((point - start).dot(way) / length, 0.0, length);
  return {(point - start - along / length * way).norm(), along};
}

}  // namespace

// The inside of a counter-clockwise outline lies to the left of a wall, so that its front goes
// round from the end of the wall to its start and up.
Loop stf_wall_rectangle(const StfPlan& plan, std::size_t wall, const Eigen::Vector2d& along,
                        const Eigen::Vector2d& above) {
  const Eigen::Vector2d start = plan.corner(wall), end = plan.corner(wall + 1);
  const double length = (end - start).norm();
  const auto at = [&](double s, double z) {
    // The corners of the room themselves, so that walls, floor and ceiling share them.
    const Eigen::Vector2d p = s <= 0.0      ? start
                              : s >= length ? end
                                            : Eigen::Vector2d(start + s / length * (end - start));
    return Eigen::Vector3d(p.x(), p.y(), plan.level + z);
  };
  return {at(along[1], above[0]), at(along[0], above[0]), at(along[0], above[1]),
          at(along[1], above[1])};
}

StfOpenings::StfOpenings(const StfPlan& plan, Remarks& remarks)
    : plan_(plan), remarks_(remarks), walls_(plan.corners.size()), extents_(plan.corners.size()) {}

void StfOpenings::add(StfOpening opening) {
  if (!(opening.width > least_size && opening.height > least_size)) {
    remarks_.add("Openings without area were left out", opening.name);
  } else if (opening.kind == StfOpening::Kind::skylight) {
    add_to_ceiling(std::move(opening));
  } else {
    add_to_wall(std::move(opening));
  }
}

void StfOpenings::add_to_wall(StfOpening opening) {
  const Eigen::Vector2d point = opening.position.head<2>();
  std::size_t wall = 0;
  NearWall nearest;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const NearWall near = near_wall(plan_, w, point);
    if (near.distance < nearest.distance) std::tie(nearest, wall) = std::pair(near, w);
  }
  const double length = (plan_.corner(wall + 1) - plan_.corner(wall)).norm();
  const Extent whole{.left = nearest.along - 0.5 * opening.width,
                     .right = nearest.along + 0.5 * opening.width,
                     .bottom = opening.position.z(),
                     .top = opening.position.z() + opening.height};
  const Extent extent{.left = std::max(whole.left, 0.0),
                      .right = std::min(whole.right, length),
                      .bottom = std::max(whole.bottom, 0.0),
                      .top = std::min(whole.top, plan_.height)};
  const double lost = std::max({extent.left - whole.left, whole.right - extent.right,
                                extent.bottom - whole.bottom, whole.top - extent.top});
  if (lost > least_size) {
    remarks_.add("Openings that reach beyond their wall were cut off at its edge", opening.name);
  }
  const bool has_area =
      extent.right - extent.left > least_size && extent.top - extent.bottom > least_size;
  const bool is_covered = std::ranges::any_of(extents_[wall], [&](const Extent& other) {
    return std::min(extent.right, other.right) - std::max(extent.left, other.left) > least_size &&
           std::min(extent.top, other.top) - std::max(extent.bottom, other.bottom) > least_size;
  });
  if (!has_area || is_covered) {
    remarks_.add(has_area ? "Openings that overlap an earlier one were left out"
                          : "Openings beside their wall were left out",
                 opening.name);
    return;
  }
  extents_[wall].push_back(extent);
  walls_[wall].push_back(
      {std::move(opening),
       stf_wall_rectangle(plan_, wall, {extent.left, extent.right}, {extent.bottom, extent.top})});
}

void StfOpenings::add_to_ceiling(StfOpening opening) {
  const Eigen::Rotation2Dd turn(opening.turn * degree);
  Loop outline;
  // Clockwise seen from above: the front of a ceiling faces down.
  for (const auto& [x, y] : {std::pair(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
    const Eigen::Vector2d p =
        opening.position.head<2>() +
        turn * Eigen::Vector2d(0.5 * x * opening.width, 0.5 * y * opening.height);
    outline.emplace_back(p.x(), p.y(), plan_.level + plan_.height);
  }
  Polygon ceiling{.boundary = plan_.outline(plan_.height)};
  for (const PlacedOpening& other : ceiling_) ceiling.holes.push_back(other.outline);
  ceiling.holes.push_back(outline);
  if (!fault(ceiling).empty()) {
    remarks_.add("Skylights that do not lie within the ceiling, or overlap, were left out",
                 opening.name);
    return;
  }
  ceiling_.push_back({std::move(opening), std::move(outline)});
}

}  // namespace lightwell
