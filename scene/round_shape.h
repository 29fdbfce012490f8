#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A surface that rays meet exactly and that patches approximate: one facet of the scene. To each
/// shape belong the functions below.
using RoundShape = std::variant<Sphere, Frustum>;

/// The shape of a surface; empty: it consists of polygons.
std::optional<RoundShape> round_shape(const Surface& surface);

void set_shape(Surface& surface, const RoundShape& shape);

/// Area of one side, m^2.
double area(const RoundShape& shape);

Eigen::AlignedBox3d bounds(const RoundShape& shape);

/// The largest coordinate of the shape's points along a unit vector, m.
double reach(const RoundShape& shape, const Eigen::Vector3d& along);

/// A sphere that holds the shape.
Sphere ball_around(const RoundShape& shape);

/// The point of the shape that is nearest to `point`, in space.
Eigen::Vector3d nearest_on(const RoundShape& shape, const Eigen::Vector3d& point);

/// Unit normal on the front, at the point of the shape nearest to `point`.
Eigen::Vector3d front_normal(const RoundShape& shape, const Eigen::Vector3d& point);

RoundShape moved(const RoundShape& shape, const Eigen::Isometry3d& pose);

/// Radius of a frustum, m, at the place `along`, [0,1] from its base to its top.
double radius_at(const Frustum& frustum, double along);

/// Place of the point of a frustum's generators that is nearest to `point`: 0 at the base, 1 at the
/// top, outside of [0,1] beyond the rims.
double place_along(const Frustum& frustum, const Eigen::Vector3d& point);

/// Length of the generators of a frustum, m: the way from base to top on the surface.
double slant_height(const Frustum& frustum);

/// True if a frustum lies in a plane: a disc or a ring.
bool is_flat(const Frustum& frustum);

/// Longitude 0 of a frustum's grid, and the direction that longitude turns to: such that longitude,
/// the way to the top and the front make a right-handed frame.
struct LongitudeFrame {
  Eigen::Vector3d zero, quarter;
};
LongitudeFrame longitudes(const Frustum& frustum);

/// True if points of one side of a shape see other points of that side: the inside of a sphere or
/// of a tube.
bool sees_itself(const RoundShape& shape, bool is_back);

/// The round shapes of a scene by their scene-wide facet numbers.
class RoundShapes {
 public:
  RoundShapes() = default;
  /// Keeps no reference.
  explicit RoundShapes(const Scene& scene);

  /// The shape of a facet; null for a polygon.
  const RoundShape* of(int facet) const;

 private:
  std::vector<std::pair<int, RoundShape>> shapes_{};  // in order of facets
};

}  // namespace lightwell
